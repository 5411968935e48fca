/* The phase function in many directions at once: vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_PHASE_H
#define PPS_CORE_PHASE_H

#include <math.h>
#include <stddef.h>

/* (1 + g^2 - 2 g x)^(3/2), what Henyey-Greenstein's (1 - g^2)/(4 pi) is divided by at the
 * scattering cosine x, in the form that keeps its digits near the peaks:
 * (1 - |g|)^2 + 2 |g| (1 -+ x). */
static inline double pps_hg_over(double g, double x) {
    double size = fabs(g), side = g < 0 ? -1 : 1;
    double base = (1 - size) * (1 - size) + 2 * size * (1 - side * x);
    return base * sqrt(base);
}

/* mean[i] = pps_hg_azimuth_mean(g, mu[i], mu0), to 1e-14; n is a multiple of PPS_LANES
 * (core/vector.h). At -mu it is that of -g. */
void pps_hg_azimuth_means(double g, double mu0, size_t n, const double *mu,
                          double *mean);

/* p[i] = pps_hg(g, cos Theta) from mu0 to mu at n azimuths of these cosines. */
void pps_hg_azimuths(double g, double mu0, double mu, size_t n, const double *cosine,
                     double *p);

#endif
