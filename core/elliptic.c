/* Elliptic integrals by Gauss's arithmetic-geometric mean: of a = 1 and b = sqrt(1 - k^2),
 * with c = (a - b)/2 of each step,
 *     E = pi/(2 a) [1 - k^2/2 - sum over n >= 1 of 2^(n-1) c_n^2].
 * GSL's, by Carlson's forms, is twenty times slower and off by 1e-12 towards k = 1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/elliptic.h"

#include <math.h>

#include "core/vector.h"

/* Below this complement, E is 1 + complement/2 (ln(4/sqrt(complement)) - 1/2): the next
 * term is its square. Above it, so many means are enough. */
static const double SMALLEST = 1e-10;
enum { MEANS = 7 };

/* The mean over a bracketed sum: a of the last step, and the bracket. */
PPS_CLONES static void means(size_t n, const double *complement, double *mean,
                             double *bracket) {
    double a[PPS_LANES], b[PPS_LANES], sum[PPS_LANES];
    for (size_t l = 0; l < PPS_LANES; l++) {
        double from = l < n && complement[l] > SMALLEST ? complement[l] : SMALLEST;
        a[l] = 1;
        b[l] = sqrt(from);
        sum[l] = (1 + from) / 2;
    }
    double power = 1;
    for (int step = 0; step < MEANS; step++, power *= 2) {
        for (int l = 0; l < PPS_LANES; l++) {
            double half = (a[l] - b[l]) / 2, middle = (a[l] + b[l]) / 2;
            b[l] = sqrt(a[l] * b[l]);
            a[l] = middle;
            sum[l] -= power * (half * half);
        }
    }
    for (int l = 0; l < PPS_LANES; l++) {
        mean[l] = a[l];
        bracket[l] = sum[l];
    }
}

void pps_elliptic_e(size_t n, double *complement) {
    double mean[PPS_LANES], bracket[PPS_LANES];
    for (size_t at = 0; at < n; at += PPS_LANES) {
        size_t block = n - at < PPS_LANES ? n - at : PPS_LANES;
        means(block, complement + at, mean, bracket);
        for (size_t l = 0; l < block; l++) {
            double m = complement[at + l];
            complement[at + l] = m > SMALLEST
                                     ? 1.57079632679489661923 * bracket[l] / mean[l]
                                 : m > 0 ? 1 + m / 2 * (log(4 / sqrt(m)) - 0.5)
                                         : 1;
        }
    }
}
