/* Four streams in closed form: two nodes a hemisphere, azimuthal orders 0 to 2.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SPP_FOURSTREAM_H
#define PPS_SPP_FOURSTREAM_H

#include <stdbool.h>

#include <ppscat/slab.h>

#include "core/mode.h"

enum {
    PPS_FOURSTREAM_MOMENTS = 4,
    PPS_FOURSTREAM_ORDERS = 3,
    PPS_FOURSTREAM_PEAKS = 24,      /* scatterings within the peak, at most */
    PPS_FOURSTREAM_PEAK_POINTS = 8, /* of the quadrature along short paths */
};

/* Nodes and weights of a hemisphere, ascending. Their sums of 1, mu and mu^2 must be
 * the integrals, 1, 1/2 and 1/3. */
typedef struct pps_fourstream_nodes {
    double mu[2], weight[2];
} pps_fourstream_nodes;

extern const pps_fourstream_nodes pps_fourstream_default;

/* One azimuthal order (docs/theory.md section 3). */
typedef struct pps_fourstream_order {
    double k[2]; /* eigenvalues, ascending */
    /* p_l^T M X for l + m even, p_l^T M Z for l + m odd: [l][mode], l >= m */
    double moment[PPS_FOURSTREAM_MOMENTS][2];
    double gram[3]; /* G = X^T X: 00, 10, 11 */
    double sky[2];  /* sum_i sqrt(w_i mu_i) X_ij */
    pps_mode mode[2];
} pps_fourstream_order;

/* Scattered n times within the peak: HG of g^n plus a polynomial. */
typedef struct pps_fourstream_peak {
    double g, polynomial[PPS_FOURSTREAM_MOMENTS];
} pps_fourstream_peak;

/* A solved case: a plain value. */
typedef struct pps_fourstream {
    pps_slab slab;
    pps_fourstream_nodes nodes;
    double mu0;
    bool sky;
    double f, stretch, tail_stretch; /* delta-M: fraction, 1 - albedo f, albedo f */
    double albedo, co_albedo;        /* scaled, and 1 - that */
    double strength[PPS_FOURSTREAM_MOMENTS]; /* (2l+1) chi_l, scaled */
    int n_orders, n_peaks;
    pps_fourstream_order order[PPS_FOURSTREAM_ORDERS];
    pps_fourstream_peak peak[PPS_FOURSTREAM_PEAKS + 1]; /* from 1 on */
    double point[PPS_FOURSTREAM_PEAK_POINTS], point_weight[PPS_FOURSTREAM_PEAK_POINTS];
} pps_fourstream;

/* The eigen solution of (albedo, g). INDEFINITE where four moments of the phase
 * function have no positive definite form on the nodes (g < -0.99). */
pps_status pps_fourstream_init(pps_fourstream *four, const pps_slab *slab,
                               const pps_fourstream_nodes *nodes);

/* Light it by a beam along mu0, or by an isotropic radiance of 1 from above. */
void pps_fourstream_solve(pps_fourstream *four, double thickness, double mu0);
void pps_fourstream_solve_sky(pps_fourstream *four, double thickness);

/* Multiple scattering at a depth, in a direction: the sum of term[m] cos(m phi). */
void pps_fourstream_multiple(const pps_fourstream *four, double tau, double mu,
                             double term[PPS_FOURSTREAM_ORDERS]);

void pps_fourstream_radiance(const pps_fourstream *four, const pps_grid *at,
                             double *radiance);
pps_flux pps_fourstream_flux(const pps_fourstream *four, double tau);

#endif
