/* Divided differences of exponentials: every integral along a ray is one.
 *
 * With f(x) = exp(-x t), the divided difference over n + 1 rates, times (-1)^n:
 *   E1(t; a, b)       = (e^(-a t) - e^(-b t)) / (b - a) = convolution of e^(-a .) and
 *                       e^(-b .) over (0, t)
 *   E2(t; a, b, c)    = convolution of E1(.; a, b) with e^(-c .)
 *   E3(t; a, b, c, d) = convolution of E2(.; a, b, c) with e^(-d .)
 * They are symmetric in the rates, positive, and smooth where rates coincide; rates may
 * be negative. t >= 0, and may be infinite when no rate is negative. The function E of
 * SPP Eq. A.1 is E1 in another dress.
 * Accuracy: a few units in the last place, times 1 + |min rate| t for the exponential.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_EXPDIFF_H
#define PPSCAT_EXPDIFF_H

#include <ppscat/export.h>

#ifdef __cplusplus
extern "C" {
#endif

PPS_API double pps_exp1(double t, double a, double b);
PPS_API double pps_exp2(double t, double a, double b, double c);
PPS_API double pps_exp3(double t, double a, double b, double c, double d);

/* E1(t; k, c) where ekt = e^(-k t) and ect = e^(-c t) are at hand already. */
PPS_API double pps_exp1_known(double t, double k, double c, double ekt, double ect);

#ifdef __cplusplus
}
#endif
#endif
