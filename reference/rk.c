/* The method "rk": a Riccati sweep for reflection, then the radiance sweep, as Max97.
 *
 * Upward, x = w - tau: below any level U = R D + e v, and light D at the level reaches the
 * last wanted depth beneath as a D + T D_nodes + e t, a = e^(-(x - x_start)/mu). With
 * K = 1/mu - C - B R on the nodes and H = s + B v:
 *     R' = -R/mu + B + C R - R K        v' = -(1/mu + q) v + C v + R H + r
 *     T' = a (C + B R) - T K            t' = -q t + a H + T H_nodes
 * in units of the beam e there, so that nothing underflows. Nothing in them grows, which
 * is what integrating D and U themselves cannot have (shooting.c). Downward: from one
 * wanted depth to the next D follows by T and t, and U by R and v.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/method.h"
#include "reference/ode.h"
#include "reference/plane.h"

/* More steps than this are refused: an explicit step is no longer than 3 mu of the
 * smallest mu, so that thick slabs take their time. */
enum { MOST_STEPS = 20000 };

/* The sweep at work: y is R, T (rows x n each), v, t (rows each). */
typedef struct {
    const pps_plane *plane;
    double start; /* x where T began */
    double *k;    /* n x n, scratch */
    double *bv;   /* rows, scratch: H */
} sweep;

static size_t state_size(const pps_plane *p) {
    return (size_t)(2 * p->carried * (p->n + 1));
}

/* out = x y, x rows x n, y n x n; or added to it times `factor`. */
static void add_product(int rows, int n, double factor, const double *x,
                        const double *y, double *out) {
    for (int i = 0; i < rows; i++) {
        for (int l = 0; l < n; l++) {
            double left = factor * x[i * n + l];
            for (int j = 0; j < n; j++) {
                out[i * n + j] += left * y[l * n + j];
            }
        }
    }
}

/* K on the nodes. */
static void decay_matrix(const pps_plane *p, const double *r, double *k) {
    int n = p->n;
    for (int i = 0; i < n * n; i++) {
        k[i] = (i % (n + 1) == 0 ? 1 / p->mu[i / n] : 0) - p->c[i];
    }
    add_product(n, n, -1, p->b, r, k);
}

static void slope_matrices(const sweep *s, double x, const double *y, double *slope) {
    const pps_plane *p = s->plane;
    int n = p->n, rows = p->carried, size = rows * n;
    const double *r = y, *t = y + size;
    double *dr = slope, *dt = slope + size;
    decay_matrix(p, r, s->k);
    memset(slope, 0, 2 * (size_t)size * sizeof *slope);
    add_product(rows, n, 1, p->b, r, dt); /* B R, for a moment */
    add_product(rows, n, 1, p->c, r, dr);
    for (int i = 0; i < rows; i++) {
        double a = exp(-(x - s->start) / p->mu[i]);
        for (int j = i * n; j < (i + 1) * n; j++) {
            dr[j] += p->b[j] - r[j] / p->mu[i];
            dt[j] = a * (p->c[j] + dt[j]);
        }
    }
    add_product(rows, n, -1, r, s->k, dr);
    add_product(rows, n, -1, t, s->k, dt);
}

static void slope_vectors(const sweep *s, double x, const double *y, double *slope) {
    const pps_plane *p = s->plane;
    int n = p->n, rows = p->carried, size = rows * n;
    const double *r = y, *t = y + size, *v = y + 2 * size, *u = v + rows;
    double *dv = slope + 2 * size, *du = dv + rows;
    for (int i = 0; i < rows; i++) {
        s->bv[i] = p->s[i];
        for (int j = 0; j < n; j++) {
            s->bv[i] += p->b[i * n + j] * v[j];
        }
    }
    for (int i = 0; i < rows; i++) {
        dv[i] = p->r[i] - (1 / p->mu[i] + p->q) * v[i];
        du[i] = exp(-(x - s->start) / p->mu[i]) * s->bv[i] - p->q * u[i];
        for (int j = 0; j < n; j++) {
            dv[i] += p->c[i * n + j] * v[j] + r[i * n + j] * s->bv[j];
            du[i] += t[i * n + j] * s->bv[j];
        }
    }
}

static void sweep_slope(const void *context, double x, const double *y, double *slope) {
    slope_matrices(context, x, y, slope);
    slope_vectors(context, x, y, slope);
}

/* From the bottom up: states[k] is R and v at depth k, T and t from it to depth k + 1. */
static pps_status upward(sweep *s, const pps_ode *ode, int n_tau, const double *tau,
                         double *states) {
    const pps_plane *p = s->plane;
    size_t size = state_size(p), matrix = (size_t)(p->carried * p->n);
    memset(states + (size_t)(n_tau - 1) * size, 0, size * sizeof *states);
    for (int k = n_tau - 2; k >= 0; k--) {
        double *y = states + (size_t)k * size;
        memcpy(y, y + size, size * sizeof *y);
        memset(y + matrix, 0, matrix * sizeof *y);
        memset(y + 2 * matrix + p->carried, 0, (size_t)p->carried * sizeof *y);
        s->start = p->w - tau[k + 1];
        pps_status status = pps_ode_run(ode, s->start, p->w - tau[k], y);
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

/* x . y over n. */
static double dot(int n, const double *x, const double *y) {
    double sum = 0;
    for (int j = 0; j < n; j++) {
        sum += x[j] * y[j];
    }
    return sum;
}

/* From the top down: nothing falls in. */
static void downward(const pps_plane *p, int n_tau, const double *tau,
                     const double *states, double *down, double *up) {
    int n = p->n, matrix = p->carried * n;
    for (int k = 0; k < n_tau; k++) {
        const double *r = states + (size_t)k * state_size(p), *t = r + matrix;
        const double *v = t + matrix, *u = v + p->carried;
        double *here = down + k * p->rows, e = exp(-p->q * tau[k]);
        for (int i = 0; i < p->carried; i++) {
            up[k * p->rows + i] = dot(n, r + i * n, here) + e * v[i];
        }
        for (int i = 0; k + 1 < n_tau && i < p->carried; i++) {
            double a = exp(-(tau[k + 1] - tau[k]) / p->mu[i]);
            here[p->rows + i] = a * here[i] + dot(n, t + i * n, here) + e * u[i];
        }
    }
}

static pps_status rk_order(const pps_plane *p, int n_tau, const double *tau,
                           double *down, double *up) {
    double steepest = p->q + 2 / p->mu[0];
    if (p->w * steepest > 5 * (double)MOST_STEPS) {
        return PPS_ERR_UNSUPPORTED;
    }
    size_t size = state_size(p), scratch = (size_t)(p->n * p->n + p->carried);
    double *memory = malloc(((size_t)n_tau * size + scratch) * sizeof *memory);
    if (!memory) {
        return PPS_ERR_MEMORY;
    }
    double *states = memory + scratch;
    sweep s = {.plane = p, .k = memory, .bv = memory + p->n * p->n};
    /* Errors of a step relative to a component, or to what a thin slab may have. */
    double relative = fmax(p->tolerance / 100, 1e-14);
    pps_ode ode = {.n = size,
                   .slope = sweep_slope,
                   .context = &s,
                   .relative = relative,
                   .absolute = 1e-3 * relative * p->albedo * fmin(1, p->w),
                   .first_step = 1 / steepest,
                   .most_steps = MOST_STEPS};
    pps_status status = upward(&s, &ode, n_tau, tau, states);
    if (!status) {
        downward(p, n_tau, tau, states, down, up);
    }
    free(memory);
    return status;
}

/* ---- the method ---- */

static pps_status rk_init(void *state, const pps_slab *slab, const pps_options *opts) {
    return pps_plane_init(state, slab, opts, false, rk_order);
}

static pps_status rk_solve(void *state, double thickness, double mu0) {
    pps_plane_model *model = state;
    model->slab.thickness = thickness;
    model->mu0 = mu0;
    return PPS_OK;
}

static pps_status rk_radiance(void *state, const pps_grid *at, double *radiance) {
    return pps_plane_radiance(state, at, radiance);
}

static pps_status rk_flux(void *state, size_t n, const double *tau, pps_flux *flux) {
    return pps_plane_flux(state, n, tau, flux);
}

static void rk_query(const void *state, pps_info *info) {
    const pps_plane_model *model = state;
    *info = (pps_info){.streams = model->streams,
                       .orders = model->orders,
                       .nodes = PPS_NODES_GAUSS,
                       .error_estimate = (double)NAN};
}

static const pps_method_ops ops = {.state_size = sizeof(pps_plane_model),
                                   .init = rk_init,
                                   .solve = rk_solve,
                                   .radiance = rk_radiance,
                                   .flux = rk_flux,
                                   .query = rk_query};

const pps_method pps_method_rk = {
    .name = "rk",
    .cost =
        "steps as thickness over the smallest node, each with products of matrices, "
        "an azimuthal order",
    .summary =
        "Riccati and radiance sweeps by Runge-Kutta of order 8, 16 streams unless "
        "told otherwise",
    .limits = "right to the tolerance on its own nodes, which are fixed; refuses where "
              "thickness over the smallest node, or over mu0, asks for too many steps",
    .fields = true,
    .fluxes = true,
    .half_space = false,
    .ops = &ops,
};
