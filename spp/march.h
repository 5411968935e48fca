/* Ray marching in closed form (SPP A.1): the radiance of a source
 *
 *     J(tau, s) = albedo [ S+(mu) D(tau) + S-(mu) U(tau) + p(s, s0) e^(-q tau) ],
 *
 * with D and U known through their ray integrals. Refined SPP, Eddington and single
 * scattering are this with different D, U and S.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SPP_MARCH_H
#define PPS_SPP_MARCH_H

#include <stdbool.h>

#include <ppscat/slab.h>

#include "core/mode.h"

/* The diffuse part of the source, without the factor albedo, has two terms: what share of
 * them goes into direction mu, and what they are integrated along a ray (D and U above). */
typedef void (*pps_march_shares)(const void *solution, double mu, double share[2]);
typedef void (*pps_march_terms)(const void *solution, const pps_ray *ray,
                                double term[2]);

typedef struct pps_march {
    pps_slab slab;
    double mu0;
    pps_march_shares shares; /* NULL: single scattering only */
    pps_march_terms terms;
    const void *solution;
    bool sky; /* no beam in the source, but uncollided light of radiance 1 from above */
} pps_march;

void pps_march_radiance(const pps_march *march, const pps_grid *at, double *radiance);

/* Fluxes and mean intensity as hemispheric integrals of that radiance. */
void pps_march_flux(const pps_march *march, size_t n, const double *tau,
                    pps_flux *flux);

#endif
