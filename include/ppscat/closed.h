/* Closed forms in batches: one case, very many depths.
 *
 *     pps_hemispheric h;
 *     pps_hemispheric_init(&h, &slab, mu0);
 *     pps_hemispheric_fluence(&h, n, tau, fluence);
 *
 * The same numbers as the method "hemispheric" (method.h) to a few units in the last
 * place, by vector loops: a few nanoseconds a depth.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLOSED_H
#define PPSCAT_CLOSED_H

#include <ppscat/slab.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A solved case of "hemispheric": a plain value, no memory to free. */
typedef struct pps_hemispheric {
    int kind;                  /* which of the forms of core/mode.h */
    double thickness, k, q;    /* q = 1/mu0 */
    double beam, falls, grows; /* factors of e^(-q tau), e^(-k tau), e^(-k (w - tau)) */
    double resonance;          /* factor of (e^(-k tau) - e^(-q tau))/(q - k) */
    double top, bottom, sinh_over; /* hyperbolic form: edge values, 1/sinh(k w) */
    double series[26];             /* thin slabs: powers of tau/w */
} pps_hemispheric;

/* Solve a slab lit along mu0. ARGUMENT when an input is out of range. */
PPS_API pps_status pps_hemispheric_init(pps_hemispheric *h, const pps_slab *slab,
                                        double mu0);

/* Fluence (the integral of radiance over all directions, beam included, for a beam of unit
 * irradiance): fluence[i] at optical depth tau[i], 0 <= tau[i] <= thickness, which is not
 * checked. n may be 0; fluence may be tau. */
PPS_API void pps_hemispheric_fluence(const pps_hemispheric *h, size_t n,
                                     const double *tau, double *fluence);

#ifdef __cplusplus
}
#endif
#endif
