/* Discrete ordinates: the full plane-parallel model (SPP Eq. 7) on one set of nodes.
 *
 * Expensive once: an eigenproblem for each azimuthal order, order 0 in `create`, the
 * others when a beam with mu0 < 1 first needs them (give .orders = 1 for fluxes alone).
 * Cheap often: a new thickness costs two Cholesky factorisations an order, a new beam
 * a few triangular solves, an output point a sum over modes.
 *
 *     pps_dom *dom;
 *     pps_dom_create(&slab, &(pps_dom_opts){.streams = 32}, &dom);
 *     pps_dom_solve(dom, mu0);
 *     pps_dom_radiance(dom, &grid, radiance);
 *     pps_dom_free(dom);
 *
 * A sweep: directions once, then for each thickness all beams at once; what they share
 * is done once for all of them.
 *
 *     pps_dom_set_directions(dom, grid.n_mu, grid.mu);
 *     for (each thickness) {
 *         pps_dom_set_thickness(dom, thickness);
 *         pps_dom_solve_beams(dom, n, mu0);
 *         pps_dom_flux(dom, n_tau, tau, flux);        flux[b * n_tau + k]
 *         pps_dom_radiance(dom, &grid, radiance);
 *     }
 *
 * For an answer good to a tolerance rather than to a number of streams, use the
 * method "exact" (method.h), which chooses streams, nodes and orders itself.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_DOM_H
#define PPSCAT_DOM_H

#include <ppscat/slab.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Quadrature of a hemisphere, n = streams / 2 nodes. */
typedef enum {
    PPS_NODES_AUTO,   /* graded below thickness 0.01; mapped below 0.1, and where they
                         carry moments enough for g; else Gauss (docs/theory.md, 6) */
    PPS_NODES_GAUSS,  /* Gauss-Legendre on (0, 1): "double Gauss" */
    PPS_NODES_MAPPED, /* mu = x^2 with Gauss-Legendre x: dense at grazing angles */
    PPS_NODES_GRADED  /* mu = x^4: for slabs so thin that mu ~ thickness matters */
} pps_nodes;

/* Scaling of the forward peak (delta-M, Wiscombe 1977). */
typedef enum {
    PPS_DELTA_M_AUTO, /* on for g > 0 */
    PPS_DELTA_M_ON,   /* refused for g < 0: there is no forward peak to remove */
    PPS_DELTA_M_OFF   /* the plain discrete problem: moments g^l for l < streams, Gauss
                         nodes, no single-scattering correction */
} pps_delta_m;

enum { PPS_STREAMS_MAX = 1024 };

/* Zero means default throughout. */
typedef struct pps_dom_opts {
    int streams; /* 2n, even, 2..PPS_STREAMS_MAX; 0 = 32 */
    pps_nodes nodes;
    pps_delta_m delta_m;
    int orders;       /* azimuthal orders (more than the moments are those); 0 = enough
                   for `tolerance`; 1 = fluxes only */
    double tolerance; /* of the azimuth series, relative; 0 = 1e-15 */
} pps_dom_opts;

/* What was used; the residuals a user may want to see. */
typedef struct pps_dom_info {
    int streams, orders, moments; /* moments of the phase function kept, l < moments */
    pps_nodes nodes;              /* never AUTO */
    double delta_fraction;        /* f of delta-M; 0 when not scaled */
    double diffusion_exponent;    /* smallest eigenvalue k of m = 0 */
} pps_dom_info;

typedef struct pps_dom pps_dom;

/* Build the solver of a slab.
 *   slab    copied; opts may be NULL
 *   out     the handle, NULL on failure; free with pps_dom_free
 * Status: ARGUMENT, MEMORY, CONVERGENCE; INDEFINITE where the truncated phase function
 * has no positive definite form on the nodes; UNSUPPORTED for delta-M with g < 0.
 * Reference: docs/theory.md; SPP Eq. 7. */
PPS_API pps_status pps_dom_create(const pps_slab *slab, const pps_dom_opts *opts,
                                  pps_dom **out);

/* Change the thickness; keeps the eigenproblems. Call pps_dom_solve next. */
PPS_API pps_status pps_dom_set_thickness(pps_dom *dom, double thickness);

/* Solve for a beam of unit irradiance normal to itself, coming along mu0 in (0, 1].
 * Status: ARGUMENT; MEMORY, CONVERGENCE, INDEFINITE as create, of the orders it prepares. */
PPS_API pps_status pps_dom_solve(pps_dom *dom, double mu0);

/* Solve for n beams at once, one after the other in every output: the same numbers to the
 * last bit as beam by beam, in a fraction of the time. mu0[n], n >= 1; copied. */
PPS_API pps_status pps_dom_solve_beams(pps_dom *dom, size_t n, const double *mu0);

/* Solve for an isotropic radiance of 1 falling on the lit side instead of a beam. The
 * outputs are then all of its light, what comes through uncollided included. */
PPS_API pps_status pps_dom_solve_sky(pps_dom *dom);

/* Optional: keep what the directions mu[n_mu] and the medium alone decide. From the next
 * solve on, radiances at exactly these directions take less time; the numbers are the
 * same. Replaces those kept before; n_mu = 0 forgets them. ARGUMENT, MEMORY. */
PPS_API pps_status pps_dom_set_directions(pps_dom *dom, size_t n_mu, const double *mu);

/* Diffuse radiance, 1/sr: radiance[((b * n_tau + k) * n_mu + j) * n_phi + i] of beam b at
 * depth k, cosine j, azimuth i. mu need not be a node. Allocates its scratch. */
PPS_API pps_status pps_dom_radiance(const pps_dom *dom, const pps_grid *at,
                                    double *radiance);

/* Fluxes and mean intensities at n depths: flux[b * n + k] of beam b at depth k. */
PPS_API pps_status pps_dom_flux(const pps_dom *dom, size_t n, const double *tau,
                                pps_flux *flux);

/* The nodes (ascending) and weights of a hemisphere, streams / 2 of each. */
PPS_API pps_status pps_dom_nodes(const pps_dom *dom, double *mu, double *weight);

/* The eigenvalues k_j of order m, ascending, streams / 2 of them, in the scaled optical
 * depth (see delta_fraction). ARGUMENT for an order that was not asked for. */
PPS_API pps_status pps_dom_eigenvalues(const pps_dom *dom, int m, double *k);

PPS_API void pps_dom_query(const pps_dom *dom, pps_dom_info *info);

/* NULL is fine. */
PPS_API void pps_dom_free(pps_dom *dom);

#ifdef __cplusplus
}
#endif
#endif
