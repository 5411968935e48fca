/* One azimuthal order of the discrete problem: eigen solution, boundary, beam.
 *
 *   n        nodes a hemisphere          p_l     sqrt(w_i) P_l(mu_i)
 *   V, W     p_l^T M X (l + m even), p_l^T M Z (l + m odd); V[r + j * n_even], l = m + 2r,
 *            W[r + j * n_odd], l = m + 1 + 2r
 *   M        diag(mu^-1/2)
 *
 * Derivation: docs/theory.md section 4.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_ORDER_H
#define PPS_SOLVER_ORDER_H

#include <stdbool.h>

#include <ppscat/dom.h>

#include "core/mode.h"

/* The discretisation shared by all orders; albedo and moments after delta-M. */
typedef struct pps_discrete {
    int n, n_moments;
    double albedo, co_albedo; /* co_albedo = 1 - albedo, exact where albedo is near 1 */
    double *mu, *weight;      /* n each */
    double *strength;         /* (2l+1) chi_l, n_moments of them */
    double *bias;             /* sum_i w_i P_l(mu_i) of even l >= 2, else 0 */
    bool squared;             /* the nodes allow the faster eigenproblem */
} pps_discrete;

/* The functions the discrete problem scatters with: P_l^m (legendre.h), and for m = 0 the
 * even P_l less their quadrature sum, which on mapped nodes is not 0 by itself. So every
 * scattering, the first one included, conserves energy on the nodes exactly. */
void pps_discrete_legendre(const pps_discrete *discrete, int m, double mu, double *p);

/* Source of the discrete problem for single scattering from mu0 to mu, m = 0:
 * albedo / 4pi sum of strength_l P_l(mu) P_l(mu0). */
double pps_discrete_single(const pps_discrete *discrete, double mu, double mu0);

typedef struct pps_order {
    int m, n, n_even, n_odd;
    double *k;          /* n eigenvalues */
    double *gram;       /* G = X^T X, n x n */
    double *v, *w;      /* moments of the modes, as above */
    double *flux_s;     /* sum_i sqrt(w_i mu_i) X_ij: what psi_j adds to the fluxes */
    double *even, *odd; /* Cholesky factors of Ae and Ao, of the present thickness */
    pps_mode *mode;     /* n modes of the present beam */
    double *memory;     /* one block that all of the above lie in */
} pps_order;

/* modes.c: allocate and solve the eigenproblem of order m. */
pps_status pps_order_create(pps_order *order, const pps_discrete *discrete, int m);
void pps_order_free(pps_order *order);

/* ge_j(mu) and go_j(mu): the source of direction mu is ge.psi + go.phi for mu > 0 and
 * ge.psi - go.phi for mu < 0, both taken at |mu|. legendre: scratch, n_moments. */
void pps_order_project(const pps_order *order, const pps_discrete *discrete, double mu,
                       double *ge, double *go, double *legendre);

/* boundary.c: factor for an optical thickness (scaled); solve for a beam.
 * scratch: pps_order_scratch(n) doubles. */
pps_status pps_order_set_thickness(pps_order *order, double thickness);
size_t pps_order_scratch(const pps_discrete *discrete);
void pps_order_solve(pps_order *order, const pps_discrete *discrete, double thickness,
                     double mu0, double *scratch);

/* The same for an isotropic radiance of 1 from above instead of the beam; order 0 only,
 * as the others stay dark. The modes then carry the uncollided light too. */
void pps_order_solve_sky(pps_order *order, double thickness, double *scratch);

#endif
