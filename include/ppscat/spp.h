/* The simplified plane-parallel model (SPP): two amplitudes in closed form.
 *
 * The radiance is D(tau) U+ + U(tau) U-, where U+ and U- are 1/(2 pi) on the downward
 * and the upward hemisphere (SPP Eq. 10). The form used here is finite and right for
 * every albedo 0..1, thickness and half-space; docs/theory.md derives it from
 * SPP Eqs. 17-22 and lists the misprints mended.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_SPP_H
#define PPSCAT_SPP_H

#include <ppscat/slab.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The amplitude c2 of the type II solution is -kappa times the incident light. */
typedef enum {
    PPS_SPP_CONSISTENT, /* kappa = 1: satisfies SPP Eq. 11 */
    PPS_SPP_PRINTED     /* kappa = 1/T: as Eq. 20 is printed */
} pps_spp_kappa;

/* A solved case: a plain value, a dozen numbers, no memory to free. */
typedef struct pps_spp {
    double thickness, q;      /* q = 1/mu0 */
    double albedo, lambda;    /* lambda: Eq. 17 */
    double forward, backward; /* T, R: Eq. 10 at mu0 */
    double rho;               /* 1/alpha: Eq. 17 */
    double kappa, b, den;     /* B and Den of the stable form */
    double q_minus_lambda;    /* without cancellation as albedo -> 0 */
} pps_spp;

/* Solve a slab lit along mu0. ARGUMENT when an input is out of range; UNSUPPORTED when
 * kappa = 1/T is infinite (T = 0). */
PPS_API pps_status pps_spp_init(pps_spp *spp, const pps_slab *slab, double mu0,
                                pps_spp_kappa kappa);

/* D(tau), the coefficient of U+ without the beam, and U(tau), that of U-. */
PPS_API double pps_spp_down(const pps_spp *spp, double tau);
PPS_API double pps_spp_up(const pps_spp *spp, double tau);

#ifdef __cplusplus
}
#endif
#endif
