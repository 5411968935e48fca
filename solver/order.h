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
    double *root_weight;      /* sqrt(w_i) */
    double *strength;         /* (2l+1) chi_l, n_moments of them */
    double *bias;             /* sum_i w_i P_l(mu_i) of even l >= 2, else 0 */
    bool squared;             /* the nodes allow the faster eigenproblem */
} pps_discrete;

/* The functions the discrete problem scatters with: P_l^m (legendre.h), and for m = 0 the
 * even P_l less their quadrature sum, which on mapped nodes is not 0 by itself. So every
 * scattering, the first one included, conserves energy on the nodes exactly. At n cosines:
 * p[(l - m) * n + i]. */
void pps_discrete_legendre(const pps_discrete *discrete, int m, size_t n,
                           const double *mu, double *p);

/* Source of the discrete problem for single scattering from mu0 to mu, m = 0:
 * albedo / 4pi sum of strength_l P_l(mu) P_l(mu0). */
double pps_discrete_single(const pps_discrete *discrete, double mu, double mu0);

/* The beams that the slab is solved for. One column a beam in whatever depends on it:
 * rows of `padded` numbers, the last ones of no meaning but finite. */
typedef struct pps_beams {
    size_t n, padded;
    bool sky; /* isotropic light instead; n = 1 and q = 1 then */
    double *mu0;
    double *q;     /* 1/mu0 */
    double *decay; /* e^(-q w) */
} pps_beams;

/* A mode of one beam that is evaluated by itself (core/mode.h): near resonance, where the
 * particular solution is not an exponential; or with a small k in a thick slab. */
typedef struct pps_special {
    int j;
    size_t beam;
    pps_mode mode;
} pps_special;

/* The solution: per mode j and beam b, at [j * padded + b], the sum of
 *   p, r      psi = p e^(-q tau), phi = r e^(-q tau), the particular part
 *   c1, c2    the factors of e^(-k tau), e^(-k (w - tau)), for modes k w >= 1
 *   series    for modes k w < 1: what remains, entire in tau, from its values at the edges
 *             (series.h), in slabs that are not thick
 * and of the special modes, for which the above is 0. */
typedef struct pps_solution {
    double *p, *r, *c1, *c2;
    double *edge_psi[2], *edge_phi[2]; /* of the series, at the top and the bottom */
    double *source_a, *source_b;       /* of the series: alpha, beta or 0 */
    size_t n_special;
    pps_special *special;
} pps_solution;

typedef struct pps_order {
    int m, n, n_even, n_odd;
    double *k;      /* n eigenvalues, ascending */
    double *gram;   /* G = X^T X, n x n */
    double *v, *w;  /* moments of the modes, as above */
    double *flux_s; /* sum_i sqrt(w_i mu_i) X_ij: what psi_j adds to the fluxes */
    /* Of the present thickness: */
    double *even, *odd;       /* Cholesky factors of Ae and Ao, reciprocal diagonals */
    double *tanh, *coth;      /* k tanh k h, k coth k h */
    double *csch;             /* 2 k / sinh k w */
    double *decay, *sum_over; /* e^(-k w), 1/(1 - e^(-2 k w)) */
    int n_small;              /* modes with k w < 1: the first ones */
    int n_series;             /* those of them that are series: all or none */
    /* Of the present beams: */
    double *alpha, *beta;
    pps_solution solution;
    size_t capacity;     /* padded beams that there is memory for */
    double *memory;      /* what does not depend on beams lies in this block */
    double *beam_memory; /* and what does in this one */
} pps_order;

/* modes.c: allocate and solve the eigenproblem of order m. */
pps_status pps_order_create(pps_order *order, const pps_discrete *discrete, int m);
void pps_order_free(pps_order *order);

/* ge_j(mu) and go_j(mu): the source of direction mu is ge.psi + go.phi for mu > 0 and
 * ge.psi - go.phi for mu < 0. At n cosines mu > 0, a row of `padded` numbers a mode (mu
 * too has `padded` of them). legendre: scratch, n_moments rows of `padded`. */
void pps_order_project(const pps_order *order, const pps_discrete *discrete,
                       size_t padded, const double *mu, double *ge, double *go,
                       double *legendre);

/* boundary.c: factor for an optical thickness (scaled). */
pps_status pps_order_set_thickness(pps_order *order, double thickness);

/* Doubles of scratch that solving for so many beams takes. */
size_t pps_order_scratch(const pps_discrete *discrete, size_t padded);

/* Memory for so many beams (padded). */
pps_status pps_order_reserve(pps_order *order, size_t padded);

/* alpha and beta of the beams, which no thickness changes; then the solution. */
void pps_order_light(pps_order *order, const pps_discrete *discrete,
                     const pps_beams *beams, double *scratch);
void pps_order_solve(pps_order *order, double thickness, const pps_beams *beams,
                     double *scratch);

/* Mode j of beam b as core/mode.h has it. */
pps_mode pps_order_mode(const pps_order *order, int j, double thickness,
                        const pps_beams *beams, size_t b);

#endif
