/* Table 3 of the SPP paper: leaf irradiance by light models against Monte Carlo, on one
 * tree and in a forest; and the table `crowns`, error beside cost, on two of those crowns
 * and on a mesh that the user names.
 *
 * The paper does not say what its tree was; its errors are those of sparse crowns. Crowns
 * here are statistical ones, of leaf-area index 0.8 and 1.2 alone and repeated every 2.5
 * radii, and dense ones (4; every 2 radii); everything else is docs/theory.md's protocol.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables.h"

#include <ppscat/tree/experiment.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "progress.h"
#include "system.h"
#include "values.h"

/* Light rays of the reference: of `crowns` enough to judge Monte Carlo itself. */
enum { N_SEEDS = 3, RAYS_OF_3 = 2000000, RAYS_OF_CROWNS = 10000000 };

static const double ALBEDO = 0.95;

/* A row of Table 3; the paper's figures, percent, of SPPG, SPP and SS. */
typedef struct {
    const char *name;
    double index, period;
    double paper[3];
} crown_row;

static const crown_row crowns[] = {
    {"single, index 0.8", 0.8, 0, {6.2, 65, 16}},
    {"single, index 1.2", 1.2, 0, {6.2, 65, 16}},
    {"period 2.5, index 0.8", 0.8, 2.5, {9.2, 43, 28}},
    {"period 2.5, index 1.2", 1.2, 2.5, {9.2, 43, 28}},
    {"single, index 4", 4, 0, {(double)NAN, (double)NAN, (double)NAN}},
    {"period 2.0, index 4", 4, 2, {(double)NAN, (double)NAN, (double)NAN}},
};
enum { N_CROWNS = sizeof crowns / sizeof crowns[0] };

/* The rows of `crowns`, before the mesh. */
static const crown_row beside_cost[] = {
    {"sparse crown", 0.8, 0, {(double)NAN, (double)NAN, (double)NAN}},
    {"dense crown", 4, 0, {(double)NAN, (double)NAN, (double)NAN}},
};
enum { N_BESIDE_COST = sizeof beside_cost / sizeof beside_cost[0] };

static const char *const level_names[PPS_SCORE_LEVELS] = {"20", "100"};

static double paper_figure(const crown_row *crown, const char *label) {
    static const char *const printed[] = {"SPPG", "SPP", "SS"};

    for (size_t i = 0; i < 3; i++) {
        if (strcmp(label, printed[i]) == 0)
            return crown->paper[i];
    }
    return CSV_EMPTY;
}

/* Means of one contender over the seeds, score[seed * n]; and half the range. */
static table_row summarize(const char *number, const char *row, double paper, int level,
                           size_t n, const pps_contender *contender,
                           const pps_score *score) {
    double least = INFINITY, most = -INFINITY;
    table_row r = {.table = number,
                   .row = row,
                   .column = contender->label,
                   .method = contender->model ? contender->model->name : "mc",
                   .paper = paper,
                   .seconds_per_cell = INFINITY,
                   .seconds_per_leaf = INFINITY};

    for (size_t seed = 0; seed < N_SEEDS; seed++) {
        const pps_score *s = &score[seed * n];
        double percent = 100 * s->category[level];
        r.ours += percent / N_SEEDS;
        r.rms_rel += 100 * s->by_count[level] / N_SEEDS;
        r.ratio += s->brightness / N_SEEDS;
        r.rms_leaf += 100 * s->leaves / N_SEEDS;
        r.seconds_per_cell = fmin(r.seconds_per_cell, s->seconds_per_cell);
        r.seconds_per_leaf = fmin(r.seconds_per_leaf, s->seconds_per_leaf);
        least = fmin(least, percent);
        most = fmax(most, percent);
    }
    r.spread = (most - least) / 2;
    return r;
}

/* What the runs share. */
typedef struct {
    uint64_t rays, seed;
    int threads;
    progress_meter meter;
    size_t n;
    pps_contender *contender;
    pps_score *score; /* [seed * n + contender] */
} table;

/* Grow, light and score a crown with every seed. */
static int run_crown(table *t, const crown_row *crown) {
    for (uint64_t seed = 0; seed < N_SEEDS; seed++) {
        pps_experiment e = {
            .crown = {PPS_CROWN_UNIFORM, crown->index, 0, t->seed + seed},
            .period = crown->period,
            .n_bands = 1,
            .albedo = {ALBEDO},
            .rays = t->rays,
            .seed = t->seed + seed,
            .threads = t->threads};
        if (system_signal())
            return cli_failed("interrupted; nothing is written");
        pps_status status =
            pps_experiment_run(&e, t->n, t->contender, t->score + seed * t->n);
        if (status)
            return cli_failed("%s", pps_status_string(status));
        progress_step(&t->meter);
    }
    return CLI_DONE;
}

/* Table 3: a crown, by both sizes of categories. */
static int crown_of_table_3(table *t, output *out, const crown_row *crown) {
    int rc = run_crown(t, crown);
    char row[64];

    for (int level = 0; level < PPS_SCORE_LEVELS; level++) {
        snprintf(row, sizeof row, "%s, %s meshes a category", crown->name,
                 level_names[level]);
        for (size_t i = 0; i < t->n && rc == CLI_DONE; i++) {
            table_row r =
                summarize("3", row, paper_figure(crown, t->contender[i].label), level,
                          t->n, &t->contender[i], t->score + i);
            /* The table is reproducible to the byte. */
            r.seconds_per_cell = r.seconds_per_leaf = CSV_EMPTY;
            rc = table_write(out, &r);
        }
    }
    return rc;
}

static int write_beside_cost(table *t, output *out, const char *row) {
    int rc = CLI_DONE;

    for (size_t i = 0; i < t->n && rc == CLI_DONE; i++) {
        table_row r = summarize("crowns", row, CSV_EMPTY, 0, t->n, &t->contender[i],
                                t->score + i);
        rc = table_write(out, &r);
    }
    return rc;
}

/* Light a mesh's scene and score, once. */
static pps_status score_scene(table *t, const pps_scene *scene, uint64_t seed,
                              pps_score *score) {
    pps_cells_options options = {.seed = seed, .threads = t->threads};
    pps_trace_options trace = {.rays = t->rays, .seed = seed, .threads = t->threads};
    pps_cells *cells = NULL;
    pps_irradiance *truth = NULL;
    pps_status status = pps_cells_create(scene, &options, &cells);

    if (!status)
        status = pps_cells_set_sun(cells, scene, &options);
    if (!status)
        status = pps_trace_light(scene, &trace, &truth, NULL);
    if (!status)
        status =
            pps_score_models(scene, cells, truth, 0, t->n, t->contender, ~seed, score);
    pps_irradiance_free(truth);
    pps_cells_free(cells);
    return status;
}

/* The mesh of --tree, lit as the crowns are; seeds are those of rays and points. */
static int run_mesh(table *t, output *out, pps_scene *scene, const char *name) {
    for (uint64_t seed = 0; seed < N_SEEDS; seed++) {
        if (system_signal())
            return cli_failed("interrupted; nothing is written");
        pps_status status =
            score_scene(t, scene, t->seed + seed, t->score + seed * t->n);
        if (status)
            return cli_failed("%s", pps_status_string(status));
        progress_step(&t->meter);
    }
    return write_beside_cost(t, out, name);
}

static int open_mesh(const invocation *call, pps_scene **out) {
    pps_problem problem = {""};
    pps_mesh *mesh;

    *out = NULL;
    if (!option_given(call, OPT_TREE_FILE))
        return CLI_DONE;
    pps_status status = pps_mesh_read(call->text[OPT_TREE_FILE], NULL, &mesh, &problem);
    if (status)
        return cli_usage("--tree: %s", problem.text);
    status = pps_scene_single(mesh, ALBEDO, out);
    return status ? cli_failed("%s", pps_status_string(status)) : CLI_DONE;
}

static const char *file_of(const char *path) {
    const char *slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

static int rows_of_table_3(table *t, output *out) {
    int rc = CLI_DONE;

    for (size_t crown = 0; crown < N_CROWNS && rc == CLI_DONE; crown++)
        rc = crown_of_table_3(t, out, &crowns[crown]);
    return rc;
}

static int rows_beside_cost(table *t, output *out, const invocation *call,
                            pps_scene *scene) {
    int rc = CLI_DONE;

    for (size_t i = 0; i < N_BESIDE_COST && rc == CLI_DONE; i++) {
        rc = run_crown(t, &beside_cost[i]);
        if (rc == CLI_DONE)
            rc = write_beside_cost(t, out, beside_cost[i].name);
    }
    if (rc == CLI_DONE && scene)
        rc = run_mesh(t, out, scene, file_of(call->text[OPT_TREE_FILE]));
    return rc;
}

/* The library's contenders; `paths`: and Monte Carlo by few rays and many. */
static int list_contenders(table *t, bool paths) {
    size_t n_models, n_paths;
    const pps_contender *model = pps_contender_table(&n_models),
                        *path = pps_contender_paths(&n_paths);

    t->n = n_models + (paths ? n_paths : 0);
    t->contender = malloc(t->n * sizeof *t->contender);
    t->score = malloc(N_SEEDS * t->n * sizeof *t->score);
    if (!t->contender || !t->score)
        return cli_no_memory();
    memcpy(t->contender, model, n_models * sizeof *model);
    memcpy(t->contender + n_models, path, (t->n - n_models) * sizeof *path);
    return CLI_DONE;
}

static int read_table(const invocation *call, bool crowns_table, table *t,
                      bool *progress) {
    int rc;

    *t = (table){.rays = crowns_table ? RAYS_OF_CROWNS : RAYS_OF_3};
    if ((rc = value_count(call, OPT_SEED, 0, UINT64_MAX - N_SEEDS, &t->seed)) ||
        (rc = value_threads(call, &t->threads)) ||
        (rc = value_progress(call, progress)))
        return rc;
    return option_given(call, OPT_RAYS)
               ? value_count(call, OPT_RAYS, 1, 1000000000000, &t->rays)
               : CLI_DONE;
}

/* `crowns` or else Table 3. */
static int run(const invocation *call, bool crowns_table) {
    table t;
    output out;
    bool progress;
    pps_scene *scene = NULL;
    int rc = read_table(call, crowns_table, &t, &progress);

    if (rc == CLI_DONE && crowns_table)
        rc = open_mesh(call, &scene);
    if (rc == CLI_DONE)
        rc = output_open(&out, call);
    if (rc != CLI_DONE) {
        pps_scene_free(scene);
        return rc;
    }
    rc = list_contenders(&t, crowns_table);
    system_watch_signals();
    progress_start(&t.meter, progress,
                   N_SEEDS * (crowns_table ? (size_t)N_BESIDE_COST + (scene != NULL)
                                           : (size_t)N_CROWNS));
    if (rc == CLI_DONE)
        rc = crowns_table ? rows_beside_cost(&t, &out, call, scene)
                          : rows_of_table_3(&t, &out);
    progress_end(&t.meter);
    free(t.contender);
    free(t.score);
    pps_scene_free(scene);
    return output_close(&out, rc);
}

int table_3(const invocation *call) { return run(call, false); }

int table_crowns(const invocation *call) { return run(call, true); }
