/* SPP as the methods of this folder share it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SPP_SPP_H
#define PPS_SPP_SPP_H

#include <stdbool.h>

#include <ppscat/spp.h>

typedef struct {
    pps_slab slab;
    pps_spp spp;
    bool sky; /* lit by isotropic radiance 1 from above instead of the beam */
} spp_state;

/* Light by the sky: i0 is uniform over the hemisphere, so the cosine that the model wants
 * for it is its mean, 1/2, and T, R are means too. D, the beam part included, and U of such
 * light, of amplitude 1, are 2 pi times smaller than the sky's. */
pps_status pps_spp_init_sky(spp_state *state, double thickness, pps_spp_kappa kappa);

/* Which of the two forms of D holds its digits at tau (see spp.c). */
bool pps_spp_near_top(const pps_spp *spp, double tau);

#endif
