/* The ranks of mpirun help with a sweep.
 *
 * A helper sends a message: what became of its last tile, which also asks for the next.
 * Rank 0 answers with a range of units, an empty one at the end. All MPI calls are made by
 * the first thread of each rank. A rank that dies takes all down, as mpirun has it; rank 0
 * gets SIGTERM then and keeps what is done.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "team.h"

#include <stdlib.h>
#include <string.h>

#include <mpi.h>

#include "cli.h"
#include "system.h"

enum { TAG_TILE = 1, TAG_RANGE = 2 };

static const double patience =
    1; /* seconds for helpers to end when the run has failed */

/* What a message of a helper begins with; the texts follow. */
typedef struct {
    uint64_t rc, cases, n_bytes, n_notes, n_record;
} header;

/* What rank 0 knows of a helper. */
typedef struct {
    sweep_tile *tile; /* that it works on */
    bool waiting, dismissed;
} helper;

static struct {
    int rank, size;
    helper *helpers; /* of rank 0, [rank] */
    buffer inbox;
} team = {.size = 1};

/* Whether a launcher started us: without one MPI_Init takes long and may fail. */
static bool launched(void) {
    static const char *const marks[] = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK",
                                        "PMI_SIZE"};

    for (size_t i = 0; i < sizeof marks / sizeof marks[0]; i++) {
        if (getenv(marks[i]))
            return true;
    }
    return false;
}

int team_begin(int *argc, char ***argv) {
    int provided;

    if (!launched())
        return CLI_DONE;
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &team.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &team.size);
    if (team.rank > 0) {
        cli_mute();
        return CLI_DONE;
    }
    team.helpers = calloc((size_t)team.size, sizeof *team.helpers);
    return team.helpers ? CLI_DONE : cli_no_memory();
}

void team_end(void) {
    int begun;

    MPI_Initialized(&begun);
    free(team.helpers);
    buffer_free(&team.inbox);
    if (begun)
        MPI_Finalize();
}

int team_rank(void) { return team.rank; }

int team_size(void) { return team.size; }

/* ---- rank 0 ---- */

static void answer(int rank, const sweep_tile *t) {
    uint64_t range[2] = {t ? t->first : 0, t ? t->n : 0};

    MPI_Send(range, 2, MPI_UINT64_T, rank, TAG_RANGE, MPI_COMM_WORLD);
    team.helpers[rank].waiting = false;
    team.helpers[rank].dismissed = !t;
}

/* Whether there is a message; from whom, and its size. */
static bool probe(int *rank, int *size) {
    MPI_Status status;
    int there;

    MPI_Iprobe(MPI_ANY_SOURCE, TAG_TILE, MPI_COMM_WORLD, &there, &status);
    if (there) {
        *rank = status.MPI_SOURCE;
        MPI_Get_count(&status, MPI_BYTE, size);
    }
    return there;
}

static int receive(int rank, int size) {
    team.inbox.n = 0;
    if (buffer_reserve(&team.inbox, (size_t)size + 1) != CLI_DONE)
        return CLI_FAILED;
    MPI_Recv(team.inbox.data, size, MPI_BYTE, rank, TAG_TILE, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    team.inbox.data[size] = '\0'; /* ends the record, which comes last */
    team.helpers[rank].waiting = true;
    return CLI_DONE;
}

/* Fill a tile from the inbox. */
static int unpack(sweep_tile *t, header *h) {
    const char *at = team.inbox.data + sizeof *h;
    int rc;

    memcpy(h, team.inbox.data, sizeof *h);
    if (!t || h->rc != CLI_DONE)
        return (int)h->rc;
    t->cases = h->cases;
    rc = buffer_append(&t->bytes, at, (size_t)h->n_bytes);
    if (rc == CLI_DONE)
        rc = buffer_append(&t->notes, at + h->n_bytes, (size_t)h->n_notes);
    if (rc == CLI_DONE)
        rc = record_read(&t->record, at + h->n_bytes + h->n_notes);
    return rc;
}

size_t team_serve(queue *q) {
    size_t cases = 0;
    int rank, size;

    while (probe(&rank, &size)) {
        header h = {0};
        helper *from = &team.helpers[rank];
        int rc = receive(rank, size);
        if (rc == CLI_DONE)
            rc = unpack(from->tile, &h);
        if (from->tile)
            queue_put(q, from->tile, rc);
        else if (rc != CLI_DONE)
            queue_stop(q, rc);
        cases += from->tile ? (size_t)h.cases : 0;
        from->tile = NULL;
    }
    for (rank = 1; rank < team.size; rank++) {
        helper *to = &team.helpers[rank];
        if (to->waiting && queue_try_take(q, &to->tile))
            answer(rank, to->tile);
    }
    return cases;
}

static bool all_dismissed(void) {
    for (int rank = 1; rank < team.size; rank++) {
        if (!team.helpers[rank].dismissed)
            return false;
    }
    return true;
}

void team_dismiss(void) {
    double until = system_seconds() + patience;
    int rank, size;

    while (!all_dismissed()) {
        for (rank = 1; rank < team.size; rank++) {
            if (team.helpers[rank].waiting)
                answer(rank, NULL);
        }
        if (!probe(&rank, &size))
            system_pause(1e-3);
        else if (receive(rank, size) != CLI_DONE)
            until = 0;
        if (system_seconds() > until) /* deep in a tile that nobody wants any more */
            MPI_Abort(MPI_COMM_WORLD, CLI_FAILED);
    }
}

/* ---- the others ---- */

static int pack(buffer *out, int rc, const sweep_tile *t) {
    char *text = record_write(&t->record);
    header h = {(uint64_t)rc, t->cases, t->bytes.n, t->notes.n, 0};

    out->n = 0;
    if (!text)
        return cli_no_memory();
    h.n_record = strlen(text);
    rc = buffer_append(out, &h, sizeof h);
    if (rc == CLI_DONE)
        rc = buffer_append(out, t->bytes.data, t->bytes.n);
    if (rc == CLI_DONE)
        rc = buffer_append(out, t->notes.data, t->notes.n);
    if (rc == CLI_DONE)
        rc = buffer_append(out, text, h.n_record);
    free(text);
    return rc;
}

int team_help(int rc, int (*compute)(void *context, sweep_tile *t), void *context) {
    sweep_tile t = {0};
    buffer out = {0};
    uint64_t range[2];

    for (;;) {
        if (pack(&out, rc, &t) != CLI_DONE)
            MPI_Abort(MPI_COMM_WORLD, CLI_FAILED);
        MPI_Send(out.data, (int)out.n, MPI_BYTE, 0, TAG_TILE, MPI_COMM_WORLD);
        MPI_Recv(range, 2, MPI_UINT64_T, 0, TAG_RANGE, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        if (range[1] == 0)
            break;
        record_free(&t.record);
        t.first = range[0];
        t.n = range[1];
        t.cases = 0;
        t.bytes.n = t.notes.n = 0;
        rc = compute(context, &t);
    }
    record_free(&t.record);
    buffer_free(&t.bytes);
    buffer_free(&t.notes);
    buffer_free(&out);
    return CLI_DONE; /* rank 0 says how it went */
}
