/* The slab's light field along the sun's ray, in three exponentials: the closed forms of
 * the tree application.
 *
 * Depth z is the optical depth along the light, so that its cosine is 1; leaves scatter
 * as much forward as back (T = R = 1/2). The scattered light is down(z) U+ + up(z) U-,
 * U+- uniform over the hemispheres about the light, and travels with the cosine 1/m:
 *
 *   sum = down + up,  net = down - up,
 *   sum' = -m net,    net' = -m (1 - albedo) sum + m albedo e^(-z),
 *   down(0) = 0, up(w) = 0.
 *
 * m = 1 is the simplified plane-parallel model (SPP Eqs. 11, 12, 19), kappa times it the
 * printed Eq. 20 (kappa = 1/T = 2); m = 2, the mean cosine 1/2 of a uniform hemisphere,
 * is the hemispheric closure. Reference: docs/theory.md section 9.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SLAB_LIGHT_H
#define PPS_TREE_SLAB_LIGHT_H

typedef enum {
    PPS_SLAB_DARK, /* direct light only */
    PPS_SLAB_SPP,
    PPS_SLAB_SPP_PRINTED,
    PPS_SLAB_HEMISPHERIC
} pps_slab_closure;

/* Of a closure: m, and what multiplies the scattered light (0: there is none). */
double pps_slab_m(pps_slab_closure closure);
double pps_slab_kappa(pps_slab_closure closure);

/* sum(z) = a e^(-lambda z) + b e^(-lambda (w - z)) + c e^(-z) */
typedef struct pps_slab_light {
    double m, lambda, w, a, b, c;
} pps_slab_light;

/* albedo 0..1, w >= 0. The albedo is kept 1e-12 away from 1 and lambda 1e-6 from its
 * resonance with the beam, where the three terms cancel; the field changes by less. */
void pps_slab_light_init(pps_slab_light *light, pps_slab_closure closure, double albedo,
                         double w);

/* For unit irradiance of the light: fluence of the scattered light, and its net flux
 * amplitude along the light. down = (sum + net)/2, up = (sum - net)/2. */
double pps_slab_light_sum(const pps_slab_light *light, double z);
double pps_slab_light_net(const pps_slab_light *light, double z);

#endif
