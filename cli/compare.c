/* Comparing methods with `exact`, which is computed once a case for all of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "compare.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include <omp.h>

#include "cli.h"
#include "sweep.h"

/* The answer of one method to a case. */
typedef struct {
    const char *refusal;
    pps_info info;
    double *radiance; /* [(k * n_mu + j) * n_phi + i] */
    double reflected, transmitted, seconds;
} answer;

/* The comparisons of a case, and what each method and at last the reference used. */
typedef struct {
    comparison result;
    bool answered;
    pps_info info;
} verdict;

typedef struct {
    output *out;
    comparison *result;
} compare_job;

static size_t n_radiances(const case_grid *grid, const sweep_case *at) {
    return at->depth->n * grid->mu.n * grid->phi.n;
}

static int solve_radiance(const sweep_task *task, const sweep_worker *worker,
                          const sweep_case *at, answer *a) {
    const case_grid *grid = task->grid;
    pps_grid where = {at->depth->n,   grid->mu.n,     grid->phi.n,
                      at->depth->tau, grid->mu.value, grid->phi.value};
    double start = omp_get_wtime();
    int rc = sweep_solve(worker, at, &a->refusal);

    if (rc != CLI_DONE || a->refusal)
        return rc;
    if (!worker->method->fields) {
        a->refusal = "the method gives fluxes only, no radiance";
        return CLI_DONE;
    }
    rc = sweep_judge(pps_model_radiance(worker->model, &where, a->radiance),
                     &a->refusal);
    a->seconds = omp_get_wtime() - start;
    if (rc != CLI_DONE || a->refusal)
        return rc;
    pps_model_query(worker->model, &a->info);
    for (size_t i = 0; i < n_radiances(grid, at); i++) {
        if (!isfinite(a->radiance[i]))
            a->refusal = "the result is not a finite number";
    }
    return CLI_DONE;
}

/* Diffuse fluxes out of the slab; NAN where there are none. */
static int solve_fluxes(const sweep_worker *worker, const sweep_case *at, answer *a) {
    double tau[2] = {0, at->thickness};
    pps_flux flux[2];
    size_t n = isinf(at->thickness) ? 1 : 2;
    const char *refusal;
    int rc;

    a->reflected = a->transmitted = CSV_EMPTY;
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

static int solve(const sweep_task *task, const sweep_worker *worker,
                 const sweep_case *at, answer *a) {
    int rc = solve_radiance(task, worker, at, a);

    return rc == CLI_DONE ? solve_fluxes(worker, at, a) : rc;
}

double compare_relative(double x, double whole) {
    if (whole > 0)
        return x / whole;
    return x == 0 ? 0 : CSV_EMPTY;
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

static void compare(const case_grid *grid, const sweep_case *at, const answer *a,
                    const answer *exact, comparison *c) {
    compare_fields(grid, at->depth->n, a->radiance, exact->radiance, c);
    c->reflectance_error =
        compare_relative(fabs(a->reflected - exact->reflected), exact->reflected);
    c->transmittance_error =
        compare_relative(fabs(a->transmitted - exact->transmitted), exact->transmitted);
    c->seconds = a->seconds;
}

static void judge(const sweep_task *task, const sweep_worker *worker,
                  const sweep_case *at, const answer *a, const answer *exact,
                  verdict *v) {
    *v = (verdict){.answered = !a->refusal, .info = a->info};
    if (a->refusal || exact->refusal) {
        v->result.refused_by = a->refusal ? worker->method : task->reference;
        v->result.refusal = a->refusal ? a->refusal : exact->refusal;
    } else {
        compare(task->grid, at, a, exact, &v->result);
    }
}

static int evaluate(const sweep_task *task, const sweep_worker *workers,
                    const sweep_case *at, void *block) {
    size_t n = n_radiances(task->grid, at), n_methods = task->grid->n_methods;
    double *radiance = malloc(2 * n * sizeof *radiance);
    answer exact = {.radiance = radiance};
    verdict *v = block;
    int rc;

    if (!radiance)
        return cli_no_memory();
    rc = solve(task, &workers[n_methods], at, &exact);
    v[n_methods] = (verdict){.answered = !exact.refusal, .info = exact.info};
    for (size_t i = 0; i < n_methods && rc == CLI_DONE; i++) {
        answer a = {.radiance = radiance + n};
        rc = solve(task, &workers[i], at, &a);
        judge(task, &workers[i], at, &a, &exact, &v[i]);
    }
    free(radiance);
    return rc;
}

/* From the order of tiles, all methods a case, to the order of rows. */
static int emit(const sweep_task *task, const sweep_worker *workers,
                const sweep_case *at, const void *block) {
    const verdict *v = block;
    compare_job *job = task->context;
    size_t n_methods = task->grid->n_methods;
    size_t n_cases = compare_count(task->grid) / n_methods;
    int rc = CLI_DONE;

    for (size_t i = 0; i <= n_methods && rc == CLI_DONE; i++) {
        if (v[i].answered)
            rc = output_used(job->out, workers[i].method, &v[i].info);
        if (i < n_methods)
            job->result[i * n_cases + at->index] = v[i].result;
    }
    return rc;
}

size_t compare_count(const case_grid *grid) {
    return grid->n_methods * grid->albedo.n * grid->g.n * grid->thickness.n *
           grid->mu0.n;
}

int compare_run(const case_grid *grid, output *out, comparison *result) {
    compare_job job = {out, result};
    sweep_task task = {.grid = grid,
                       .reference = pps_method_find("exact"),
                       .block_size = (grid->n_methods + 1) * sizeof(verdict),
                       .evaluate = evaluate,
                       .emit = emit,
                       .context = &job};

    return sweep_run(&task);
}
