/* The G-factor, Eqs. 23-28, with A.3 derived anew.
 *
 * The light that single scattering brings to P along a direction, from the piece of path
 * between the crown's surface (h away) and the slab's face (L away), over that of the
 * whole path:
 *
 *   G_s = (e^(-k h) - e^(-k L)) / (1 - e^(-k L)),
 *   mu > 0, with the light:  L = d/mu,        k = 1 - mu
 *   mu < 0, against it:      L = (w - d)/|mu|, k = 1 + |mu|
 *
 * and G = 1 - mean of G_s. The print (A.3) lacks a fraction bar and swaps the arguments
 * of its E, which turns the sign of K = 1/mu - 1 in
 *   G_s = (1 - e^(-K y)) / (1 - e^(-K d)),  y = d - h mu the depth of the surface;
 * it is finite in the upper half sphere only. Its ends are right, its shape is not
 * (tests/tree/test_gfactor.c). Reference: docs/theory.md section 9.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/gfactor.h"

#include <math.h>

static const double HORIZONTAL = 1e-3; /* such directions never reach a face */

static double clamp01(double x) { return x > 0 ? x < 1 ? x : 1 : 0; }

/* (e^(-k h) - e^(-k L)) / (1 - e^(-k L)), right down to k = 0. */
static double share_outside(double k, double h, double length) {
    if (!(length > 0 && length > h)) {
        return 0;
    }
    double kl = k * length;
    if (kl < 1e-8) {
        return (length - h) / length;
    }
    return clamp01(exp(-k * h) * expm1(-k * (length - h)) / expm1(-kl));
}

static double derived(double d, double w, double mu, double h) {
    return mu > 0 ? share_outside(1 - mu, h, d / mu)
                  : share_outside(1 - mu, h, (w - d) / -mu);
}

static double printed(double d, double mu, double h) {
    double k = 1 / mu - 1, y = fmax(d - h * mu, 0);
    if (!(d > 0)) {
        return 0;
    }
    return k * d < 1e-8 ? y / d : clamp01(expm1(-k * y) / expm1(-k * d));
}

double pps_g_factor(pps_compensation form, double d, double w, int n, const double *mu,
                    const double *h) {
    if (form == PPS_COMPENSATE_NONE) {
        return 1;
    }
    double sum = 0;
    int count = 0;
    for (int j = 0; j < n; j++) {
        bool skip = form == PPS_COMPENSATE_PRINTED ? mu[j] < HORIZONTAL
                                                   : fabs(mu[j]) < HORIZONTAL;
        if (!skip) {
            sum += form == PPS_COMPENSATE_PRINTED ? printed(d, mu[j], h[j])
                                                  : derived(d, w, mu[j], h[j]);
            count++;
        }
    }
    return count > 0 ? 1 - sum / count : 1;
}
