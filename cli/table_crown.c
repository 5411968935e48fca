/* Table 3 of the SPP paper: leaf irradiance by light models against Monte Carlo, on one
 * tree and in a forest.
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
#include "output.h"
#include "progress.h"
#include "system.h"
#include "values.h"

enum { N_SEEDS = 3, DEFAULT_RAYS = 2000000 };

static const double ALBEDO = 0.95;

/* A row of the table; the paper's figures, percent, of SPPG, SPP and SS. */
static const struct {
    const char *name;
    double index, period;
    double paper[3];
} crowns[] = {
    {"single, index 0.8", 0.8, 0, {6.2, 65, 16}},
    {"single, index 1.2", 1.2, 0, {6.2, 65, 16}},
    {"period 2.5, index 0.8", 0.8, 2.5, {9.2, 43, 28}},
    {"period 2.5, index 1.2", 1.2, 2.5, {9.2, 43, 28}},
    {"single, index 4", 4, 0, {(double)NAN, (double)NAN, (double)NAN}},
    {"period 2.0, index 4", 4, 2, {(double)NAN, (double)NAN, (double)NAN}},
};
enum { N_CROWNS = sizeof crowns / sizeof crowns[0] };

static const char *const level_names[PPS_SCORE_LEVELS] = {"20", "100"};

static double paper_figure(size_t crown, const char *label) {
    static const char *const printed[] = {"SPPG", "SPP", "SS"};

    for (size_t i = 0; i < 3; i++) {
        if (strcmp(label, printed[i]) == 0)
            return crowns[crown].paper[i];
    }
    return CSV_EMPTY;
}

/* One contender on one crown over the seeds: score[seed * n]. */
static int write_score(output *out, size_t crown, int level, size_t n,
                       const pps_contender *contender, const pps_score *score) {
    double mean = 0, by_count = 0, ratio = 0, least = INFINITY, most = -INFINITY;
    char row[64];

    for (size_t seed = 0; seed < N_SEEDS; seed++) {
        const pps_score *s = &score[seed * n];
        double percent = 100 * s->category[level];
        mean += percent / N_SEEDS;
        by_count += 100 * s->by_count[level] / N_SEEDS;
        ratio += s->brightness / N_SEEDS;
        least = fmin(least, percent);
        most = fmax(most, percent);
    }
    snprintf(row, sizeof row, "%s, %s meshes a category", crowns[crown].name,
             level_names[level]);
    csv_text(&out->csv, "3");
    csv_text(&out->csv, row);
    csv_text(&out->csv, contender->label);
    csv_number(&out->csv,
               level == 0 ? paper_figure(crown, contender->label) : CSV_EMPTY);
    csv_number(&out->csv, mean);
    csv_number(&out->csv, by_count);
    csv_text(&out->csv, contender->model->name);
    csv_number(&out->csv, ratio);
    csv_number(&out->csv, (most - least) / 2);
    return output_end_row(out, NULL, NULL);
}

/* What the runs share. */
typedef struct {
    uint64_t rays, seed;
    int threads;
    progress_meter meter;
    size_t n;
    const pps_contender *contender;
    pps_score *score; /* [seed * n + contender] */
} table;

static int run_crown(table *t, output *out, size_t crown) {
    int rc = CLI_DONE;

    for (uint64_t seed = 0; seed < N_SEEDS; seed++) {
        pps_experiment e = {
            .crown = {PPS_CROWN_UNIFORM, crowns[crown].index, 0, t->seed + seed},
            .period = crowns[crown].period,
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
    for (int level = 0; level < PPS_SCORE_LEVELS; level++) {
        for (size_t i = 0; i < t->n && rc == CLI_DONE; i++)
            rc = write_score(out, crown, level, t->n, &t->contender[i], t->score + i);
    }
    return rc;
}

static int run(table *t, const invocation *call, bool progress) {
    output out;
    int rc = output_open(&out, call);

    if (rc != CLI_DONE)
        return rc;
    t->contender = pps_contender_table(&t->n);
    t->score = malloc(N_SEEDS * t->n * sizeof *t->score);
    rc = t->score ? CLI_DONE : cli_no_memory();
    system_watch_signals();
    progress_start(&t->meter, progress, (size_t)N_CROWNS * N_SEEDS);
    for (size_t crown = 0; crown < N_CROWNS && rc == CLI_DONE; crown++)
        rc = run_crown(t, &out, crown);
    progress_end(&t->meter);
    free(t->score);
    return output_close(&out, rc);
}

int table_3(const invocation *call) {
    table t = {.rays = DEFAULT_RAYS};
    bool progress;
    int rc;

    if ((rc = value_count(call, OPT_SEED, 0, UINT64_MAX - N_SEEDS, &t.seed)) ||
        (rc = value_threads(call, &t.threads)) ||
        (rc = value_progress(call, &progress)))
        return rc;
    if (option_given(call, OPT_RAYS) &&
        (rc = value_count(call, OPT_RAYS, 1, 1000000000000, &t.rays)))
        return rc;
    return run(&t, call, progress);
}
