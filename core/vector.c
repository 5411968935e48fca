/* Loops over arrays: exponentials and small dense algebra, many columns at a time.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/vector.h"

#include "core/lanes.h"

PPS_CLONES void pps_exp_array(size_t n, const double *x, double *y) {
    size_t i = 0;
    for (; i + FOUR <= n; i += FOUR) {
        four_to(y + i, four_exp(four_at(x + i)));
    }
    if (i < n) {
        double rest[FOUR] = {0};
        for (size_t l = 0; l < n - i; l++) {
            rest[l] = x[i + l];
        }
        four_to(rest, four_exp(four_at(rest)));
        for (size_t l = 0; l < n - i; l++) {
            y[i + l] = rest[l];
        }
    }
}

PPS_CLONES void pps_rows_multiply(size_t rows, size_t inner, const double *a,
                                  size_t lda, size_t padded, const double *b,
                                  size_t ldb, double *c) {
    for (size_t i = 0; i < rows; i++) {
        const double *ai = a + i * lda;
        for (size_t at = 0; at < padded; at += PPS_LANES) {
            const double *bj = b + at;
            four left = {0}, right = {0};
            for (size_t j = 0; j < inner; j++, bj += ldb) {
                left += ai[j] * four_at(bj);
                right += ai[j] * four_at(bj + FOUR);
            }
            four_to(c + i * padded + at, left);
            four_to(c + i * padded + at + FOUR, right);
        }
    }
}

/* L y = b, then L^T x = y, for a block of columns. */
PPS_LANE void solve_block(size_t n, const double *factor, size_t padded,
                          double *column) {
    for (size_t i = 0; i < n; i++) {
        double *bi = column + i * padded;
        four left = four_at(bi), right = four_at(bi + FOUR);
        for (size_t j = 0; j < i; j++) {
            double l = factor[i + j * n];
            left -= l * four_at(column + j * padded);
            right -= l * four_at(column + j * padded + FOUR);
        }
        four_to(bi, left * factor[i + i * n]);
        four_to(bi + FOUR, right * factor[i + i * n]);
    }
    for (size_t i = n; i-- > 0;) {
        const double *li = factor + i * n;
        double *bi = column + i * padded;
        four left = four_at(bi), right = four_at(bi + FOUR);
        for (size_t j = i + 1; j < n; j++) {
            left -= li[j] * four_at(column + j * padded);
            right -= li[j] * four_at(column + j * padded + FOUR);
        }
        four_to(bi, left * li[i]);
        four_to(bi + FOUR, right * li[i]);
    }
}

PPS_CLONES void pps_rows_solve(size_t n, const double *factor, size_t padded,
                               double *b) {
    for (size_t at = 0; at < padded; at += PPS_LANES) {
        solve_block(n, factor, padded, b + at);
    }
}
