/* The Henyey-Greenstein phase function and its integrals.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/phase.h>

#include "core/elliptic.h"
#include "core/gsl.h"
#include "core/phase.h"
#include "core/vector.h"

static const double PI = 3.14159265358979323846;

double pps_hg(double g, double cos_theta) {
    return (1 - g) * (1 + g) / (4 * PI) / pps_hg_over(g, cos_theta);
}

double pps_cos_degrees(double angle) {
    /* The remainder by 360: both 360 times a whole number and the difference are exact. */
    double turn = fabs(angle) < 1e9 ? fabs(angle - 360 * rint(angle / 360))
                                    : fabs(remainder(angle, 360));
    if (turn == 60 || turn == 120) {
        return turn == 60 ? 0.5 : -0.5;
    }
    return turn <= 45    ? cos(turn * (PI / 180))
           : turn <= 135 ? sin((90 - turn) * (PI / 180))
                         : -cos((180 - turn) * (PI / 180));
}

double pps_cos_scattering(double mu0, double mu, double phi) {
    double sines = sqrt((1 - mu0) * (1 + mu0) * (1 - mu) * (1 + mu));
    return fmax(-1, fmin(1, mu0 * mu + sines * pps_cos_degrees(phi)));
}

PPS_CLONES void pps_hg_azimuths(double g, double mu0, double mu, size_t n,
                                const double *restrict cosine, double *restrict p) {
    double sines = sqrt((1 - mu0) * (1 + mu0) * (1 - mu) * (1 + mu));
    double power = (1 - g) * (1 + g) / (4 * PI);
    for (size_t i = 0; i < n; i++) {
        double x = mu0 * mu + sines * cosine[i];
        x = x > 1 ? 1 : x;
        x = x < -1 ? -1 : x;
        p[i] = power / pps_hg_over(g, x);
    }
}

/* integral over phi of (a - b cos phi)^(-3/2) is 4 E(2b/(a+b)) / ((a - b) sqrt(a + b)). */
PPS_CLONES void pps_hg_azimuth_means(double g, double mu0, size_t n, const double *mu,
                                     double *mean) {
    double size = fabs(g), side = g < 0 ? -1 : 1; /* p(-g; mu) = p(g; -mu) */
    double sine0 = sqrt((1 - mu0) * (1 + mu0)), width = (1 - size) * (1 - size);
    double power = (1 - size) * (1 + size) / (2 * PI * PI);
    for (size_t at = 0; at < n; at += PPS_LANES) {
        double a_minus_b[PPS_LANES], a_plus_b[PPS_LANES], e[PPS_LANES];
        for (int l = 0; l < PPS_LANES; l++) {
            /* a - b = (1-g)^2 + 2 g (1 - cos(theta - theta0)), the difference of angles
             * taken without cancellation: 1 - cos = 2 sin^2(half), from the chord. */
            double x = side * mu[at + (size_t)l], sine = sqrt((1 - x) * (1 + x));
            double chord2 = (x - mu0) * (x - mu0) + (sine - sine0) * (sine - sine0);
            a_minus_b[l] = width + size * chord2;
            a_plus_b[l] = a_minus_b[l] + 4 * size * sine * sine0;
            e[l] = a_minus_b[l] / a_plus_b[l];
        }
        pps_elliptic_e(PPS_LANES, e);
        for (int l = 0; l < PPS_LANES; l++) {
            mean[at + (size_t)l] = power * e[l] / (a_minus_b[l] * sqrt(a_plus_b[l]));
        }
    }
}

double pps_hg_azimuth_mean(double g, double mu, double mu0) {
    double cosine[PPS_LANES], mean[PPS_LANES];
    for (int l = 0; l < PPS_LANES; l++) {
        cosine[l] = mu;
    }
    pps_hg_azimuth_means(g, mu0, PPS_LANES, cosine, mean);
    return mean[0];
}

/* integral over (0, pi/2) of du / ((p c^2 + q s^2) sqrt(a c^2 + b s^2)), c = cos u,
 * s = sin u, by Carlson's forms with positive terms only. */
static double elliptic_third(double p, double q, double a, double b) {
    if (p < q) {
        return elliptic_third(q, p, b, a); /* u -> pi/2 - u */
    }
    double y = b / a;
    return (pps_carlson_f(y) + (p - q) / (3 * p) * pps_carlson_j(y, q / p)) /
           (p * sqrt(a));
}

/* R - 1/2 = -sum over odd l of (2l+1)/2 g^l P_l(mu0) int_0^1 P_l; for small |g|. Nothing
 * that waits for the term before is divided. */
static double backward_series(double g, double mu0) {
    double sum = 0, power = g, half_moment = 0.5; /* int_0^1 P_1 = 1/2 */
    double before = 1, here = mu0;                /* P_0, P_1 */
    for (int l = 1; fabs(power) > 1e-18; l += 2) {
        double over = 1.0 / (l + 1), next = 1.0 / (l + 2);
        sum += (l + 0.5) * (power * half_moment) * here;
        double even = (2 * l + 1) * over * mu0 * here - l * over * before;
        double odd = (2 * l + 3) * next * mu0 * even - (l + 1) * next * here;
        before = even;
        here = odd;
        power *= g * g;
        half_moment *= -l * (1.0 / (l + 3)); /* int P_(l+2) / int P_l */
    }
    return 0.5 - sum;
}

/* The scattered directions are summed over cones of angle Theta about the beam; with the
 * antiderivative of p in cos Theta, integration by parts leaves, for g > 0,
 *   R = (1 - g)/(2 g) [ (1 + g)/pi I - 1 ],
 *   I = int_(-pi/2)^(pi/2) mu0 dt / ((1 - s^2 sin^2 t) sqrt(1 + g^2 - 2 g s sin t)),
 * s = sqrt(1 - mu0^2), which is two complete elliptic integrals of the third kind. */
static double backward_elliptic(double g, double mu0) {
    double s = sqrt((1 - mu0) * (1 + mu0));
    double one_minus_s = mu0 * mu0 / (1 + s);
    double a = (1 - g) * (1 - g) + 2 * g * one_minus_s; /* 1 + g^2 - 2 g s */
    double b = (1 + g) * (1 + g) - 2 * g * one_minus_s; /* 1 + g^2 + 2 g s */
    double integral = mu0 * (elliptic_third(one_minus_s, 1 + s, a, b) +
                             elliptic_third(1 + s, one_minus_s, a, b));
    return (1 - g) / (2 * g) * ((1 + g) / PI * integral - 1);
}

double pps_hg_backward(double g, double mu0) {
    if (mu0 < 1e-20) { /* R = 1/2 - O(mu0); below 1e-51 Carlson's arguments underflow */
        return 0.5;
    }
    if (fabs(g) < 0.6) {
        return backward_series(g, mu0);
    }
    return g > 0 ? backward_elliptic(g, mu0) : 1 - backward_elliptic(-g, mu0);
}
