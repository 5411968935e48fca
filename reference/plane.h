/* The plane-parallel equation on nodes, one azimuthal order at a time, and what is made of
 * its solutions: shared by the Runge-Kutta references.
 *
 * With D_i = I(+mu_i), U_i = I(-mu_i), and e = e^(-q tau), q = 1/mu0:
 *     D' = -D/mu + C D + B U + s e,    U' = U/mu - B D - C U - r e,
 * C, B, s, r divided by mu already. Sums run over the n nodes; further rows are
 * directions of weight 0, wanted ones that are no nodes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_REFERENCE_PLANE_H
#define PPS_REFERENCE_PLANE_H

#include <stdbool.h>

#include <ppscat/method.h>

/* One azimuthal order. Matrices are rows x n: c[i * n + j]. */
typedef struct pps_plane {
    int n;       /* nodes of a hemisphere */
    int rows;    /* nodes, then other |mu| */
    int carried; /* rows to be integrated; the rest, which have a smaller |mu| than any
                     node by far, follow from these */
    double *mu;  /* rows */
    double *c, *b;
    double *s, *r;
    double w, q; /* thickness, 1/mu0 */
    double albedo, tolerance;
} pps_plane;

/* Solve one order: D and U at n_tau ascending depths, the first 0 and the last w, of
 * carried rows: down[k * rows + i]. */
typedef pps_status (*pps_plane_solver)(const pps_plane *plane, int n_tau,
                                       const double *tau, double *down, double *up);

/* A slab to be solved so: the state of a method. */
typedef struct pps_plane_model {
    pps_slab slab;
    double mu0;
    int streams;
    double tolerance;
    bool plain;     /* delta-M off: no exact single scattering */
    bool carry_all; /* integrate every direction */
    int orders;     /* used last */
    pps_plane_solver solver;
} pps_plane_model;

/* State from options; UNSUPPORTED, INDEFINITE. */
pps_status pps_plane_init(pps_plane_model *model, const pps_slab *slab,
                          const pps_options *opts, bool carry_all,
                          pps_plane_solver solver);
pps_status pps_plane_radiance(pps_plane_model *model, const pps_grid *at,
                              double *radiance);
pps_status pps_plane_flux(pps_plane_model *model, size_t n, const double *tau,
                          pps_flux *flux);

/* Solve A x = y in place for n_rhs right-hand sides (y[i * n_rhs + k]) by elimination with
 * row interchanges; destroys a[i * n + j]. False where A is singular. */
bool pps_plane_eliminate(int n, double *a, int n_rhs, double *y);

#endif
