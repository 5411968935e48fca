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

/* Columns that the functions below work on at a time: each sum waits for itself, so that
 * several of them keep the units busy. Most first; all are whole blocks. */
enum { MOST_FOURS = 6 };

PPS_LANE void multiply_columns(size_t fours, size_t rows, size_t inner, const double *a,
                               size_t lda, size_t padded, const double *b, size_t ldb,
                               double *c) {
    for (size_t i = 0; i < rows; i++) {
        const double *ai = a + i * lda, *bj = b;
        four sum[MOST_FOURS] = {{0}};
        for (size_t j = 0; j < inner; j++, bj += ldb) {
            for (size_t l = 0; l < fours; l++) {
                sum[l] += ai[j] * four_at(bj + l * FOUR);
            }
        }
        for (size_t l = 0; l < fours; l++) {
            four_to(c + i * padded + l * FOUR, sum[l]);
        }
    }
}

PPS_CLONES void pps_rows_multiply(size_t rows, size_t inner, const double *a,
                                  size_t lda, size_t padded, const double *b,
                                  size_t ldb, double *c) {
    size_t at = 0;
    for (; at + 6 * FOUR <= padded; at += 6 * FOUR) {
        multiply_columns(6, rows, inner, a, lda, padded, b + at, ldb, c + at);
    }
    for (; at + 4 * FOUR <= padded; at += 4 * FOUR) {
        multiply_columns(4, rows, inner, a, lda, padded, b + at, ldb, c + at);
    }
    for (; at < padded; at += 2 * FOUR) {
        multiply_columns(2, rows, inner, a, lda, padded, b + at, ldb, c + at);
    }
}

/* Row i of the columns, less those of rows first .. last - 1 times factor[j * step], over
 * the diagonal. */
PPS_LANE void solve_row(size_t fours, size_t padded, double *column, size_t i,
                        size_t first, size_t last, const double *factor, size_t step,
                        double over) {
    four sum[MOST_FOURS];
    for (size_t l = 0; l < fours; l++) {
        sum[l] = four_at(column + i * padded + l * FOUR);
    }
    for (size_t j = first; j < last; j++) {
        for (size_t l = 0; l < fours; l++) {
            sum[l] -= factor[j * step] * four_at(column + j * padded + l * FOUR);
        }
    }
    for (size_t l = 0; l < fours; l++) {
        four_to(column + i * padded + l * FOUR, sum[l] * over);
    }
}

/* L y = b, then L^T x = y. */
PPS_LANE void solve_columns(size_t fours, size_t n, const double *factor, size_t padded,
                            double *column) {
    for (size_t i = 0; i < n; i++) {
        solve_row(fours, padded, column, i, 0, i, factor + i, n, factor[i + i * n]);
    }
    for (size_t i = n; i-- > 0;) {
        solve_row(fours, padded, column, i, i + 1, n, factor + i * n, 1,
                  factor[i + i * n]);
    }
}

PPS_CLONES void pps_rows_solve(size_t n, const double *factor, size_t padded,
                               double *b) {
    size_t at = 0;
    for (; at + 6 * FOUR <= padded; at += 6 * FOUR) {
        solve_columns(6, n, factor, padded, b + at);
    }
    for (; at + 4 * FOUR <= padded; at += 4 * FOUR) {
        solve_columns(4, n, factor, padded, b + at);
    }
    for (; at < padded; at += 2 * FOUR) {
        solve_columns(2, n, factor, padded, b + at);
    }
}
