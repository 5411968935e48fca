/* Normalised associated Legendre functions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_LEGENDRE_H
#define PPS_CORE_LEGENDRE_H

#include <stddef.h>

/* p[l - m] = sqrt((l-m)!/(l+m)!) P_l^m(mu) for m <= l < n_moments, without the
 * Condon-Shortley sign. mu in [-1, 1], 0 <= m < n_moments. */
void pps_legendre(int m, int n_moments, double mu, double *p);

/* The same for many mu, n of them: p[(l - m) * stride + i] at mu[i], stride >= n. */
void pps_legendre_array(int m, int n_moments, size_t n, const double *mu, size_t stride,
                        double *p);

/* sum over l < n_moments of coefficient[l] P_l(x) P_l(y). */
double pps_legendre_product(int n_moments, const double *coefficient, double x,
                            double y);

#endif
