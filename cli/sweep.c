/* The sweep engine: tiles shared among threads, answers in order.
 *
 * A thread fills a buffer with the first blocks of its tile. When its turn comes (the
 * ordered region), it hands them on and streams the rest, so memory stays bounded
 * however long the lists are.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweep.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "cli.h"
#include "progress.h"

enum { BUFFER_BYTES = 1 << 25 /* of a thread, when a block is smaller */ };

typedef struct {
    const sweep_task *task;
    size_t n_tiles, n_workers, n_cases; /* n_cases: of a tile */
    size_t n_slots;                     /* blocks that fit the buffer of a thread */
    progress_meter progress;
    atomic_int failed; /* CLI_FAILED once anything went wrong */
    /* The tile that emits, and the threads that have left. OpenMP keeps both orders;
     * these let the thread sanitizer, which does not see into it, know them too. */
    atomic_size_t turn, left;
} sweep;

/* What a thread works with. */
typedef struct {
    char *buffer;
    sweep_worker *workers;
    double albedo, g;
    size_t tile;
} station;

static size_t at_least_one(size_t n) { return n ? n : 1; }

static void plan(sweep *s, const sweep_task *task) {
    const case_grid *grid = task->grid;
    size_t n_media = grid->albedo.n * grid->g.n;

    *s = (sweep){.task = task};
    s->n_tiles = task->reference ? n_media : n_media * grid->n_methods;
    s->n_workers = task->reference ? grid->n_methods + 1 : 1;
    s->n_cases = grid->thickness.n * grid->mu0.n;
    s->n_slots = at_least_one(BUFFER_BYTES / at_least_one(task->block_size));
    if (s->n_slots > s->n_cases)
        s->n_slots = s->n_cases;
}

static bool stopped(sweep *s) { return atomic_load(&s->failed) != CLI_DONE; }

static void note_failure(sweep *s, int rc) {
    if (rc != CLI_DONE)
        atomic_store(&s->failed, rc);
}

static const pps_method *worker_method(const sweep *s, size_t tile, size_t i) {
    const case_grid *grid = s->task->grid;

    if (!s->task->reference)
        return grid->method[tile / (grid->albedo.n * grid->g.n)];
    return i < grid->n_methods ? grid->method[i] : s->task->reference;
}

static int open_tile(const sweep *s, size_t tile, station *own) {
    const case_grid *grid = s->task->grid;
    pps_slab slab = {grid->albedo.value[tile / grid->g.n % grid->albedo.n],
                     grid->g.value[tile % grid->g.n], grid->thickness.value[0]};
    int rc = CLI_DONE;

    own->albedo = slab.albedo;
    own->g = slab.g;
    for (size_t i = 0; i < s->n_workers; i++) {
        sweep_worker *worker = &own->workers[i];
        *worker = (sweep_worker){.method = worker_method(s, tile, i), .refusal = NULL};
        if (rc == CLI_DONE)
            rc = sweep_judge(
                pps_model_create(worker->method, &slab, &grid->options, &worker->model),
                &worker->refusal);
    }
    return rc;
}

static void close_tile(const sweep *s, station *own) {
    for (size_t i = 0; own->workers && i < s->n_workers; i++) {
        pps_model_free(own->workers[i].model);
        own->workers[i].model = NULL;
    }
}

static sweep_case case_at(const sweep *s, const station *own, size_t i) {
    const case_grid *grid = s->task->grid;
    size_t i_thickness = i / grid->mu0.n;

    return (sweep_case){.albedo = own->albedo,
                        .g = own->g,
                        .thickness = grid->thickness.value[i_thickness],
                        .mu0 = grid->mu0.value[i % grid->mu0.n],
                        .depth = &grid->depth[i_thickness],
                        .index = own->tile * s->n_cases + i};
}

static void evaluate(sweep *s, const station *own, size_t i, void *block) {
    sweep_case at = case_at(s, own, i);

    if (stopped(s))
        return;
    note_failure(s, s->task->evaluate(s->task, own->workers, &at, block));
    progress_step(&s->progress);
}

static void emit(sweep *s, const station *own, size_t i, const void *block) {
    sweep_case at = case_at(s, own, i);

    if (!stopped(s))
        note_failure(s, s->task->emit(s->task, own->workers, &at, block));
}

static void begin_tile(sweep *s, size_t tile, station *own) {
    own->tile = tile;
    if (stopped(s) || !own->buffer || !own->workers)
        return;
    note_failure(s, open_tile(s, tile, own));
    for (size_t i = 0; i < s->n_slots; i++)
        evaluate(s, own, i, own->buffer + i * s->task->block_size);
}

/* Once every earlier tile is out. */
static void finish_tile(sweep *s, station *own) {
    assert(atomic_load(&s->turn) == own->tile);
    for (size_t i = 0; i < s->n_slots; i++)
        emit(s, own, i, own->buffer + i * s->task->block_size);
    for (size_t i = s->n_slots; i < s->n_cases && !stopped(s); i++) {
        evaluate(s, own, i, own->buffer);
        emit(s, own, i, own->buffer);
    }
    atomic_store(&s->turn, own->tile + 1);
    close_tile(s, own);
}

static void work(sweep *s) {
    station own = {.buffer = malloc(s->n_slots * at_least_one(s->task->block_size)),
                   .workers = calloc(s->n_workers, sizeof *own.workers)};

    if (!own.buffer || !own.workers)
        note_failure(s, cli_no_memory());
#pragma omp for ordered schedule(dynamic, 1)
    for (size_t tile = 0; tile < s->n_tiles; tile++) {
        begin_tile(s, tile, &own);
#pragma omp ordered
        finish_tile(s, &own);
    }
    free(own.buffer);
    free(own.workers);
    atomic_fetch_add(&s->left, 1);
}

static int n_threads(const sweep *s) {
    size_t threads = (size_t)s->task->grid->threads;

    return (int)(threads < s->n_tiles ? threads : s->n_tiles);
}

int sweep_run(const sweep_task *task) {
    sweep s;

    plan(&s, task);
    progress_start(&s.progress, task->grid->progress, s.n_tiles * s.n_cases);
#pragma omp parallel num_threads(n_threads(&s))
    work(&s);
    progress_end(&s.progress);
    assert(atomic_load(&s.left) >= 1);
    return atomic_load(&s.failed);
}

int sweep_judge(pps_status status, const char **refusal) {
    *refusal = status == PPS_OK ? NULL : pps_status_string(status);
    return status == PPS_ERR_MEMORY ? cli_no_memory() : CLI_DONE;
}

int sweep_solve(const sweep_worker *worker, const sweep_case *at,
                const char **refusal) {
    *refusal = worker->refusal;
    if (worker->refusal)
        return CLI_DONE;
    return sweep_judge(pps_model_solve(worker->model, at->thickness, at->mu0), refusal);
}
