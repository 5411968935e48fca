/* Power series of modes and their ray integrals: vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/series.h"

#include "core/lanes.h"

/* Lanes `at` to `at` + 3 of a block. */
PPS_LANE void expand(const pps_series *series, size_t first, size_t at, double step,
                     double k2, double *a, double *b) {
    size_t i = first + at;
    four q = four_at(series->q + i), e = four_at(series->beam + i); /* of e^(-q tau) */
    four alpha = four_at(series->alpha + i), beta = four_at(series->beta + i);
    four psi = four_at(series->psi + i), phi = four_at(series->phi + i);
    for (size_t d = 0; d < PPS_SERIES_TERMS; d++) {
        double h = step * (1.0 / (double)(d + 1));
        four psi_next = h * (beta * e - phi);
        four_to(a + d * PPS_LANES + at, psi);
        four_to(b + d * PPS_LANES + at, phi);
        phi = h * (alpha * e - k2 * psi);
        psi = psi_next;
        e = -h * (e * q);
    }
}

PPS_CLONES void pps_series_expand(const pps_series *series, size_t first, double step,
                                  double k, double *restrict a, double *restrict b) {
    expand(series, first, 0, step, k * k, a, b);
    expand(series, first, FOUR, step, k * k, a, b);
}

PPS_CLONES void pps_series_value(const double *a, double u, double *value) {
    four left = {0}, right = {0};
    for (int d = PPS_SERIES_TERMS; d-- > 0;) {
        left = left * u + four_at(a + d * PPS_LANES);
        right = right * u + four_at(a + d * PPS_LANES + FOUR);
    }
    four_to(value, left);
    four_to(value + FOUR, right);
}

/* m_d(z) = z int_0^1 v^d e^(-z (1 - v)) dv obeys m_d = 1 - (d/z) m_(d-1). Upwards that
 * damps errors for d <= z, downwards for d > z; started at START_DOWN the first guess has
 * damped out wherever d > z. */
enum { START_DOWN = 80 };

PPS_LANE void moments_of(four z, four first, double share, size_t padded,
                         double *moment) {
    four up[PPS_SERIES_TERMS] = {first}, down = z / (z + (START_DOWN + 1));
    for (int d = 1; d < PPS_SERIES_TERMS; d++) {
        up[d] = 1 - d * up[d - 1] / z;
    }
    for (int d = START_DOWN; d >= PPS_SERIES_TERMS; d--) {
        down = z * (1 - down) * (1.0 / d);
    }
    for (int d = PPS_SERIES_TERMS - 1; d > 0; d--) {
        up[d] = four_choose((double)d > z, down, up[d]);
        down = z * (1 - down) * (1.0 / d);
    }
    double power = 1;
    for (size_t d = 0; d < PPS_SERIES_TERMS; d++) {
        four_to(moment + d * padded, power * up[d]);
        power *= share;
    }
}

PPS_CLONES void pps_series_moments(size_t padded, double w, double t, const double *c,
                                   const double *ect, const double *root,
                                   double *moment) {
    for (size_t i = 0; i < padded; i += FOUR) {
        four z = four_at(c + i) * t; /* then 1 - e^(-z) */
        four near = z * four_at(root + i) * four_sinh_over(z * z / 4);
        four first = four_choose(z < 1, near, 1 - four_at(ect + i));
        moments_of(z, first, t / w, padded, moment + i);
    }
}
