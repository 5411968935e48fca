/* Power series of modes and their ray integrals: vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/series.h"

#include "core/lanes.h"

PPS_CLONES void pps_series_expand(const pps_series *series, size_t first, double step,
                                  double k, double *a, double *b) {
    double e[PPS_LANES]; /* of e^(-q tau) */
    for (int l = 0; l < PPS_LANES; l++) {
        a[l] = series->psi[first + (size_t)l];
        b[l] = series->phi[first + (size_t)l];
        e[l] = series->beam[first + (size_t)l];
    }
    for (int d = 0; d + 1 < PPS_SERIES_TERMS; d++) {
        double h = step / (d + 1);
        double *restrict a_next = a + (d + 1) * PPS_LANES;
        double *restrict b_next = b + (d + 1) * PPS_LANES;
        const double *a_here = a + d * PPS_LANES, *b_here = b + d * PPS_LANES;
        for (int l = 0; l < PPS_LANES; l++) {
            size_t i = first + (size_t)l;
            a_next[l] = h * (series->beta[i] * e[l] - b_here[l]);
            b_next[l] = h * (series->alpha[i] * e[l] - k * k * a_here[l]);
            e[l] *= -h * series->q[i];
        }
    }
}

PPS_CLONES void pps_series_value(const double *a, double u, double *value) {
    double sum[PPS_LANES] = {0};
    for (int d = PPS_SERIES_TERMS; d-- > 0;) {
        for (int l = 0; l < PPS_LANES; l++) {
            sum[l] = sum[l] * u + a[d * PPS_LANES + l];
        }
    }
    for (int l = 0; l < PPS_LANES; l++) {
        value[l] = sum[l];
    }
}

/* m_d(z) = z int_0^1 v^d e^(-z (1 - v)) dv obeys m_d = 1 - (d/z) m_(d-1). Upwards that
 * damps errors for d <= z, downwards for d > z; started at START_DOWN the first guess has
 * damped out wherever d > z. */
enum { START_DOWN = 80 };

static inline void block_moments(double share, const double *z, const double *first,
                                 double *moment, size_t padded) {
    double up[PPS_SERIES_TERMS][PPS_LANES], down[PPS_LANES];
    for (int l = 0; l < PPS_LANES; l++) {
        up[0][l] = first[l];
        down[l] = z[l] / (z[l] + START_DOWN + 1);
    }
    for (int d = 1; d < PPS_SERIES_TERMS; d++) {
        for (int l = 0; l < PPS_LANES; l++) {
            up[d][l] = 1 - d * up[d - 1][l] / z[l];
        }
    }
    for (int d = START_DOWN; d >= PPS_SERIES_TERMS; d--) {
        for (int l = 0; l < PPS_LANES; l++) {
            down[l] = z[l] * (1 - down[l]) * (1.0 / d);
        }
    }
    for (int d = PPS_SERIES_TERMS - 1; d > 0; d--) {
        for (int l = 0; l < PPS_LANES; l++) {
            up[d][l] = d > z[l] ? down[l] : up[d][l];
            down[l] = z[l] * (1 - down[l]) * (1.0 / d);
        }
    }
    double power = 1;
    for (int d = 0; d < PPS_SERIES_TERMS; d++) {
        for (int l = 0; l < PPS_LANES; l++) {
            moment[(size_t)d * padded + (size_t)l] = power * up[d][l];
        }
        power *= share;
    }
}

PPS_CLONES void pps_series_moments(size_t padded, double w, double t, const double *c,
                                   const double *ect, const double *root,
                                   double *moment) {
    for (size_t at = 0; at < padded; at += PPS_LANES) {
        double z[PPS_LANES], first[PPS_LANES]; /* first: 1 - e^(-z) */
        for (int l = 0; l < PPS_LANES; l++) {
            size_t i = at + (size_t)l;
            z[l] = c[i] * t;
            double near = z[l] * root[i] * lane_sinh_over(z[l] * z[l] / 4);
            first[l] = z[l] < 1 ? near : 1 - ect[i];
        }
        block_moments(t / w, z, first, moment + at, padded);
    }
}
