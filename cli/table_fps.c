/* The frame rates of the second paper (B section 7): 1, 4 and 100 trees of 98,000
 * triangles. Here the processor lights every leaf anew, as it must when sun and sky move,
 * and the preview draws.
 *
 * Attenuations are those of a tree alone, found once for all that are turned alike, as the
 * paper draws one tree many times.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables.h"

#include <ppscat/tree/leaf_light.h>

#include <stdio.h>
#include <stdlib.h>

#include "cli.h"
#include "preview_bench.h"
#include "progress.h"
#include "system.h"
#include "values.h"

enum { N_LIGHTS = 3 };

static const struct {
    const char *name;
    unsigned sources;
} lights[N_LIGHTS] = {
    {"direct sky", PPS_SKY},
    {"direct sky + sun", PPS_SKY | PPS_SUN},
    {"all", PPS_SKY | PPS_SUN | PPS_SUN_INDIRECT},
};

static const struct {
    const char *name, *scene;
    double paper[N_LIGHTS]; /* frames a second of a GeForce 8800 GTX */
} rows[] = {
    {"1 tree", "leaf-trees-1", {788, 700, 667}},
    {"4 trees", "leaf-trees-4", {418, 349, 326}},
    {"100 trees", "leaf-trees-100", {36, 29, 27}},
};
enum { N_ROWS = sizeof rows / sizeof rows[0] };

/* What the runs share. */
typedef struct {
    output out;
    int threads;
    char processor[80], jobs[16];
    progress_meter meter;
} table;

static table_row make_row(size_t i, const char *column, const char *method) {
    return table_blank("fps", rows[i].name, column, method);
}

/* Seconds to light every leaf. */
static pps_status time_light(const pps_scene *scene, const float *att, unsigned sources,
                             pps_irradiance *light, double *seconds) {
    double start = system_seconds(), passed = 0;
    pps_status status = PPS_OK;
    int n = 0;

    while (!status && passed < 0.3) {
        status = pps_leaf_light(scene, att, PPS_SUN_PRINTED, sources, light);
        passed = system_seconds() - start;
        n++;
    }
    *seconds = passed / n;
    return status;
}

static pps_status attenuate(const table *t, const pps_scene *scene, float **att) {
    pps_attenuation_options options = {.threads = t->threads, .apart = true};

    return pps_leaf_attenuation_create(scene, &options, att);
}

static int write_lights(table *t, size_t i, const pps_scene *scene) {
    float *att = NULL;
    pps_irradiance *light = NULL;
    pps_status status = attenuate(t, scene, &att);
    int rc = CLI_DONE;

    if (!status)
        status = pps_irradiance_create(scene, false, &light);

    for (size_t k = 0; k < N_LIGHTS && !status && rc == CLI_DONE; k++) {
        table_row row = make_row(i, lights[k].name, t->processor);
        double seconds = 0;
        status = time_light(scene, att, lights[k].sources, light, &seconds);
        row.paper = rows[i].paper[k];
        row.ours = 1 / seconds;
        row.seconds_per_leaf = seconds / (double)scene->n_leaves;
        if (!status)
            rc = table_write(&t->out, &row);
    }
    pps_irradiance_free(light);
    free(att);
    return status ? cli_failed("%s", pps_status_string(status)) : rc;
}

/* How fast the preview draws them, all light; refused without one. */
static int write_frames(table *t, size_t i) {
    const char *const arguments[] = {
        "--model",          "leaf",   "--apart", "--samples",   "1", "--component",
        "sky,sun,indirect", "--jobs", t->jobs,   rows[i].scene, NULL};
    table_row row = make_row(i, "all, drawn", "leaf");
    preview_times times;
    int rc = preview_bench(arguments, &times, &row.refusal);

    if (system_signal())
        return cli_failed("interrupted; nothing is written");
    if (rc == CLI_DONE) {
        row.refusal = NULL;
        row.method = times.row[0].renderer;
        row.paper = rows[i].paper[N_LIGHTS - 1];
        row.ours = 1000 / preview_ms(&times, "frame");
    }
    return table_write(&t->out, &row);
}

static int write_row(table *t, size_t i) {
    pps_scene *scene = NULL;
    pps_status status = pps_scene_read(rows[i].scene, &scene, NULL);
    int rc = status ? cli_failed("%s", pps_status_string(status))
                    : write_lights(t, i, scene);

    pps_scene_free(scene);
    if (rc == CLI_DONE)
        rc = write_frames(t, i);
    progress_step(&t->meter);
    return rc;
}

/* The part that is done once: what a tree's leaves leave of the light in each octant. */
static int prepare(table *t) {
    table_row row = make_row(0, "trees prepared a second", t->processor);
    pps_scene *scene = NULL;
    float *att = NULL;
    pps_status status = pps_scene_read(rows[0].scene, &scene, NULL);

    if (!status) {
        double start = system_seconds();
        status = attenuate(t, scene, &att);
        double seconds = system_seconds() - start;
        row.ours = 1 / seconds;
        row.seconds_per_leaf = seconds / (double)scene->n_leaves;
    }
    free(att);
    pps_scene_free(scene);
    return status ? cli_failed("%s", pps_status_string(status))
                  : table_write(&t->out, &row);
}

int table_fps(const invocation *call) {
    table t = {0};
    bool progress;
    int rc;

    if ((rc = value_threads(call, &t.threads)) ||
        (rc = value_progress(call, &progress)) || (rc = output_open(&t.out, call)))
        return rc;
    snprintf(t.jobs, sizeof t.jobs, "%d", t.threads);
    system_processor(t.processor, sizeof t.processor);
    system_watch_signals();
    progress_start(&t.meter, progress, N_ROWS);
    rc = prepare(&t);
    for (size_t i = 0; i < N_ROWS && rc == CLI_DONE; i++)
        rc = write_row(&t, i);
    progress_end(&t.meter);
    return output_close(&t.out, rc);
}
