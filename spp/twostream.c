/* A two-stream model solved as one mode (core/mode.h): psi = S, phi = f D, so that
 * k^2 = e f, alpha = f a, beta = b and G = f.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "spp/twostream.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

void pps_twostream_solve(pps_twostream *two, double thickness, double mu0, double e,
                         double f, double a, double b) {
    two->f = f;
    two->sky = false;
    pps_mode_beam(&two->mode, sqrt(e * f), thickness, 1 / mu0, f * a, b);
    pps_mode_solve(&two->mode, f, 0);
}

void pps_twostream_solve_sky(pps_twostream *two, double thickness, double e, double f) {
    two->f = f;
    two->sky = true;
    pps_mode_dark(&two->mode, sqrt(e * f), thickness);
    pps_mode_solve(&two->mode, f, 2 * PI * f); /* S + D = 2 F+ = 2 pi */
}

pps_flux pps_twostream_flux(const pps_twostream *two, double tau) {
    double s, phi, q = two->mode.q, beam = two->sky ? 0 : exp(-q * tau);
    pps_mode_state(&two->mode, tau, &s, &phi);
    double difference = phi / two->f;
    return (pps_flux){
        .up = tau < two->mode.w ? (s - difference) / 2 : 0,
        .down = tau > 0    ? (s + difference) / 2
                : two->sky ? PI
                           : 0,
        .direct = beam / q,
        .mean_diffuse = s / (2 * PI),
        .mean = s / (2 * PI) + beam / (4 * PI),
    };
}

void pps_twostream_ray(const pps_twostream *two, const pps_ray *ray, double *sum,
                       double *difference) {
    pps_mode_depth at = pps_mode_at(&two->mode, ray->tau);
    pps_mode_ray(&two->mode, ray, &at, sum, difference);
    *difference /= two->f;
}
