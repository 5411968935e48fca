/* Tables 4 and 5 of the SPP paper: times of the rendering system, measured by the preview.
 *
 * The paper's machine was a Core2 Quad Q8200 with a GeForce GTX 295; what compares is how
 * times grow from 16 plants to 64. The rows name the processor, and the renderer of OpenGL
 * for what that does.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "preview_bench.h"
#include "progress.h"
#include "system.h"
#include "values.h"

/* A column: the sum of some pieces of the preview's work, milliseconds. */
typedef struct {
    const char *name, *work[2];
    bool on_gpu;
} timing;

static const timing timings[] = {
    {"2 + 3 preprocess, ms", {"maps", "depths and G"}, false},
    {"4 skylight change, ms", {"sky", NULL}, false},
    {"5 sunlight change, ms", {"maps of the sun on the GPU", NULL}, true},
    {"6 display, ms", {"frame", NULL}, true},
};
enum { N_TIMINGS = sizeof timings / sizeof timings[0], N_SCENES = 4 };

/* SPP paper, Table 4. */
static const struct {
    const char *name;
    double polygons, cells, ms[N_TIMINGS];
} scenes[N_SCENES] = {
    {"CHERRY16", 1.0e6, 13e3, {117, 25, 3.9, 27}},
    {"CHERRY64", 4.0e6, 52e3, {533, 100, 3.9, 101}},
    {"MAPLE16", 3.5e6, 10e3, {95.3, 20, 6.7, 29}},
    {"MAPLE64", 14e6, 40e3, {426, 80, 6.7, 131}},
};

/* What the runs share. */
typedef struct {
    output out;
    char processor[80], jobs[16];
    progress_meter meter;
} table;

/* The preview's times of a scene with a model; a refusal is the row's. */
static int run_preview(table *t, const char *scene, const char *model,
                       preview_times *times, const char **why) {
    const char *const arguments[] = {"--model", model,   "--samples", "1",
                                     "--jobs",  t->jobs, scene,       NULL};
    int rc = preview_bench(arguments, times, why);

    progress_step(&t->meter);
    return system_signal() ? cli_failed("interrupted; nothing is written") : rc;
}

static int write_count(table *t, size_t scene, const char *column, double paper,
                       double ours) {
    table_row row = table_blank("4", scenes[scene].name, column, "sppg");

    row.paper = paper;
    row.ours = ours;
    return table_write(&t->out, &row);
}

static double time_of(const preview_times *times, const timing *what) {
    double ms = preview_ms(times, what->work[0]);

    return what->work[1] ? ms + preview_ms(times, what->work[1]) : ms;
}

static int write_scene(table *t, size_t scene, const preview_times *times,
                       double ms[N_TIMINGS]) {
    const preview_time *any = &times->row[0];
    int rc = write_count(t, scene, "polygons", scenes[scene].polygons,
                         (double)any->triangles);

    if (rc == CLI_DONE)
        rc = write_count(t, scene, "cells", scenes[scene].cells, (double)any->cells);
    for (size_t i = 0; i < N_TIMINGS && rc == CLI_DONE; i++) {
        table_row row = table_blank("4", scenes[scene].name, timings[i].name,
                                    timings[i].on_gpu ? any->renderer : t->processor);
        row.paper = scenes[scene].ms[i];
        row.ours = ms[i] = time_of(times, &timings[i]);
        rc = table_write(&t->out, &row);
    }
    return rc;
}

/* How much longer 64 plants take than 16. */
static int write_growth(table *t, size_t few, double ms[N_SCENES][N_TIMINGS]) {
    char name[40];
    int rc = CLI_DONE;

    snprintf(name, sizeof name, "%s / %s", scenes[few + 1].name, scenes[few].name);
    for (size_t i = 0; i < N_TIMINGS && rc == CLI_DONE; i++) {
        table_row row = table_blank("4", name, timings[i].name, "sppg");
        row.paper = scenes[few + 1].ms[i] / scenes[few].ms[i];
        row.ours = ms[few + 1][i] / ms[few][i];
        rc = table_write(&t->out, &row);
    }
    return rc;
}

static int write_refusal(table *t, const char *number, const char *row,
                         const char *why) {
    table_row refused = table_blank(number, row, "", "sppg");

    refused.refusal = why;
    return table_write(&t->out, &refused);
}

static int rows_of_table_4(table *t) {
    double ms[N_SCENES][N_TIMINGS];
    int rc = CLI_DONE;

    for (size_t i = 0; i < N_SCENES && rc == CLI_DONE; i++) {
        preview_times times;
        const char *why;
        for (size_t k = 0; k < N_TIMINGS; k++)
            ms[i][k] = CSV_EMPTY;
        rc = run_preview(t, scenes[i].name, "sppg", &times, &why);
        if (rc == CLI_DONE)
            rc = write_scene(t, i, &times, ms[i]);
        else if (rc == CLI_REFUSED)
            rc = write_refusal(t, "4", scenes[i].name, why);
    }
    for (size_t few = 0; few < N_SCENES && rc == CLI_DONE; few += 2)
        rc = write_growth(t, few, ms);
    return rc;
}

/* Figure 11's models, and ours. */
static const struct {
    const char *label, *model;
} pictures[] = {{"SPPG", "sppg"}, {"SS", "ss"}, {"MC", "mc"}, {"lattice", "lattice"}};
enum { N_PICTURES = sizeof pictures / sizeof pictures[0] };

static const char *const pictured[] = {"CHERRY16", "MAPLE16"};
enum { N_PICTURED = sizeof pictured / sizeof pictured[0] };

/* A picture from nothing, and again after the sun has moved. */
static int write_picture(table *t, const char *scene, const char *label,
                         const preview_times *times) {
    static const char *const before[] = {"cells", "maps", "depths and G", "sky"};
    static const char *const after[] = {"sun", "maps of the sun on the GPU", "frame"};
    double moved = 0, whole = 0;
    char column[40];

    for (size_t i = 0; i < sizeof after / sizeof after[0]; i++)
        moved += preview_ms(times, after[i]) / 1000;
    for (size_t i = 0; i < sizeof before / sizeof before[0]; i++)
        whole += preview_ms(times, before[i]) / 1000;
    snprintf(column, sizeof column, "%s, s", label);
    table_row row = table_blank("5", scene, column, times->row[0].renderer);
    row.ours = whole + moved;
    int rc = table_write(&t->out, &row);
    snprintf(column, sizeof column, "%s, sun moved, s", label);
    row.ours = moved;
    return rc == CLI_DONE ? table_write(&t->out, &row) : rc;
}

static int rows_of_table_5(table *t) {
    int rc = CLI_DONE;

    for (size_t i = 0; i < N_PICTURED * N_PICTURES && rc == CLI_DONE; i++) {
        const char *scene = pictured[i / N_PICTURES], *why;
        size_t k = i % N_PICTURES;
        preview_times times;
        rc = run_preview(t, scene, pictures[k].model, &times, &why);
        if (rc == CLI_DONE)
            rc = write_picture(t, scene, pictures[k].label, &times);
        else if (rc == CLI_REFUSED)
            rc = write_refusal(t, "5", scene, why);
    }
    return rc;
}

static int run(const invocation *call, size_t steps, int (*rows)(table *t)) {
    table t;
    bool progress;
    int threads, rc;

    if ((rc = value_threads(call, &threads)) ||
        (rc = value_progress(call, &progress)) || (rc = output_open(&t.out, call)))
        return rc;
    snprintf(t.jobs, sizeof t.jobs, "%d", threads);
    system_processor(t.processor, sizeof t.processor);
    system_watch_signals();
    progress_start(&t.meter, progress, steps);
    rc = rows(&t);
    progress_end(&t.meter);
    return output_close(&t.out, rc);
}

int table_4(const invocation *call) { return run(call, N_SCENES, rows_of_table_4); }

int table_5(const invocation *call) {
    return run(call, (size_t)N_PICTURED * N_PICTURES, rows_of_table_5);
}
