/* A two-stream model: two fluxes along tau, solved as one mode.
 *
 *     S' = -f D + b e^(-q tau),   D' = -e S + a e^(-q tau),   S = F+ + F-, D = F+ - F-,
 *
 * F+ downward; nothing diffuse falls in. With gamma1, gamma2, gamma3 of Meador & Weaver
 * (1980): e = gamma1 - gamma2, f = gamma1 + gamma2, a = albedo,
 * b = albedo (1 - 2 gamma3). No overflow, no resonance, albedo 0 to 1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SPP_TWOSTREAM_H
#define PPS_SPP_TWOSTREAM_H

#include <stdbool.h>

#include <ppscat/slab.h>

#include "core/mode.h"

typedef struct pps_twostream {
    pps_mode mode; /* psi = S, phi = f D */
    double f;
    bool sky; /* lit by isotropic radiance 1 from above instead of the beam */
} pps_twostream;

/* e >= 0, f > 0. */
void pps_twostream_solve(pps_twostream *two, double thickness, double mu0, double e,
                         double f, double a, double b);

/* The equations of the method "hemispheric" (hemispheric.c). */
void pps_hemispheric_solve(pps_twostream *two, const pps_slab *slab, double mu0);

/* Lit by an isotropic radiance of 1 from above instead: F+(0) = pi. */
void pps_twostream_solve_sky(pps_twostream *two, double thickness, double e, double f);

/* F- , F+ and mean intensity (F+ + F-)/(2 pi), with the beam's share. */
pps_flux pps_twostream_flux(const pps_twostream *two, double tau);

/* Ray integrals of F+ + F- and F+ - F-. */
void pps_twostream_ray(const pps_twostream *two, const pps_ray *ray, double *sum,
                       double *difference);

#endif
