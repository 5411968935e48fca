/* Power series of modes and their ray integrals: vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/series.h"

#include "core/lanes.h"

/* Half a block: the state, and the beam as it goes on. */
typedef struct {
    four psi, phi, e;
    four q, alpha, beta;
} half_block;

PPS_LANE half_block half_at(const pps_series *series, size_t i) {
    return (half_block){four_at(series->psi + i),   four_at(series->phi + i),
                        four_at(series->beam + i),  four_at(series->q + i),
                        four_at(series->alpha + i), four_at(series->beta + i)};
}

/* One term further. */
PPS_LANE void expand(half_block *x, double h, double k2, double *a, double *b) {
    four psi_next = h * (x->beta * x->e - x->phi);
    four_to(a, x->psi);
    four_to(b, x->phi);
    x->phi = h * (x->alpha * x->e - k2 * x->psi);
    x->psi = psi_next;
    x->e = -h * (x->e * x->q);
}

PPS_CLONES void pps_series_expand(const pps_series *series, double step, double k,
                                  double *restrict a, double *restrict b) {
    half_block left = half_at(series, 0), right = half_at(series, FOUR);
    for (size_t d = 0; d < PPS_SERIES_TERMS; d++, a += PPS_LANES, b += PPS_LANES) {
        double h = step * (1.0 / (double)(d + 1));
        expand(&left, h, k * k, a, b);
        expand(&right, h, k * k, a + FOUR, b + FOUR);
    }
}

PPS_CLONES void pps_series_value(const double *a, const double *b, double u,
                                 double *psi, double *phi) {
    four psi_left = {0}, psi_right = {0}, phi_left = {0}, phi_right = {0};
    for (size_t d = u == 0 ? 1 : PPS_SERIES_TERMS; d-- > 0;) {
        const double *ad = a + d * PPS_LANES, *bd = b + d * PPS_LANES;
        psi_left = psi_left * u + four_at(ad);
        psi_right = psi_right * u + four_at(ad + FOUR);
        phi_left = phi_left * u + four_at(bd);
        phi_right = phi_right * u + four_at(bd + FOUR);
    }
    four_to(psi, psi_left);
    four_to(psi + FOUR, psi_right);
    four_to(phi, phi_left);
    four_to(phi + FOUR, phi_right);
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
