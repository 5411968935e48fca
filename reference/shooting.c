/* The method "rk-shooting": the plane-parallel equation integrated from the top down as an
 * initial value problem, and the unknown light leaving the top found from the bottom.
 *
 * It is here to fail: modes grow as e^(tau/mu), so that in all but thin slabs the solution
 * is a small difference of large numbers. What their errors may amount to is estimated,
 * the condition at the bottom is looked at, and both are refused where they exceed the
 * tolerance.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/method.h"
#include "reference/ode.h"
#include "reference/plane.h"

enum { MOST_STEPS = 20000 };

/* Error of a step relative to a component; that of many is taken to be ten times it. */
static const double STEP_ERROR = 1e-14, RUN_ERROR = 1e-13;

/* Columns of y: a solution for light 1 leaving the top in each direction, and one for the
 * beam with nothing leaving; rows: D, then U. y[i * columns + k]. */
static int columns(const pps_plane *p) { return p->carried + 1; }

static void shooting_slope(const void *context, double tau, const double *y,
                           double *slope) {
    const pps_plane *p = context;
    int n = p->n, rows = p->carried, wide = columns(p), beam = wide - 1;
    const double *u = y + rows * wide;
    double e = exp(-p->q * tau);
    for (int i = 0; i < rows; i++) {
        double *dd = slope + i * wide, *du = slope + (rows + i) * wide;
        for (int k = 0; k < wide; k++) {
            dd[k] = -y[i * wide + k] / p->mu[i];
            du[k] = u[i * wide + k] / p->mu[i];
        }
        for (int j = 0; j < n; j++) {
            double c = p->c[i * n + j], b = p->b[i * n + j];
            for (int k = 0; k < wide; k++) {
                dd[k] += c * y[j * wide + k] + b * u[j * wide + k];
                du[k] -= b * y[j * wide + k] + c * u[j * wide + k];
            }
        }
        dd[beam] += p->s[i] * e;
        du[beam] -= p->r[i] * e;
    }
}

/* The light leaving the top from U = 0 at the bottom, y there: x, `carried` numbers. */
static bool leaving(const pps_plane *p, const double *y, double *a, double *x) {
    int rows = p->carried, wide = columns(p);
    for (int i = 0; i < rows; i++) {
        for (int k = 0; k < rows; k++) {
            a[i * rows + k] = y[(rows + i) * wide + k];
        }
        x[i] = -y[(rows + i) * wide + wide - 1];
    }
    return pps_plane_eliminate(rows, a, 1, x);
}

/* Combine the solutions at all depths. The result is how much the difference loses: the
 * largest sum of magnitudes over the largest value. */
static double combine(const pps_plane *p, int n_tau, const double *states,
                      const double *x, double *down, double *up) {
    int rows = p->carried, wide = columns(p);
    double terms = 0, largest = 0;
    for (int k = 0; k < n_tau; k++) {
        for (int i = 0; i < 2 * rows; i++) {
            const double *y = states + (k * 2 * rows + i) * wide;
            double value = y[rows], sum = fabs(y[rows]);
            for (int j = 0; j < rows; j++) {
                value += x[j] * y[j];
                sum += fabs(x[j] * y[j]);
            }
            *(i < rows ? down + k * p->rows + i : up + k * p->rows + i - rows) = value;
            terms = fmax(terms, sum);
            largest = fmax(largest, fabs(value));
        }
    }
    return largest > 0 ? terms / largest : 1;
}

/* What misses the condition U = 0 at the bottom, over the largest value; then 0 it is. */
static double settle_bottom(const pps_plane *p, int n_tau, const double *down,
                            double *up) {
    double miss = 0, largest = 0;
    for (int k = 0; k < n_tau; k++) {
        for (int i = 0; i < p->carried; i++) {
            double *u = up + k * p->rows + i;
            largest = fmax(largest, fmax(fabs(down[k * p->rows + i]), fabs(*u)));
            if (k == n_tau - 1) {
                miss = fmax(miss, fabs(*u));
                *u = 0;
            }
        }
    }
    return largest > 0 ? miss / largest : 0;
}

/* Carry all solutions to all depths. */
static pps_status shoot(const pps_plane *p, int n_tau, const double *tau,
                        double *states) {
    size_t size = (size_t)(2 * p->carried * columns(p));
    pps_ode ode = {.n = size,
                   .slope = shooting_slope,
                   .context = p,
                   .relative = STEP_ERROR,
                   .absolute = 1e-3 * STEP_ERROR * p->albedo * fmin(1, p->w),
                   .first_step = 1 / (p->q + 1 / p->mu[0]),
                   .most_steps = MOST_STEPS};
    memset(states, 0, size * sizeof *states);
    for (int i = 0; i < p->carried; i++) {
        states[(p->carried + i) * columns(p) + i] = 1;
    }
    for (int k = 1; k < n_tau; k++) {
        double *y = states + (size_t)k * size;
        memcpy(y, y - size, size * sizeof *y);
        pps_status status = pps_ode_run(&ode, tau[k - 1], tau[k], y);
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

static double smallest_mu(const pps_plane *p) {
    double least = 1;
    for (int i = 0; i < p->carried; i++) {
        least = fmin(least, p->mu[i]);
    }
    return least;
}

static pps_status shooting_order(const pps_plane *p, int n_tau, const double *tau,
                                 double *down, double *up) {
    /* What grows by more than this has no digit left. */
    if (p->w / smallest_mu(p) > 60 || p->w * p->q > 5.0 * MOST_STEPS) {
        return PPS_ERR_UNSUPPORTED;
    }
    int rows = p->carried;
    size_t size = (size_t)(2 * rows * columns(p)), square = (size_t)(rows * rows);
    double *memory =
        malloc(((size_t)n_tau * size + square + (size_t)rows) * sizeof *memory);
    if (!memory) {
        return PPS_ERR_MEMORY;
    }
    double *a = memory + (size_t)n_tau * size, *x = a + square;
    pps_status status = shoot(p, n_tau, tau, memory);
    if (!status && !leaving(p, memory + (size_t)(n_tau - 1) * size, a, x)) {
        status = PPS_ERR_UNSUPPORTED;
    }
    if (!status) {
        double loss = combine(p, n_tau, memory, x, down, up) * RUN_ERROR;
        double miss = settle_bottom(p, n_tau, down, up);
        bool good = loss + miss <= 0.1 * p->tolerance; /* a NaN is not */
        status = good ? PPS_OK : PPS_ERR_UNSUPPORTED;
    }
    free(memory);
    return status;
}

/* ---- the method ---- */

static pps_status shooting_init(void *state, const pps_slab *slab,
                                const pps_options *opts) {
    return pps_plane_init(state, slab, opts, true, shooting_order);
}

static pps_status shooting_solve(void *state, double thickness, double mu0) {
    pps_plane_model *model = state;
    model->slab.thickness = thickness;
    model->mu0 = mu0;
    return PPS_OK;
}

static pps_status shooting_radiance(void *state, const pps_grid *at, double *radiance) {
    return pps_plane_radiance(state, at, radiance);
}

static pps_status shooting_flux(void *state, size_t n, const double *tau,
                                pps_flux *flux) {
    return pps_plane_flux(state, n, tau, flux);
}

static void shooting_query(const void *state, pps_info *info) {
    const pps_plane_model *model = state;
    *info = (pps_info){.streams = model->streams,
                       .orders = model->orders,
                       .nodes = PPS_NODES_GAUSS,
                       .error_estimate = (double)NAN};
}

static const pps_method_ops ops = {.state_size = sizeof(pps_plane_model),
                                   .init = shooting_init,
                                   .solve = shooting_solve,
                                   .radiance = shooting_radiance,
                                   .flux = shooting_flux,
                                   .query = shooting_query};

const pps_method pps_method_rk_shooting = {
    .name = "rk-shooting",
    .cost = "as rk in thin slabs",
    .summary = "linear shooting by Runge-Kutta of order 8, to show how it fails",
    .limits = "refuses but for slabs about ten times thicker than the smallest node or "
              "wanted mu, where growing modes leave no digits",
    .fields = true,
    .fluxes = true,
    .half_space = false,
    .ops = &ops,
};
