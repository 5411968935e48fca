/* A sweep into its file.
 *
 * Rows of CSV that come in their order go into FILE.part as they are. Others wait as
 * numbers in FILE.part-values (a file without a name, for standard output), from which
 * FILE.part is made at the end: the rows of `error`, whose methods are computed together
 * but follow each other in the file, and NetCDF, which a killed run could leave
 * unreadable. Either way a file only grows, and the journal says how far it is good.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweep_file.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "columns.h"
#include "journal.h"
#include "metadata.h"
#include "netcdf_file.h"
#include "number.h"
#include "rows.h"
#include "store.h"
#include "system.h"
#include "team.h"
#include "values.h"

static const double note_every = 1;  /* seconds between checkpoints */
static const double sync_every = 30; /* between those that survive a power failure */

enum { OUT_BYTES = 1 << 20 };

typedef struct {
    const invocation *call;
    sweep_task *task;
    sweep_plan plan;
    const char *path;             /* of -o; NULL for standard output */
    bool regular, direct, netcdf; /* direct: rows as they come */
    char *part, *values, *journal;
    store grown; /* what the sweep writes to */
    checkpoint latest, safe;
    double noted, synced; /* when */
} sweep_out;

/* ---- before the sweep ---- */

static char *with_suffix(const char *path, const char *suffix) {
    size_t size = strlen(path) + strlen(suffix) + 1;
    char *text = malloc(size);

    if (text)
        snprintf(text, size, "%s%s", path, suffix);
    return text;
}

/* Where -o leads, and whether that goes with the other options. */
static int look(sweep_out *o) {
    const invocation *call = o->call;
    int format = 0, rc = value_choice(call, OPT_FORMAT, &format);

    o->netcdf = format == 1;
    o->direct = !o->netcdf && o->plan.shape != ROWS_CASE;
    if (rc == CLI_DONE && o->netcdf && !netcdf_file_there)
        return cli_usage("--format: 'netcdf' is not in this build, which found no "
                         "libnetcdf; allowed: csv");
    if (option_given(call, OPT_OUTPUT)) {
        o->path = call->text[OPT_OUTPUT];
        rc = rc == CLI_DONE ? store_look(o->path, &o->regular) : rc;
    }
    if (rc == CLI_DONE && o->netcdf && !o->regular)
        return cli_usage("--format: 'netcdf' needs a file; allowed: with -o FILE");
    if (rc == CLI_DONE && option_given(call, OPT_RESUME) && !o->regular)
        return cli_usage("--resume goes on with a file; allowed: with -o FILE");
    return rc;
}

static int name_files(sweep_out *o) {
    if (!o->regular)
        return CLI_DONE;
    o->part = with_suffix(o->path, ".part");
    o->values = with_suffix(o->path, ".part-values");
    o->journal = with_suffix(o->path, ".part-journal");
    return o->part && o->values && o->journal ? CLI_DONE : cli_no_memory();
}

/* The file that grows. */
static const char *grown_name(const sweep_out *o) {
    return o->direct ? o->part : o->values;
}

/* A run without --resume must not wipe out what another has left. */
static int refuse_to_wipe(const sweep_out *o) {
    uint64_t rows;

    if (access(grown_name(o), F_OK) != 0 || !journal_there(o->journal, &rows) || !rows)
        return CLI_DONE;
    return cli_usage("--output: '%.200s' holds %" PRIu64
                     " rows of an unfinished run; allowed: --resume, or remove it",
                     grown_name(o), rows);
}

static bool is_good(const sweep_out *o, const checkpoint *c) {
    uint64_t tail;

    return journal_tail(o->grown.fd, c->bytes, &tail) == CLI_DONE && tail == c->tail &&
           c->units <= o->plan.n_units;
}

/* Go on from the latest checkpoint that the file bears out. */
static int choose_checkpoint(sweep_out *o, checkpoint *points, int n) {
    int i = 0, rc;
    FILE *probe = fopen(grown_name(o), "r"); /* not changed before it is judged */

    o->grown.fd = probe ? fileno(probe) : -1;
    while (i < n && !is_good(o, &points[i]))
        i++;
    if (probe)
        fclose(probe);
    if (i == n)
        return cli_usage("--resume: '%.200s' is not what the run left: cut short, or "
                         "another file; allowed: the file as it was, or remove it to "
                         "begin anew",
                         grown_name(o));
    o->latest = points[i];
    points[i].record = (record){0};
    rc = store_file(&o->grown, grown_name(o), o->latest.bytes);
    return rc;
}

static int resume(sweep_out *o) {
    checkpoint points[2] = {0};
    int n, rc = journal_read(o->journal, o->call, points, &n);

    if (rc == CLI_DONE && n == 0 && access(grown_name(o), F_OK) == 0)
        rc =
            cli_usage("--resume: '%.200s' has no journal beside it; remove it to begin "
                      "anew",
                      grown_name(o));
    else if (rc == CLI_DONE && n == 0)
        rc = store_file(&o->grown, grown_name(o), 0);
    else if (rc == CLI_DONE)
        rc = choose_checkpoint(o, points, n);
    record_free(&points[0].record);
    record_free(&points[1].record);
    return rc;
}

static int open_grown(sweep_out *o) {
    int rc;

    if (!o->regular)
        return o->direct ? store_stream(&o->grown, o->path)
                         : store_temporary(&o->grown);
    if (option_given(o->call, OPT_RESUME))
        return resume(o);
    rc = refuse_to_wipe(o);
    return rc == CLI_DONE ? store_file(&o->grown, grown_name(o), 0) : rc;
}

static int write_header(store *s, subcommand_id id) {
    int rc = CLI_DONE;

    for (const column *c = columns_of(id); c->name && rc == CLI_DONE; c++) {
        rc = store_write(s, c->name, strlen(c->name));
        if (rc == CLI_DONE)
            rc = store_write(s, c[1].name ? "," : "\n", 1);
    }
    return rc;
}

/* ---- during the sweep ---- */

/* Note in the journal how far the file is good; `sync`: for good. */
static int note(sweep_out *o, bool sync) {
    int rc = CLI_DONE;

    o->noted = system_seconds();
    if (!o->regular)
        return CLI_DONE;
    o->latest.bytes = o->grown.bytes;
    if (journal_tail(o->grown.fd, o->latest.bytes, &o->latest.tail) != CLI_DONE)
        return cli_failed("'%.200s' is being changed by another program",
                          o->grown.name);
    if (sync)
        rc = store_sync(&o->grown);
    if (rc == CLI_DONE)
        rc = journal_write(o->journal, o->call, &o->latest, &o->safe, sync);
    if (rc == CLI_DONE && sync) {
        record_free(&o->safe.record);
        o->safe = o->latest;
        o->safe.record = (record){0};
        rc = record_add(&o->safe.record, &o->latest.record);
        o->synced = o->noted;
    }
    return rc;
}

static int deliver(void *context, const sweep_tile *t) {
    sweep_out *o = context;
    double now;
    int rc = store_write(&o->grown, t->bytes.data, t->bytes.n);

    if (rc == CLI_DONE)
        rc = record_add(&o->latest.record, &t->record);
    if (rc != CLI_DONE)
        return rc;
    o->latest.units = t->first + t->n;
    fwrite(t->notes.data, 1, t->notes.n, stderr);
    now = system_seconds();
    return now - o->noted < note_every ? CLI_DONE
                                       : note(o, now - o->synced >= sync_every);
}

/* ---- after the sweep ---- */

/* Rows that are put together before they are written. */
typedef struct {
    store *to;
    sweep_tile rows;
} row_writer;

static int flush_rows(row_writer *w, size_t least) {
    int rc = CLI_DONE;

    if (w->rows.bytes.n >= least) {
        rc = store_write(w->to, w->rows.bytes.data, w->rows.bytes.n);
        w->rows.bytes.n = 0;
    }
    return system_signal() ? CLI_FAILED : rc;
}

/* The rows of one method in a unit of ROWS_CASE. */
static int write_cases(row_writer *w, const sweep_task *task, const sweep_unit *unit,
                       size_t i_method, const double *values) {
    size_t per_row = task->n_values / task->grid->n_methods;
    buffer *out = &w->rows.bytes;
    char medium[MEDIUM_TEXT_SIZE];
    size_t n = rows_medium(unit, task->grid->method[i_method], medium);

    for (size_t b = 0; b < unit->mu0.n; b++, values += task->n_values) {
        const double *value = values + i_method * per_row;
        char *at;
        if (buffer_reserve(out, n + (per_row + 1) * NUMBER_SIZE) != CLI_DONE)
            return CLI_FAILED;
        at = memcpy(out->data + out->n, medium, n);
        at += n;
        at += number_format(unit->mu0.value[b], at);
        for (size_t i = 0; i < per_row; i++) {
            *at++ = ',';
            at += number_format(value[i], at);
        }
        *at++ = '\n';
        out->n = (size_t)(at - out->data);
    }
    return flush_rows(w, OUT_BYTES);
}

/* From the order of the sweep, all methods a case, to the order of rows. */
static int write_by_method(sweep_out *o, store *to) {
    const sweep_task *task = o->task;
    double *values = malloc(UNIT_BEAMS * task->n_values * sizeof *values);
    row_writer w = {.to = to};
    int rc = values ? write_header(to, o->call->subcommand) : cli_no_memory();

    for (size_t m = 0; m < task->grid->n_methods; m++) {
        uint64_t at = 0;
        for (uint64_t i = 0; i < o->plan.n_units && rc == CLI_DONE; i++) {
            sweep_unit unit = plan_unit(&o->plan, i);
            size_t size = unit.mu0.n * task->n_values * sizeof *values;
            rc = store_read(&o->grown, at, values, size);
            if (rc == CLI_DONE)
                rc = write_cases(&w, task, &unit, m, values);
            at += size;
        }
    }
    if (rc == CLI_DONE)
        rc = flush_rows(&w, 0);
    buffer_free(&w.rows.bytes);
    free(values);
    return rc;
}

/* Make the rows from the values. */
static int convert(sweep_out *o) {
    store to;
    int rc, closed;

    if (o->netcdf)
        return netcdf_file_write(o->part, o->call, o->task, &o->plan, &o->grown,
                                 &o->latest.record);
    rc = o->regular ? store_file(&to, o->part, 0) : store_stream(&to, o->path);
    if (rc != CLI_DONE)
        return rc;
    rc = write_by_method(o, &to);
    if (rc == CLI_DONE && o->regular)
        rc = store_sync(&to);
    closed = !o->path ? CLI_DONE : store_close(&to);
    return rc == CLI_DONE ? closed : rc;
}

/* All units are done: describe the file, then let it appear. */
static int publish(sweep_out *o) {
    int rc = o->direct ? CLI_DONE : convert(o);

    if (rc == CLI_DONE && o->regular && o->direct)
        rc = store_sync(&o->grown);
    if (rc == CLI_DONE && o->path)
        rc = store_close(&o->grown);
    if (rc != CLI_DONE || !o->regular)
        return rc;
    if (!o->netcdf)
        rc = metadata_write(o->path, o->call, &o->latest.record);
    if (rc == CLI_DONE)
        rc = store_rename(o->part, o->path);
    if (rc == CLI_DONE) {
        unlink(o->values);
        unlink(o->journal);
    }
    return rc;
}

/* A word of the command line as a shell reads it. */
static void print_word(const char *word) {
    if (*word && !word[strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVW"
                                    "XYZ0123456789_-+=,.:/%@")]) {
        fprintf(stderr, " %s", word);
        return;
    }
    fputs(" '", stderr);
    for (; *word; word++)
        fprintf(stderr, *word == '\'' ? "'\\''" : "%c", *word);
    fputc('\'', stderr);
}

static void say_how_to_go_on(const sweep_out *o) {
    cli_note("%" PRIu64 " rows are kept in '%.200s'; this goes on from there:",
             o->latest.record.rows, o->grown.name);
    for (int i = 0; i < o->call->argc; i++)
        print_word(o->call->argv[i]);
    fputs(option_given(o->call, OPT_RESUME) ? "\n" : " --resume\n", stderr);
}

/* The sweep ended early: keep what is done, or leave nothing where nothing is. */
static void keep(sweep_out *o) {
    if (system_signal())
        cli_note("stopped by %s", strsignal(system_signal()));
    if (!o->regular) {
        if (system_signal())
            cli_note("a run into a file, with -o FILE, can be gone on with");
        return;
    }
    store_trim(&o->grown);
    if (o->latest.record.rows) {
        note(o, true);
        say_how_to_go_on(o);
        return;
    }
    unlink(grown_name(o));
    unlink(o->journal);
}

static int run(sweep_out *o) {
    int rc = open_grown(o);

    if (rc != CLI_DONE)
        return rc;
    o->noted = o->synced = system_seconds();
    system_watch_signals();
    if (o->direct && o->grown.bytes == 0)
        rc = write_header(&o->grown, o->call->subcommand);
    if (rc == CLI_DONE)
        rc = note(o, false);
    if (rc == CLI_DONE)
        rc = sweep_run(o->task, &o->plan, o->latest.units, false, deliver, o);
    if (rc == CLI_DONE)
        rc = publish(o);
    if (rc != CLI_DONE)
        keep(o);
    else
        record_report(&o->latest.record);
    if (system_signal() && rc != CLI_DONE)
        system_die();
    if (rc == CLI_DONE && o->latest.record.refused_rows)
        rc = CLI_REFUSED;
    if (o->path && o->grown.fd >= 0)
        store_close(&o->grown);
    return rc;
}

int sweep_file(const invocation *call, sweep_task *task) {
    sweep_out o = {.call = call, .task = task};
    int rc;

    plan_init(&o.plan, task->grid, task->shape);
    rc = look(&o);
    task->render = o.direct ? rows_csv : rows_values;
    if (team_rank() > 0)
        return rc == CLI_DONE ? sweep_help(task, &o.plan) : rc;
    if (rc == CLI_DONE)
        rc = name_files(&o);
    if (rc == CLI_DONE)
        rc = run(&o);
    team_dismiss();
    record_free(&o.latest.record);
    record_free(&o.safe.record);
    free(o.part);
    free(o.values);
    free(o.journal);
    return rc;
}
