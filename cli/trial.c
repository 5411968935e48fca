/* One method at work on one case, and the processor time it takes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "trial.h"

#include <math.h>
#include <time.h>

#include "csv.h"

enum { REPEATS = 3 };
static const double clock_seconds = 5e-3; /* the clock is trusted with that */
const double trial_long = 0.3;

/* Of the whole process, all threads: other programs do not count. */
static double processor_seconds(void) {
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

pps_status trial_begin(trial *t) {
    pps_slab slab = {t->at->albedo, t->at->g, t->at->thickness};
    pps_status status;

    pps_model_free(t->model);
    status = pps_model_create(t->method, &slab, t->options, &t->model);
    return status ? status : trial_evaluate(t, t->at->mu0);
}

pps_status trial_evaluate(const trial *t, double mu0) {
    const case_grid *grid = t->grid;
    const depth_list *depth = t->at->depth;
    pps_grid where = {depth->n,   grid->mu.n,     grid->phi.n,
                      depth->tau, grid->mu.value, grid->phi.value};
    pps_status status = pps_model_solve(t->model, t->at->thickness, mu0);

    if (status)
        return status;
    if (t->method->fields)
        return pps_model_radiance(t->model, &where, t->radiance);
    return pps_model_flux(t->model, depth->n, depth->tau, t->flux);
}

pps_status trial_reflected(const trial *t, double *up) {
    pps_flux flux = {.up = CSV_EMPTY};
    double top = 0;
    pps_status status = PPS_OK;

    if (t->method->fluxes)
        status = pps_model_flux(t->model, 1, &top, &flux);
    *up = flux.up;
    return status;
}

pps_status trial_time_begin(trial *t, double *seconds) {
    pps_status status = PPS_OK;
    double spent = 0;

    *seconds = INFINITY;
    for (int i = 0; !status && (i < REPEATS || spent < REPEATS * clock_seconds); i++) {
        double start = processor_seconds(), took;
        if (spent > trial_long)
            break;
        status = trial_begin(t);
        took = processor_seconds() - start;
        *seconds = fmin(*seconds, took);
        spent += took;
    }
    return status;
}

/* `size` more evaluations; the seconds of one. */
static pps_status time_batch(const trial *t, size_t size, double *seconds, size_t *n) {
    double start = processor_seconds();
    pps_status status = PPS_OK;

    for (size_t i = 0; i < size && !status; i++) {
        double mu0 = *n % 2 ? t->at->mu0 : 0.99 * t->at->mu0;
        status = trial_evaluate(t, mu0);
        ++*n;
    }
    *seconds = (processor_seconds() - start) / (double)size;
    return status;
}

pps_status trial_time_evaluate(const trial *t, double *seconds, size_t *n) {
    size_t size = 1;
    double took;
    pps_status status;

    *n = 0;
    status = time_batch(t, size, seconds, n);
    while (!status && *seconds * (double)size < clock_seconds) {
        size *= 2;
        status = time_batch(t, size, seconds, n);
    }
    for (int i = 1; i < REPEATS && !status && *seconds < trial_long; i++) {
        status = time_batch(t, size, &took, n);
        *seconds = fmin(*seconds, took);
    }
    return status;
}
