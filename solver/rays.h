/* Integrals of modes along many rays at once: vector loops over directions.
 *
 * The exact scalar form is core/mode.h's pps_mode_ray; this is the same algebra with what
 * depends on the mode, the depth and the direction alone taken out of the inner loop:
 *
 *   along a ray that runs t from the edge where it enters, c = 1/|mu|,
 *   same       c E1(t; k, c), of what decays away from that edge
 *   opposite   c e' E1(t; 0, k + c), of what decays away from the other, e' its value here
 *
 * each with its factor of the source, so that a ray sum is two rows of products. Rows run
 * over the directions, padded to blocks (core/vector.h).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_RAYS_H
#define PPS_SOLVER_RAYS_H

#include <stdbool.h>
#include <stddef.h>

/* A depth seen by rays of one sense: t to the edge where they enter, and a row each of
 * c, e^(-c t), e^(-c t/2). */
typedef struct pps_run {
    size_t n; /* directions, padded */
    bool down;
    double t;
    const double *c, *ect, *root;
} pps_run;

/* What stands for an infinite distance: its exponentials are 0, its square is finite. */
#define PPS_FAR 1e100

/* What a mode's source is in each direction: rows c (ge + s k go), the same over (c - k),
 * c (ge - s k go), the same over (c + k); go with the sign s of the direction, and
 * signed_k = s k, as phi = -psi' has that of depth. */
typedef struct pps_mode_view {
    const double *near, *near_over, *far, *far_over;
} pps_mode_view;
void pps_mode_view_fill(size_t n, double signed_k, const double *c, const double *ge,
                        const double *go, double *near, double *near_over, double *far,
                        double *far_over);

/* All depths seen by rays of one sense: rows of e^(-c t) and its root `row` apart. */
typedef struct pps_runs {
    size_t n, n_tau, row;
    const double *t, *c, *ect, *root;
} pps_runs;

/* A mode at all depths, `step` apart: e^(-k t), its root, and e' = e^(-k rest). */
typedef struct pps_mode_here {
    double k;
    size_t step;
    const double *e, *root, *other;
} pps_mode_here;

/* The two integrals, rows `apart` apart. */
void pps_mode_rays(const pps_runs *runs, const pps_mode_here *mode,
                   const pps_mode_view *view, size_t apart, double *same,
                   double *opposite);

/* The same two integrals by themselves (without the source): of the beam, k = q. */
void pps_beam_rays(const pps_run *run, double q, double e, double root, double other,
                   double *integral);

/* sum[i] += over j of x[j * n + i] a[j * step] + y[j * n + i] b[j * step]. */
void pps_rays_sum(size_t n, size_t n_modes, const double *x, const double *y,
                  const double *a, const double *b, size_t step, double *sum);

/* sum[i] += x[i] y[i]. */
void pps_rays_add_product(size_t n, const double *x, const double *y, double *sum);

/* A resonant mode at a depth: psi = p Theta, Theta = E1(tau; k, q); theta_on = E1(x; k, q)
 * from there on to the bottom, x = w - tau; ekx = e^(-k x), its root; eqt = e^(-q tau). */
typedef struct pps_resonance {
    double k, q, p, theta, theta_on, ekx, root, eqt;
} pps_resonance;

/* sum[i] += (ge + k go) p times the ray integral of Theta; beam: that of e^(-q tau), from
 * pps_beam_rays. */
void pps_theta_rays(const pps_run *run, const pps_resonance *mode, const double *ge,
                    const double *go, const double *beam, double *sum);

/* source[d * stride + i] += ge[i] a[d * PPS_LANES] + go[i] b[d * PPS_LANES] for every term
 * d of a series. */
void pps_series_source(size_t n, size_t stride, const double *ge, const double *go,
                       const double *a, const double *b, double *source);

/* sum[i] += over terms d of moment[d * n + i] source[d * stride + i]. */
void pps_series_rays(size_t n, size_t stride, const double *moment,
                     const double *source, double *sum);

/* value[p * n + i] += cosine[p] term[i], p < n_phi; true where no term exceeds its
 * tolerance, relative to the new value. */
bool pps_add_order(size_t n, size_t n_phi, const double *cosine, const double *term,
                   double tolerance, double *value);

#endif
