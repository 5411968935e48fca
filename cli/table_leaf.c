/* Tables of the second paper: its Figure 7 in numbers, and the cost of its components.
 *
 * The paper does not say what its "average error" is; the mean |difference| over the
 * brightest radiance fits it, and is given beside the mean relative error, which does not.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables.h"

#include <ppscat/tree/grow.h>
#include <ppscat/tree/leaf_light.h>
#include <ppscat/tree/seen.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "progress.h"
#include "system.h"
#include "values.h"

/* With fewer paths (the paper took 256) the smallest crown's indirect light, whose mean is
 * over few leaves, has noise that counts: 11.3 % by 256 paths, 10.7 by 1024, 10.8 by 4096. */
enum { N_SEEDS = 3, PIXELS = 256, N_VIEWS = 3, N_PARTS = 4, DEFAULT_PATHS = 1024 };

/* The crowns that the paper's trees stand for: leaves and leaf-area index. */
static const struct {
    const char *name;
    pps_crown crown;
} crowns[] = {
    {"1500 leaves, index 6", {PPS_CROWN_UNIFORM, 6, 1500, 0}},
    {"4000 leaves clumped, index 5", {PPS_CROWN_CLUMPED, 5, 4000, 0}},
    {"9000 leaves, index 6", {PPS_CROWN_UNIFORM, 6, 9000, 0}},
};
enum { N_CROWNS = sizeof crowns / sizeof crowns[0] };

/* The sun stands high, and at the right of the side view, as in the paper's figure; views
 * are level, by their azimuth from the sun. */
static const double sun_to[3] = {0.5, 0.3, 0.8};
static const struct {
    const char *name;
    double cosine, sine;
} views[N_VIEWS] = {{"side", 0, -1}, {"lit", 1, 0}, {"back-lit", -1, 0}};

static const struct {
    const char *name;
    unsigned sources;
    pps_sun_mean mean;
    double paper; /* percent, the side view */
} parts[N_PARTS] = {
    {"sky", PPS_SKY, PPS_SUN_PRINTED, 5},
    {"sun", PPS_SUN, PPS_SUN_PRINTED, 7.5},
    {"sun unbiased", PPS_SUN, PPS_SUN_UNBIASED, (double)NAN},
    {"indirect", PPS_SUN_INDIRECT, PPS_SUN_PRINTED, 6},
};

/* All numbers of one crown: [view][part][seed]. */
typedef struct {
    pps_seen_difference by[N_VIEWS][N_PARTS][N_SEEDS];
} crown_result;

/* What the runs share. */
typedef struct {
    uint64_t seed;
    int samples, threads;
    progress_meter meter;
} figure;

/* Leaves that reflect 0.25 and let 0.2 through; sky .6 + .8 z, .25 from below. */
static pps_status make_scene(const pps_crown *crown, pps_scene **out) {
    pps_mesh *mesh;
    pps_status status = pps_crown_grow(crown, &mesh);

    *out = NULL;
    if (!status)
        status = pps_scene_single(mesh, 0, out);
    if (status)
        return status;
    pps_scene *scene = *out;
    double length =
        sqrt(sun_to[0] * sun_to[0] + sun_to[1] * sun_to[1] + sun_to[2] * sun_to[2]);
    for (int k = 0; k < 3; k++)
        scene->sun.to[k] = sun_to[k] / length;
    for (int face = 0; face < 2; face++) {
        scene->prototype[0].optics.reflectance[face][0] = 0.25;
        scene->prototype[0].optics.transmittance[face][0] = 0.2;
    }
    scene->sky = (pps_sky){.zenith = {1.4}, .horizon = {0.6}, .below = {0.25}};
    return pps_scene_index(scene);
}

static void view_direction(int view, double to[3]) {
    double length = hypot(sun_to[0], sun_to[1]);
    double x = sun_to[0] / length, y = sun_to[1] / length;

    to[0] = views[view].cosine * x - views[view].sine * y;
    to[1] = views[view].sine * x + views[view].cosine * y;
    to[2] = 0;
}

/* One component of one crown: Monte Carlo of one bounce, the model, three views. */
static pps_status measure_part(figure *f, const pps_scene *scene, const float *att,
                               int part, int seed, crown_result *result) {
    pps_trace_options options = {.seed = f->seed + (uint64_t)seed,
                                 .bounces = 1,
                                 .threads = f->threads,
                                 .sources = parts[part].sources};
    pps_irradiance *truth = NULL, *light = NULL;
    pps_status status = pps_gather_light(scene, 0, NULL, f->samples, &options, &truth);

    if (!status)
        status = pps_irradiance_create(scene, false, &light);
    if (!status)
        status =
            pps_leaf_light(scene, att, parts[part].mean, parts[part].sources, light);
    for (int view = 0; view < N_VIEWS && !status; view++) {
        double to[3];
        view_direction(view, to);
        status = pps_seen_compare(scene, truth, light, to, PIXELS,
                                  &result->by[view][part][seed]);
    }
    pps_irradiance_free(truth);
    pps_irradiance_free(light);
    return status;
}

static pps_status measure_crown(figure *f, const pps_crown *plain, int seed,
                                crown_result *result) {
    pps_crown crown = *plain;
    pps_scene *scene = NULL;
    float *att = NULL;
    pps_status status;

    crown.seed = f->seed + (uint64_t)seed;
    status = make_scene(&crown, &scene);
    if (!status)
        status = pps_leaf_attenuation_create(scene, NULL, &att);
    for (int part = 0; part < N_PARTS && !status; part++) {
        if (system_signal())
            status = PPS_ERR_CANCELLED;
        else
            status = measure_part(f, scene, att, part, seed, result);
        progress_step(&f->meter);
    }
    free(att);
    pps_scene_free(scene);
    return status;
}

/* Means over the seeds, and half the range of the first number. */
static table_row summarize(const char *crown, int view, int part, char *column,
                           size_t size, const pps_seen_difference *by) {
    table_row row = {.table = "figure7",
                     .row = crown,
                     .method = "leaf",
                     .seconds_per_cell = CSV_EMPTY,
                     .rms_leaf = CSV_EMPTY,
                     .seconds_per_leaf = CSV_EMPTY};
    double least = INFINITY, most = -INFINITY;

    for (int i = 0; i < N_SEEDS; i++) {
        row.ours += 100 * by[i].over_top / N_SEEDS;
        row.rms_rel += 100 * by[i].relative / N_SEEDS;
        row.ratio += by[i].ratio / N_SEEDS;
        least = fmin(least, 100 * by[i].over_top);
        most = fmax(most, 100 * by[i].over_top);
    }
    snprintf(column, size, "%s %s", views[view].name, parts[part].name);
    row.column = column;
    row.paper = view == 0 ? parts[part].paper : CSV_EMPTY;
    row.spread = (most - least) / 2;
    return row;
}

static int write_crown(output *out, const char *name, const crown_result *result) {
    int rc = CLI_DONE;

    for (int view = 0; view < N_VIEWS; view++) {
        for (int part = 0; part < N_PARTS && rc == CLI_DONE; part++) {
            char column[40];
            table_row row = summarize(name, view, part, column, sizeof column,
                                      result->by[view][part]);
            rc = table_write(out, &row);
        }
    }
    return rc;
}

static int figure7_rows(figure *f, output *out) {
    int rc = CLI_DONE;

    for (size_t c = 0; c < N_CROWNS && rc == CLI_DONE; c++) {
        crown_result result;
        pps_status status = PPS_OK;
        for (int seed = 0; seed < N_SEEDS && !status; seed++)
            status = measure_crown(f, &crowns[c].crown, seed, &result);
        rc = status ? cli_failed("%s", pps_status_string(status))
                    : write_crown(out, crowns[c].name, &result);
    }
    return rc;
}

int table_figure7(const invocation *call) {
    uint64_t samples = DEFAULT_PATHS;
    bool progress;
    figure f = {0};
    output out;
    int rc;

    if ((rc = value_count(call, OPT_SEED, 0, UINT64_MAX - N_SEEDS, &f.seed)) ||
        (option_given(call, OPT_SAMPLES) &&
         (rc = value_count(call, OPT_SAMPLES, 1, 1000000, &samples))) ||
        (rc = value_threads(call, &f.threads)) ||
        (rc = value_progress(call, &progress)) || (rc = output_open(&out, call)))
        return rc;
    f.samples = (int)samples;
    system_watch_signals();
    progress_start(&f.meter, progress, N_CROWNS * N_SEEDS * (size_t)N_PARTS);
    rc = figure7_rows(&f, &out);
    progress_end(&f.meter);
    return output_close(&out, rc);
}
