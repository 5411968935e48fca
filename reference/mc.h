/* What the Monte Carlo does besides answering, for its tests.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_REFERENCE_MC_H
#define PPS_REFERENCE_MC_H

#include <ppscat/mc.h>

/* Where the power that falls on the slab went, per unit horizontal area: launched +
 * roulette = reflected + transmitted + absorbed, to rounding. */
typedef struct pps_mc_budget {
    double launched;
    double reflected;   /* escaped upward */
    double transmitted; /* escaped downward, or was absorbed by the ground */
    double absorbed;    /* in the slab */
    double roulette;    /* gained by survivors less lost by the others; 0 on average */
} pps_mc_budget;

pps_status pps_mc_energy(const pps_slab *slab, double mu0, const pps_mc_opts *opts,
                         pps_mc_budget *budget);

/* 1 - cos of a scattering angle, by the inverse of its distribution at u in (0, 1); exact
 * near both peaks of |g| -> 1. */
double pps_mc_versine(double g, double u);

/* Exponential integrals E2(x) and E3(x), x >= 0. */
void pps_mc_expint(double x, double *e2, double *e3);

#endif
