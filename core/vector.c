/* Loops over arrays: exponentials and small dense algebra, many columns at a time.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/vector.h"

#include "core/lanes.h"

PPS_CLONES void pps_exp_array(size_t n, const double *x, double *y) {
    size_t i = 0;
    for (; i + PPS_LANES <= n; i += PPS_LANES) {
        lanes_exp(x + i, y + i);
    }
    if (i < n) {
        double rest[PPS_LANES] = {0};
        for (size_t l = 0; l < n - i; l++) {
            rest[l] = x[i + l];
        }
        lanes_exp(rest, rest);
        for (size_t l = 0; l < n - i; l++) {
            y[i + l] = rest[l];
        }
    }
}

PPS_CLONES void pps_rows_multiply(size_t rows, size_t inner, const double *a,
                                  size_t lda, size_t padded, const double *b,
                                  size_t ldb, double *c) {
    for (size_t i = 0; i < rows; i++) {
        for (size_t at = 0; at < padded; at += PPS_LANES) {
            double sum[PPS_LANES] = {0};
            for (size_t j = 0; j < inner; j++) {
                double factor = a[i * lda + j];
                const double *bj = b + j * ldb + at;
                for (int l = 0; l < PPS_LANES; l++) {
                    sum[l] += factor * bj[l];
                }
            }
            for (int l = 0; l < PPS_LANES; l++) {
                c[i * padded + at + (size_t)l] = sum[l];
            }
        }
    }
}

/* x -= factor y */
static inline void subtract(double *restrict x, double factor,
                            const double *restrict y) {
    for (int l = 0; l < PPS_LANES; l++) {
        x[l] -= factor * y[l];
    }
}

static inline void scale(double *x, double factor) {
    for (int l = 0; l < PPS_LANES; l++) {
        x[l] *= factor;
    }
}

PPS_CLONES void pps_rows_solve(size_t n, const double *factor, size_t padded,
                               double *b) {
    for (size_t at = 0; at < padded; at += PPS_LANES) {
        double *column = b + at;
        for (size_t j = 0; j < n; j++) { /* L y = b */
            const double *lj = factor + j * n;
            double *bj = column + j * padded;
            scale(bj, lj[j]);
            for (size_t i = j + 1; i < n; i++) {
                subtract(column + i * padded, lj[i], bj);
            }
        }
        for (size_t j = n; j-- > 0;) { /* L^T x = y */
            const double *lj = factor + j * n;
            double sum[PPS_LANES];
            for (int l = 0; l < PPS_LANES; l++) {
                sum[l] = column[j * padded + (size_t)l];
            }
            for (size_t i = j + 1; i < n; i++) {
                subtract(sum, lj[i], column + i * padded);
            }
            for (int l = 0; l < PPS_LANES; l++) {
                column[j * padded + (size_t)l] = sum[l] * lj[j];
            }
        }
    }
}
