/* Power series of modes and their ray integrals: vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/series.h"

#include <assert.h>
#include <stdbool.h>

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

/* One term further. What waits for the term before, psi and phi, is a product and a
 * difference away from it. */
PPS_LANE void expand(half_block *x, double h, double hk2, double *a, double *b) {
    four he = h * x->e;
    four psi_next = x->beta * he - h * x->phi;
    four_to(a, x->psi);
    four_to(b, x->phi);
    x->phi = x->alpha * he - hk2 * x->psi;
    x->psi = psi_next;
    x->e = -(x->q * he);
}

PPS_CLONES void pps_series_expand(const pps_series *series, double step, double k,
                                  double *restrict a, double *restrict b) {
    static const double over[] = {
        1.0,      1.0 / 2,  1.0 / 3,  1.0 / 4,  1.0 / 5,  1.0 / 6,  1.0 / 7,
        1.0 / 8,  1.0 / 9,  1.0 / 10, 1.0 / 11, 1.0 / 12, 1.0 / 13, 1.0 / 14,
        1.0 / 15, 1.0 / 16, 1.0 / 17, 1.0 / 18, 1.0 / 19, 1.0 / 20, 1.0 / 21,
        1.0 / 22, 1.0 / 23, 1.0 / 24, 1.0 / 25, 1.0 / 26};
    static_assert(sizeof over == PPS_SERIES_TERMS * sizeof *over, "one a term");
    half_block left = half_at(series, 0), right = half_at(series, FOUR);
    double k2 = k * k;
    bool whole = series->n > FOUR;
    for (size_t d = 0; d < PPS_SERIES_TERMS; d++, a += PPS_LANES, b += PPS_LANES) {
        double h = step * over[d];
        expand(&left, h, h * k2, a, b);
        if (whole) {
            expand(&right, h, h * k2, a + FOUR, b + FOUR);
        }
    }
}

/* Even and odd powers apart: half as long to wait. */
PPS_LANE four horner(const double *a, double u) {
    four even = {0}, odd = {0};
    for (size_t d = PPS_SERIES_TERMS; d > 0; d -= 2) {
        odd = odd * (u * u) + four_at(a + (d - 1) * PPS_LANES);
        even = even * (u * u) + four_at(a + (d - 2) * PPS_LANES);
    }
    return even + u * odd;
}

PPS_CLONES void pps_series_value(size_t n, const double *a, const double *b, double u,
                                 double *psi, double *phi) {
    for (size_t at = 0; at < n; at += FOUR) {
        four_to(psi + at, u == 0 ? four_at(a + at) : horner(a + at, u));
        four_to(phi + at, u == 0 ? four_at(b + at) : horner(b + at, u));
    }
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
