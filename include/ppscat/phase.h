/* The Henyey-Greenstein phase function, normalised so that its integral over the
 * sphere is 1 (SPP Eq. 2), and its integrals over hemispheres.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_PHASE_H
#define PPSCAT_PHASE_H

#include <ppscat/export.h>

#ifdef __cplusplus
extern "C" {
#endif

/* p(cos_theta) in 1/sr, -1 < g < 1. Its Legendre moments are chi_l = g^l. */
PPS_API double pps_hg(double g, double cos_theta);

/* Azimuthal mean of p over the directions (mu, phi) for light going along mu0:
 * (1/2pi) integral p dphi, in 1/sr. mu, mu0 in [-1, 1]. */
PPS_API double pps_hg_azimuth_mean(double g, double mu, double mu0);

/* The share of light arriving along mu0 that is scattered into the hemisphere
 * opposite to the one it travels towards: R of SPP Eq. 10; T = 1 - R.
 * mu0 in [0, 1]. Closed form in complete elliptic integrals; relative accuracy 1e-13
 * for |g| <= 0.99. */
PPS_API double pps_hg_backward(double g, double mu0);

/* cos of an angle in degrees, exact at the multiples of 30 degrees where it is rational. */
PPS_API double pps_cos_degrees(double angle);

/* cos of the scattering angle between (mu0, phi = 0) and (mu, phi in degrees). */
PPS_API double pps_cos_scattering(double mu0, double mu, double phi);

#ifdef __cplusplus
}
#endif
#endif
