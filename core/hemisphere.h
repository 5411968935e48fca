/* Integrals over a hemisphere of radiances that are known in closed form.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_HEMISPHERE_H
#define PPS_CORE_HEMISPHERE_H

#include <stddef.h>

enum { PPS_PANEL = 16 }; /* points of a Gauss panel */

/* Azimuthally averaged radiances at the n = PPS_PANEL directions |mu| in (0, 1). */
typedef void (*pps_radiances_of_mu)(const void *context, size_t n, const double *mu,
                                    double *radiance);

typedef struct pps_hemisphere {
    double flux; /* 2 pi int_0^1 mu I dmu */
    double mean; /* half of int_0^1 I dmu: its share of the mean intensity */
} pps_hemisphere;

/* run: optical depth to the edge where the radiance starts from 0 (may be infinite);
 * mu0, g: where the phase function peaks and how sharply. Relative accuracy 1e-12: Gauss
 * panels that shrink towards mu = 0 (to run / 40) and towards mu0. */
pps_hemisphere pps_hemisphere_integral(pps_radiances_of_mu radiances,
                                       const void *context, double run, double mu0,
                                       double g);

/* Single scattering of a beam along mu0 in a slab of thickness w, per unit albedo, with
 * the exact phase function: downward or upward hemisphere at depth tau. */
pps_hemisphere pps_single_hemisphere(double g, double mu0, double w, double tau,
                                     int down);

/* The share of isotropic light from one side that one scattering sends back: the mean of
 * pps_hg_backward over mu in (0, 1). */
double pps_hg_backward_diffuse(double g);

#endif
