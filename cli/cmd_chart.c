/* ppscat chart: speed against accuracy, every method with every setting.
 *
 * One thread and one method at a time, so that the clock measures nothing else.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "compare.h"
#include "output.h"
#include "progress.h"
#include "settings.h"
#include "trial.h"

enum { REFERENCE_STREAMS = 256, N_REGIMES = 4 };

static const double longest_seconds = 5; /* of a setting with more photons */

/* The fixed set: thin, thick, forward-peaked, near-conservative. */
static const struct {
    const char *albedo, *g, *thickness;
} regimes[N_REGIMES] = {
    {"0.9", "0.5", "0.1"},
    {"0.95", "0", "10"},
    {"0.95", "0.8", "10"},
    {"0.999", "0.5", "50"},
};
static const char fixed_mu0[] = "0.25,0.6";

/* One row of the chart. */
typedef struct {
    const pps_method *refused_by;
    const char *refusal;
    double rms_abs, rms_rel, reflectance_error, setup, seconds;
    size_t evaluations;
} point;

typedef struct {
    output out;
    size_t n_grids, n_cases, n_settings;
    case_grid grid[N_REGIMES]; /* they differ in the slab alone */
    setting *settings;
    point *points; /* [setting * n_cases + case] */
    progress_meter progress;
} chart;

/* What a case is judged by, and room for the answers. The model stays for the beams and
 * thicknesses that follow. */
typedef struct {
    trial exact;
    const char *refusal;
    double reflected;
    double *radiance; /* of the method under test */
    pps_flux *flux;
} bench;

/* ---- what is charted ---- */

/* The grids: of the lists given, or one a regime. */
static int read_grids(chart *c, const invocation *call) {
    char names[METHOD_NAMES_SIZE];
    invocation mine = *call;
    bool own_slab = option_given(call, OPT_ALBEDO) || option_given(call, OPT_G) ||
                    option_given(call, OPT_THICKNESS);
    int rc = CLI_DONE;

    every_method(names);
    if (!option_given(call, OPT_METHOD))
        mine.text[OPT_METHOD] = names;
    if (!option_given(call, OPT_MU0) && !option_given(call, OPT_THETA0))
        mine.text[OPT_MU0] = fixed_mu0;
    c->n_grids = own_slab ? 1 : N_REGIMES;
    for (size_t i = 0; i < c->n_grids && rc == CLI_DONE; i++) {
        if (!own_slab) {
            mine.text[OPT_ALBEDO] = regimes[i].albedo;
            mine.text[OPT_G] = regimes[i].g;
            mine.text[OPT_THICKNESS] = regimes[i].thickness;
        }
        rc = grid_init(&c->grid[i], &mine, GRID_ERROR);
    }
    return rc;
}

static size_t cases_of(const case_grid *grid) {
    return compare_count(grid) / grid->n_methods;
}

/* Case i of all grids, the last list running fastest. */
static const case_grid *case_at(const chart *c, size_t i, sweep_case *at) {
    const case_grid *grid = c->grid;
    size_t rest = i;

    for (; rest >= cases_of(grid); grid++)
        rest -= cases_of(grid);
    *at = (sweep_case){.index = i, .mu0 = grid->mu0.value[rest % grid->mu0.n]};
    rest /= grid->mu0.n;
    at->depth = &grid->depth[rest % grid->thickness.n];
    at->thickness = grid->thickness.value[rest % grid->thickness.n];
    rest /= grid->thickness.n;
    at->g = grid->g.value[rest % grid->g.n];
    at->albedo = grid->albedo.value[rest / grid->g.n];
    return grid;
}

static int plan(chart *c) {
    const case_grid *grid = c->grid;

    for (size_t i = 0; i < c->n_grids; i++)
        c->n_cases += cases_of(&c->grid[i]);
    for (size_t i = 0; i < grid->n_methods; i++)
        c->n_settings += settings_count(grid->method[i]);
    c->settings = calloc(c->n_settings, sizeof *c->settings);
    c->points = calloc(c->n_settings * c->n_cases, sizeof *c->points);
    if (!c->settings || !c->points)
        return cli_no_memory();
    for (size_t i = 0, row = 0; i < grid->n_methods; i++) {
        for (size_t j = 0; j < settings_count(grid->method[i]); j++)
            c->settings[row++] = settings_at(grid->method[i], j, &grid->options);
    }
    return CLI_DONE;
}

/* ---- one point of the chart ---- */

/* Room for the largest answer of all grids. */
static int open_bench(bench *b, const chart *c) {
    size_t depths = 0, radiances;

    for (size_t i = 0; i < c->n_grids; i++) {
        if (c->grid[i].max_depths > depths)
            depths = c->grid[i].max_depths;
    }
    radiances = depths * c->grid->mu.n * c->grid->phi.n;
    *b = (bench){.radiance = malloc(radiances * sizeof *b->radiance),
                 .flux = malloc(depths * sizeof *b->flux)};
    b->exact.radiance = malloc(radiances * sizeof *b->radiance);
    return b->radiance && b->flux && b->exact.radiance ? CLI_DONE : cli_no_memory();
}

static void close_bench(bench *b) {
    pps_model_free(b->exact.model);
    free(b->exact.radiance);
    free(b->radiance);
    free(b->flux);
}

/* The reference of a case; with a new model where the medium is another. */
static int refer(bench *b, const case_grid *grid, const sweep_case *at, bool fresh) {
    pps_options options = grid->options;
    trial *exact = &b->exact;
    pps_status status;

    options.streams = REFERENCE_STREAMS;
    exact->method = pps_method_find("exact");
    exact->options = &options;
    exact->grid = grid;
    exact->at = at;
    if (!fresh && !exact->model)
        return CLI_DONE; /* refused as before */
    status = fresh ? trial_begin(exact) : trial_evaluate(exact, at->mu0);
    if (!status)
        status = trial_reflected(exact, &b->reflected);
    return sweep_judge(status, &b->refusal);
}

static bool finite(const double *x, size_t n) {
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i]))
            return false;
    }
    return true;
}

/* The errors of a first answer. */
static pps_status judge(const bench *b, const trial *t, point *p) {
    size_t depths = t->at->depth->n;
    comparison fields = {0};
    double up;
    pps_status status = trial_reflected(t, &up);

    p->rms_abs = p->rms_rel = CSV_EMPTY;
    if (t->method->fields &&
        !finite(t->radiance, depths * t->grid->mu.n * t->grid->phi.n))
        p->refusal = "the result is not a finite number";
    if (t->method->fields && !p->refusal) {
        compare_fields(t->grid, depths, t->radiance, b->exact.radiance, &fields);
        p->rms_abs = t->grid->beam * sqrt(fields.mean_square);
        p->rms_rel = fields.rms_rel;
    }
    p->reflectance_error = compare_relative(fabs(up - b->reflected), b->reflected);
    return status;
}

static int measure(chart *c, const bench *b, const setting *s, point *p) {
    trial t = {.method = s->method,
               .options = &s->options,
               .grid = b->exact.grid,
               .at = b->exact.at,
               .radiance = b->radiance,
               .flux = b->flux};
    double first = 0;
    pps_status status = trial_time_begin(&t, &first);
    int rc = CLI_DONE;

    if (!status) {
        pps_info info;
        pps_model_query(t.model, &info);
        rc = output_used(&c->out, s->method, &info);
        status = judge(b, &t, p);
    }
    if (first > trial_long) { /* that is the time; what of it is set-up stays open */
        p->seconds = first;
        p->evaluations = 1;
        p->setup = CSV_EMPTY;
    } else if (!status && rc == CLI_DONE && !p->refusal) {
        status = trial_time_evaluate(&t, &p->seconds, &p->evaluations);
        p->setup = fmax(first - p->seconds, 0);
    }
    pps_model_free(t.model);
    if (status)
        rc = sweep_judge(status, &p->refusal);
    p->refused_by = p->refusal ? s->method : NULL;
    return rc;
}

/* ---- all of them ---- */

/* Whether the setting before says that this one, with more photons, takes too long. */
static bool too_long(const chart *c, size_t s, size_t i) {
    const setting *before = c->settings + s - 1, *now = c->settings + s;
    const point *p = &c->points[(s - 1) * c->n_cases + i];

    if (s == 0 || before->method != now->method ||
        strncmp(now->text, "photons=", 8) != 0)
        return false;
    return p->refusal || p->seconds * (double)now->options.photons >
                             longest_seconds * (double)before->options.photons;
}

static int measure_case(chart *c, size_t i, bench *b) {
    sweep_case at, before = {0};
    const case_grid *grid = case_at(c, i, &at);
    bool fresh = i == 0;
    int rc;

    if (!fresh)
        case_at(c, i - 1, &before);
    fresh = fresh || at.albedo != before.albedo || at.g != before.g;
    rc = refer(b, grid, &at, fresh);
    for (size_t s = 0; s < c->n_settings && rc == CLI_DONE; s++) {
        point *p = &c->points[s * c->n_cases + i];
        if (too_long(c, s, i))
            *p = (point){.refused_by = c->settings[s].method,
                         .refusal = "left out: more photons would take too long"};
        else if (b->refusal)
            *p = (point){.refused_by = pps_method_find("exact"), .refusal = b->refusal};
        else
            rc = measure(c, b, &c->settings[s], p);
        progress_step(&c->progress);
    }
    return rc;
}

static int write_row(chart *c, const setting *s, size_t i, const point *p) {
    csv_file *csv = &c->out.csv;
    sweep_case at;

    case_at(c, i, &at);
    const double value[] = {at.albedo,
                            at.g,
                            at.thickness,
                            at.mu0,
                            p->rms_abs,
                            p->rms_rel,
                            p->reflectance_error,
                            p->setup,
                            p->seconds,
                            (double)p->evaluations};
    csv_text(csv, s->method->name);
    csv_text(csv, s->text);
    for (size_t k = 0; k < sizeof value / sizeof value[0]; k++)
        csv_number(csv, k >= 4 && p->refusal ? CSV_EMPTY : value[k]);
    return output_end_row(&c->out, p->refusal ? p->refused_by : s->method, p->refusal);
}

static int run(chart *c) {
    bench b;
    int rc = open_bench(&b, c);

    progress_start(&c->progress, c->grid->progress, c->n_settings * c->n_cases);
    for (size_t i = 0; i < c->n_cases && rc == CLI_DONE; i++)
        rc = measure_case(c, i, &b);
    progress_end(&c->progress);
    for (size_t s = 0; s < c->n_settings; s++) {
        for (size_t i = 0; i < c->n_cases && rc == CLI_DONE; i++)
            rc = write_row(c, &c->settings[s], i, &c->points[s * c->n_cases + i]);
    }
    close_bench(&b);
    return rc;
}

int cmd_chart(const invocation *call) {
    chart c = {0};
    int rc = read_grids(&c, call);

    if (rc == CLI_DONE)
        rc = plan(&c);
    if (rc == CLI_DONE)
        rc = output_open(&c.out, call);
    if (rc == CLI_DONE)
        rc = output_close(&c.out, run(&c));
    for (size_t i = 0; i < N_REGIMES; i++)
        grid_free(&c.grid[i]);
    free(c.settings);
    free(c.points);
    return rc;
}
