/* ppscat stability: where methods hold and where they fail.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "case_row.h"
#include "cli.h"
#include "crew.h"
#include "output.h"
#include "progress.h"
#include "stability_design.h"
#include "stability_judge.h"

static const double too_slow = 10; /* seconds */

/* One method on one case. */
typedef struct {
    verdict verdict;
    const char *refusal; /* static text; NULL unless refused */
    double error, seconds;
} cell;

/* All cases of one (albedo, g) of a block: work for one thread. */
typedef struct {
    const case_grid *grid;
    double albedo, g;
    size_t first; /* case */
} tile;

typedef struct {
    size_t n_blocks, n_tiles, n_cases, n_methods;
    case_grid grid[MAX_BLOCKS];
    tile *tiles;
    cell *cells; /* [method * n_cases + case] */
    progress_meter progress;
    atomic_size_t next; /* tile to take */
    atomic_int failed;  /* CLI_FAILED once memory ran out */
} walk;

static size_t tile_cases(const case_grid *grid) {
    return grid->thickness.n * grid->mu0.n;
}

static int plan(walk *w) {
    size_t t = 0;

    w->n_methods = w->grid->n_methods;
    for (size_t b = 0; b < w->n_blocks; b++)
        w->n_tiles += w->grid[b].albedo.n * w->grid[b].g.n;
    w->tiles = calloc(w->n_tiles, sizeof *w->tiles);
    for (size_t b = 0; w->tiles && b < w->n_blocks; b++) {
        const case_grid *grid = &w->grid[b];
        for (size_t i = 0; i < grid->albedo.n * grid->g.n; i++) {
            w->tiles[t++] = (tile){grid, grid->albedo.value[i / grid->g.n],
                                   grid->g.value[i % grid->g.n], w->n_cases};
            w->n_cases += tile_cases(grid);
        }
    }
    w->cells = calloc(w->n_cases * w->n_methods, sizeof *w->cells);
    return w->tiles && w->cells ? CLI_DONE : cli_no_memory();
}

static sweep_case case_of(const tile *t, size_t i) {
    const case_grid *grid = t->grid;

    return (sweep_case){.albedo = t->albedo,
                        .g = t->g,
                        .thickness = grid->thickness.value[i / grid->mu0.n],
                        .mu0 = grid->mu0.value[i % grid->mu0.n]};
}

/* ---- the cases of a tile ---- */

/* What a thread works with: a model a method, their answers, the trusted solution. */
typedef struct {
    pps_model **model;
    pps_status *status; /* of the model, then of the answer */
    sample *got;
    double deviation[SAMPLE_NUMBERS]; /* of `mc` */
    trusted truth;
} station;

static int open_station(station *s, const tile *t, size_t n_methods) {
    pps_slab slab = {t->albedo, t->g, t->grid->thickness.value[0]};

    *s = (station){.model = calloc(n_methods, sizeof(pps_model *)),
                   .status = calloc(n_methods, sizeof *s->status),
                   .got = calloc(n_methods, sizeof *s->got),
                   .truth = {.slab = slab}};
    if (!s->model || !s->status || !s->got)
        return cli_no_memory();
    for (size_t m = 0; m < n_methods; m++)
        s->status[m] = pps_model_create(t->grid->method[m], &slab, &t->grid->options,
                                        &s->model[m]);
    return CLI_DONE;
}

static void close_station(station *s, size_t n_methods) {
    for (size_t m = 0; s->model && m < n_methods; m++)
        pps_model_free(s->model[m]);
    free(s->model);
    free(s->status);
    free(s->got);
    trusted_free(&s->truth);
}

/* Of this thread: what others do at the same time does not count. */
static double processor_seconds(void) {
    struct timespec now;

    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The answer of method m; true where it is worth comparing radiances. */
static bool answer(station *s, const tile *t, const sweep_case *at, size_t m, cell *c) {
    const pps_method *method = t->grid->method[m];
    pps_slab slab = {at->albedo, at->g, at->thickness};
    double start = processor_seconds();

    if (!s->model[m])
        return false;
    s->status[m] =
        strcmp(method->name, "mc") == 0
            ? sample_mc(&slab, at->mu0, &t->grid->options, s->deviation, &s->got[m])
            : sample_model(s->model[m], method, at->thickness, at->mu0, &s->got[m]);
    c->seconds = processor_seconds() - start;
    return !s->status[m] && s->got[m].has_radiance && judged_in_full(method);
}

static int judge(const station *s, const tile *t, size_t m, const sample *want,
                 cell *c) {
    if (s->status[m]) {
        c->verdict = REFUSED;
        c->error = CSV_EMPTY;
        return sweep_judge(s->status[m], &c->refusal);
    }
    c->verdict = judge_sample(t->grid->method[m], t->grid->options.tolerance,
                              &s->got[m], want, &c->error);
    if (c->verdict == OK && c->seconds > too_slow)
        c->verdict = TOO_SLOW;
    return CLI_DONE;
}

/* Case i of the tile by all methods; cells are n_cases apart. */
static int walk_case(walk *w, station *s, const tile *t, size_t i) {
    cell *cells = &w->cells[t->first + i];
    sweep_case at = case_of(t, i);
    bool radiance = false;
    const char *refusal;
    sample want;
    int rc;

    for (size_t m = 0; m < w->n_methods; m++)
        radiance |= answer(s, t, &at, m, &cells[m * w->n_cases]);
    rc = sweep_judge(trusted_sample(&s->truth, at.thickness, at.mu0, radiance, &want),
                     &refusal);
    if (rc == CLI_DONE && refusal)
        rc = cli_failed("no trusted value at albedo %g, g %g, thickness %g: %s",
                        at.albedo, at.g, at.thickness, refusal);
    for (size_t m = 0; m < w->n_methods && rc == CLI_DONE; m++) {
        rc = judge(s, t, m, &want, &cells[m * w->n_cases]);
        progress_step(&w->progress);
    }
    return rc;
}

static void walk_tile(walk *w, const tile *t) {
    station s;
    int rc = open_station(&s, t, w->n_methods);

    for (size_t i = 0; i < tile_cases(t->grid) && rc == CLI_DONE; i++) {
        if (atomic_load(&w->failed) == CLI_DONE)
            rc = walk_case(w, &s, t, i);
    }
    if (rc != CLI_DONE)
        atomic_store(&w->failed, rc);
    close_station(&s, w->n_methods);
}

/* A thread: tiles, one after the other. */
static void *walk_tiles(void *context) {
    walk *w = context;
    size_t k;

    while ((k = atomic_fetch_add(&w->next, 1)) < w->n_tiles)
        walk_tile(w, &w->tiles[k]);
    return NULL;
}

/* ---- all of them ---- */

static int write_cell(output *out, const tile *t, size_t i, const pps_method *method,
                      const cell *c) {
    char medium[CASE_ROW_SIZE];
    sweep_case at = case_of(t, i);

    case_row(medium, method, &at);
    csv_fields(&out->csv, medium);
    csv_text(&out->csv, verdict_text(c->verdict));
    csv_number(&out->csv, c->error);
    csv_number(&out->csv, c->seconds);
    return output_end_row(out, method, c->refusal);
}

static int write_method(const walk *w, output *out, size_t m) {
    int rc = CLI_DONE;

    for (size_t k = 0; k < w->n_tiles; k++) {
        const tile *t = &w->tiles[k];
        const cell *cells = &w->cells[m * w->n_cases + t->first];
        for (size_t i = 0; i < tile_cases(t->grid) && rc == CLI_DONE; i++)
            rc = write_cell(out, t, i, t->grid->method[m], &cells[i]);
    }
    return rc;
}

static int run(walk *w, const invocation *call) {
    output out;
    int rc = output_open(&out, call);

    if (rc != CLI_DONE)
        return rc;
    progress_start(&w->progress, w->grid->progress, w->n_cases * w->n_methods);
    crew_run(w->grid->threads, walk_tiles, w);
    progress_end(&w->progress);
    rc = atomic_load(&w->failed);
    for (size_t m = 0; m < w->n_methods && rc == CLI_DONE; m++)
        rc = write_method(w, &out, m);
    return output_close(&out, rc);
}

int cmd_stability(const invocation *call) {
    walk w = {0};
    int rc = design_init(w.grid, &w.n_blocks, call);

    if (rc == CLI_DONE)
        rc = plan(&w);
    if (rc == CLI_DONE)
        rc = run(&w, call);
    for (size_t b = 0; b < w.n_blocks; b++)
        grid_free(&w.grid[b]);
    free(w.tiles);
    free(w.cells);
    return rc;
}
