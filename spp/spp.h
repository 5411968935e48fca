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
} spp_state;

/* Which of the two forms of D holds its digits at tau (see spp.c). */
bool pps_spp_near_top(const pps_spp *spp, double tau);

pps_flux pps_spp_flux_at(const pps_spp *spp, double tau);

#endif
