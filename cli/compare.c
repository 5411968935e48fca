/* Comparing methods with `exact`, which is computed once a case for all of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "compare.h"

#include <math.h>
#include <stdlib.h>

#include "cli.h"
#include "system.h"

/* The answer of one method to a case. */
typedef struct {
    const char *refusal;
    pps_info info;
    double *radiance; /* [(k * n_mu + j) * n_phi + i] */
    double reflected, transmitted, seconds;
} answer;

static size_t n_radiances(const sweep_unit *unit) {
    return unit->depth.n * unit->mu.n * unit->phi.n;
}

static int solve_radiance(const sweep_worker *worker, const sweep_unit *unit,
                          double mu0, answer *a) {
    pps_grid where = {unit->depth.n,     unit->mu.n,     unit->phi.n,
                      unit->depth.value, unit->mu.value, unit->phi.value};
    double start = system_seconds();
    int rc = sweep_solve(worker, unit->thickness, mu0, &a->refusal);

    if (rc != CLI_DONE || a->refusal)
        return rc;
    if (!worker->method->fields) {
        a->refusal = "the method gives fluxes only, no radiance";
        return CLI_DONE;
    }
    rc = sweep_judge(pps_model_radiance(worker->model, &where, a->radiance),
                     &a->refusal);
    a->seconds = system_seconds() - start;
    if (rc != CLI_DONE || a->refusal)
        return rc;
    pps_model_query(worker->model, &a->info);
    for (size_t i = 0; i < n_radiances(unit); i++) {
        if (!isfinite(a->radiance[i]))
            a->refusal = "the result is not a finite number";
    }
    return CLI_DONE;
}

/* Diffuse fluxes out of the slab; NAN where there are none. */
static int solve_fluxes(const sweep_worker *worker, const sweep_unit *unit, answer *a) {
    double tau[2] = {0, unit->thickness};
    pps_flux flux[2];
    size_t n = isinf(unit->thickness) ? 1 : 2;
    const char *refusal;
    int rc;

    a->reflected = a->transmitted = (double)NAN;
    if (a->refusal || !worker->method->fluxes)
        return CLI_DONE;
    rc = sweep_judge(pps_model_flux(worker->model, n, tau, flux), &refusal);
    if (rc != CLI_DONE || refusal)
        return rc;
    a->reflected = flux[0].up;
    if (n == 2)
        a->transmitted = flux[1].down;
    return CLI_DONE;
}

static int solve(const sweep_worker *worker, const sweep_unit *unit, double mu0,
                 answer *a) {
    int rc = solve_radiance(worker, unit, mu0, a);

    return rc == CLI_DONE ? solve_fluxes(worker, unit, a) : rc;
}

double compare_relative(double x, double whole) {
    if (whole > 0)
        return x / whole;
    return x == 0 ? 0 : (double)NAN;
}

/* Means over the directions at depth k: of the squared difference, of the exact. */
static void compare_depth(const case_grid *grid, size_t k, const double *got,
                          const double *want, double *mean_square, double *mean) {
    size_t at = k * grid->mu.n * grid->phi.n;

    *mean_square = *mean = 0;
    for (size_t j = 0; j < grid->mu.n; j++) {
        for (size_t i = 0; i < grid->phi.n; i++, at++) {
            double weight = grid->mu_weight[j] * grid->phi_weight[i];
            double difference = got[at] - want[at];
            *mean_square += weight * difference * difference;
            *mean += weight * want[at];
        }
    }
}

void compare_fields(const case_grid *grid, size_t n_depths, const double *got,
                    const double *want, comparison *c) {
    size_t n = n_depths * grid->mu.n * grid->phi.n;

    for (size_t k = 0; k < n_depths; k++) {
        double mean_square, mean;
        compare_depth(grid, k, got, want, &mean_square, &mean);
        c->mean_square += mean_square / (double)n_depths;
        c->rms_rel += compare_relative(sqrt(mean_square), mean) / (double)n_depths;
    }
    for (size_t i = 0; i < n; i++)
        c->max_abs = fmax(c->max_abs, fabs(got[i] - want[i]));
}

static void compare(const case_grid *grid, const sweep_unit *unit, const answer *a,
                    const answer *exact, comparison *c) {
    compare_fields(grid, unit->depth.n, a->radiance, exact->radiance, c);
    c->reflectance_error =
        compare_relative(fabs(a->reflected - exact->reflected), exact->reflected);
    c->transmittance_error =
        compare_relative(fabs(a->transmitted - exact->transmitted), exact->transmitted);
    c->seconds = a->seconds;
}

/* What was used goes into the record, unless it was refused. */
static int note(const sweep_worker *worker, const answer *a, sweep_tile *t) {
    return a->refusal ? CLI_DONE : record_used(&t->record, worker->method, &a->info);
}

/* All methods on one case; radiance has room for two fields. */
static int compare_case(const sweep_station *own, const sweep_unit *unit, double mu0,
                        double *radiance, comparison *c, sweep_tile *t) {
    size_t n_methods = own->task->grid->n_methods;
    const sweep_worker *reference = &own->workers[n_methods];
    answer exact = {.radiance = radiance};
    int rc = solve(reference, unit, mu0, &exact);

    for (size_t i = 0; i < n_methods && rc == CLI_DONE; i++) {
        answer a = {.radiance = radiance + n_radiances(unit)};
        rc = solve(&own->workers[i], unit, mu0, &a);
        c[i] = (comparison){.refused_by = own->workers[i].method, .refusal = a.refusal};
        if (!a.refusal && exact.refusal)
            c[i] = (comparison){reference->method, .refusal = exact.refusal};
        if (!c[i].refusal)
            compare(own->task->grid, unit, &a, &exact, &c[i]);
        if (rc == CLI_DONE)
            rc = note(&own->workers[i], &a, t);
    }
    return rc == CLI_DONE ? note(reference, &exact, t) : rc;
}

int compare_unit(const sweep_station *own, const sweep_unit *unit, comparison *c,
                 sweep_tile *t) {
    double *radiance = malloc(2 * n_radiances(unit) * sizeof *radiance);
    int rc = radiance ? CLI_DONE : cli_no_memory();

    for (size_t b = 0; b < unit->mu0.n && rc == CLI_DONE; b++) {
        rc = compare_case(own, unit, unit->mu0.value[b], radiance,
                          c + b * own->task->grid->n_methods, t);
        if (rc == CLI_DONE && !sweep_go_on(own))
            rc = CLI_FAILED;
    }
    free(radiance);
    return rc;
}

/* ---- all at once, in memory ---- */

static int evaluate(const sweep_station *own, const sweep_unit *unit, double *values,
                    sweep_tile *t) {
    const case_grid *grid = own->task->grid;
    comparison *result = own->task->context;
    size_t n_cases = compare_count(grid) / grid->n_methods;
    size_t i_case = (unit->i_albedo * grid->g.n + unit->i_g) * grid->thickness.n;
    comparison *c = malloc(unit->mu0.n * grid->n_methods * sizeof *c);
    int rc = c ? compare_unit(own, unit, c, t) : cli_no_memory();

    (void)values;
    i_case = (i_case + unit->i_thickness) * grid->mu0.n + unit->mu0.first;
    for (size_t b = 0; b < unit->mu0.n && rc == CLI_DONE; b++) {
        for (size_t i = 0; i < grid->n_methods; i++)
            result[i * n_cases + i_case + b] = c[b * grid->n_methods + i];
    }
    free(c);
    return rc;
}

static int render_nothing(const sweep_station *own, const sweep_unit *unit,
                          const double *values, sweep_tile *t) {
    (void)own;
    (void)unit;
    (void)values;
    (void)t;
    return CLI_DONE;
}

static int add_record(void *context, const sweep_tile *t) {
    return record_add(context, &t->record);
}

size_t compare_count(const case_grid *grid) {
    return grid->n_methods * grid->albedo.n * grid->g.n * grid->thickness.n *
           grid->mu0.n;
}

int compare_run(const case_grid *grid, record *used, comparison *result) {
    sweep_task task = {.grid = grid,
                       .reference = pps_method_find("exact"),
                       .shape = ROWS_CASE,
                       .evaluate = evaluate,
                       .render = render_nothing,
                       .context = result};
    sweep_plan plan;

    plan_init(&plan, grid, task.shape);
    return sweep_run(&task, &plan, 0, true, add_record, used);
}
