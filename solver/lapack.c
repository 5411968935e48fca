/* LAPACKE behind one file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/lapack.h"

#include <math.h>
#include <string.h>

#include <cblas.h>
#include <lapacke.h>

#include "core/lanes.h"
#include "solver/eigen.h"

size_t pps_lapack_work(int n) {
    size_t m = (size_t)n;
    /* dsyevd: 1 + 6n + 2n^2 and 3 + 5n integers; dgesvd: 5n and more to run blocked. */
    return 3 * m * m + 64 * m + 256;
}

static void clear_upper(int n, double *a) {
    for (int j = 1; j < n; j++) {
        memset(a + (size_t)j * (size_t)n, 0, (size_t)j * sizeof *a);
    }
}

/* Calls of LAPACK and BLAS cost as much as the work itself at a few unknowns. */
enum { SMALL_PRODUCT = 16, SMALL = 32 };

/* Column after column, each taken off all later ones at once: nothing waits but for the
 * root. */
PPS_CLONES static bool small_cholesky(int n, double *a) {
    double l[SMALL * SMALL]; /* columns padded, so that blocks stay inside */
    int rows = (int)pps_padded((size_t)n);
    for (int j = 0; j < n; j++) {
        memset(l + j * rows, 0, (size_t)rows * sizeof *l);
        memcpy(l + j * rows + j, a + j + j * n, (size_t)(n - j) * sizeof *l);
    }
    for (int j = 0; j < n; j++) {
        double *column = l + j * rows;
        if (!(column[j] > 0)) {
            return false;
        }
        double root = sqrt(column[j]), over = root * (1 / column[j]);
        for (int i = j / FOUR * FOUR; i < n; i += FOUR) {
            four_to(column + i, four_at(column + i) * over);
        }
        for (int k = j + 1; k < n; k++) {
            double *later = l + k * rows;
            for (int i = k / FOUR * FOUR; i < n; i += FOUR) {
                four_to(later + i,
                        four_at(later + i) - column[k] * four_at(column + i));
            }
        }
        memset(a + j * n, 0, (size_t)j * sizeof *a);
        memcpy(a + j + j * n, column + j, (size_t)(n - j) * sizeof *a);
        a[j + j * n] = root;
    }
    return true;
}

bool pps_cholesky(int n, double *a) {
    if (n <= SMALL) {
        return small_cholesky(n, a);
    }
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, a, n)) {
        return false;
    }
    clear_upper(n, a);
    return true;
}

/* One column: b <- L^-1 b, L^-T b. */
static void solve_column(int n, const double *restrict lower, double *restrict b) {
    for (int j = 0; j < n; j++) {
        const double *column = lower + j * n;
        double bj = b[j] * (1 / column[j]); /* a quotient that need not wait for b */
        b[j] = bj;
        for (int i = j + 1; i < n; i++) {
            b[i] -= bj * column[i];
        }
    }
}

static void solve_column_transposed(int n, const double *restrict lower,
                                    double *restrict b) {
    for (int j = n - 1; j >= 0; j--) {
        const double *column = lower + j * n;
        double sum = b[j];
        for (int i = j + 1; i < n; i++) {
            sum -= column[i] * b[i];
        }
        b[j] = sum * (1 / column[j]);
    }
}

/* B <- L^-T B, `fours` FOURs of columns at a time: as many sums that need not wait for
 * each other. */
enum { MOST_FOURS = 4, MOST_COLUMNS = MOST_FOURS * FOUR };

PPS_LANE void solve_columns_transposed(size_t fours, int n, const double *lower,
                                       int columns, double *b) {
    double row[SMALL][MOST_COLUMNS];
    for (int i = 0; i < n; i++) {
        for (int l = 0; l < (int)fours * FOUR; l++) {
            row[i][l] = l < columns ? b[i + l * n] : 0;
        }
    }
    for (int j = n - 1; j >= 0; j--) {
        four sum[MOST_FOURS];
        for (size_t f = 0; f < fours; f++) {
            sum[f] = four_at(row[j] + f * FOUR);
        }
        for (int i = j + 1; i < n; i++) {
            for (size_t f = 0; f < fours; f++) {
                sum[f] -= lower[i + j * n] * four_at(row[i] + f * FOUR);
            }
        }
        for (size_t f = 0; f < fours; f++) {
            four_to(row[j] + f * FOUR, sum[f] * (1 / lower[j + j * n]));
        }
    }
    for (int l = 0; l < columns; l++) {
        for (int i = 0; i < n; i++) {
            b[i + l * n] = row[i][l];
        }
    }
}

PPS_CLONES static void small_solve_transposed(int n, const double *lower, int n_rhs,
                                              double *b) {
    int at = 0;
    for (; at + MOST_COLUMNS <= n_rhs; at += MOST_COLUMNS) {
        solve_columns_transposed(MOST_FOURS, n, lower, MOST_COLUMNS, b + at * n);
    }
    for (; at < n_rhs; at += PPS_LANES) {
        int columns = n_rhs - at < PPS_LANES ? n_rhs - at : PPS_LANES;
        solve_columns_transposed(2, n, lower, columns, b + at * n);
    }
}

void pps_lower_solve(int n, const double *lower, bool transposed, double *b) {
    if (transposed) {
        solve_column_transposed(n, lower, b);
    } else {
        solve_column(n, lower, b);
    }
}

void pps_lower_solve_transposed(int n, const double *lower, int n_rhs, double *b) {
    if (n <= SMALL) {
        small_solve_transposed(n, lower, n_rhs, b);
        return;
    }
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, n,
                n_rhs, 1, lower, n, b, n);
}

void pps_qr_r(int n, double *a, double *work) {
    LAPACKE_dgeqrf_work(LAPACK_COL_MAJOR, n, n, a, n, work, work + n,
                        (int)pps_lapack_work(n) - n);
    for (int j = 0; j < n; j++) {
        for (int i = j + 1; i < n; i++) {
            a[i + j * n] = 0;
        }
    }
}

/* A or A^T in columns that are padded to whole blocks. */
PPS_LANE void copy_padded(bool transposed, int n, int r, const double *a, int lda,
                          double *copy) {
    int across = transposed ? lda : 1, down = transposed ? 1 : lda;
    for (int k = 0; k < r; k++) {
        for (int i = 0; i < n; i++) {
            copy[i + k * SMALL_PRODUCT] = a[i * across + k * down];
        }
        for (int i = n; i % PPS_LANES != 0; i++) {
            copy[i + k * SMALL_PRODUCT] = 0;
        }
    }
}

PPS_CLONES static void small_multiply(bool transposed, int n, int cols, int r,
                                      const double *a, int lda, const double *b,
                                      int ldb, double *c, int ldc) {
    double copy[SMALL_PRODUCT * SMALL_PRODUCT], spare[SMALL_PRODUCT];
    bool whole = n % PPS_LANES == 0; /* no block sticks out */
    if (transposed || !whole) {
        copy_padded(transposed, n, r, a, lda, copy);
        a = copy;
        lda = SMALL_PRODUCT;
    }
    for (int j = 0; j < cols; j++) {
        double *column = whole ? c + j * ldc : spare;
        for (int i = 0; i < n; i += PPS_LANES) {
            four low = {0}, high = {0};
            for (int k = 0; k < r; k++) {
                low += b[k + j * ldb] * four_at(a + i + k * lda);
                high += b[k + j * ldb] * four_at(a + i + FOUR + k * lda);
            }
            four_to(column + i, low);
            four_to(column + i + FOUR, high);
        }
        if (!whole) {
            memcpy(c + j * ldc, spare, (size_t)n * sizeof *c);
        }
    }
}

void pps_multiply(bool transposed, int n, int cols, int r, const double *a, int lda,
                  const double *b, int ldb, double *c, int ldc) {
    if (n <= SMALL_PRODUCT && r <= SMALL_PRODUCT) {
        small_multiply(transposed, n, cols, r, a, lda, b, ldb, c, ldc);
        return;
    }
    cblas_dgemm(CblasColMajor, transposed ? CblasTrans : CblasNoTrans, CblasNoTrans, n,
                cols, r, 1, a, lda, b, ldb, 0, c, ldc);
}

void pps_lower_times(int n, const double *lower, int n_rhs, double *b) {
    if (n <= SMALL_PRODUCT && n_rhs <= SMALL_PRODUCT) {
        double copy[SMALL_PRODUCT * SMALL_PRODUCT];
        memcpy(copy, b, (size_t)(n * n_rhs) * sizeof *b);
        small_multiply(false, n, n_rhs, n, lower, n, copy, n, b, n);
        return;
    }
    cblas_dtrmm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, n,
                n_rhs, 1, lower, n, b, n);
}

static void square_roots(int n, double *k) {
    for (int j = 0; j < n; j++) {
        k[j] = sqrt(fmax(k[j], 0));
    }
}

/* B^T B = Y K^2 Y^T. */
static pps_status squared_problem(int n, double *b, double *k, double *y,
                                  double *work) {
    if (n <= PPS_EIGEN_SMALL) {
        pps_multiply(true, n, n, n, b, n, b, n, work, n);
        if (pps_eigen_small(n, work, k, y)) {
            square_roots(n, k);
            return PPS_OK;
        }
    }
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, n, 1, b, n, 0, y, n);
    int *iwork = (int *)(void *)b; /* b has served; 3 + 5n integers need n >= 3 */
    int liwork = (int)((size_t)n * (size_t)n * sizeof *b / sizeof *iwork);
    if (liwork < 3 + 5 * n) {
        int small[32];
        if (LAPACKE_dsyevd_work(LAPACK_COL_MAJOR, 'V', 'L', n, y, n, k, work,
                                (int)pps_lapack_work(n), small, 32)) {
            return PPS_ERR_CONVERGENCE;
        }
    } else if (LAPACKE_dsyevd_work(LAPACK_COL_MAJOR, 'V', 'L', n, y, n, k, work,
                                   (int)pps_lapack_work(n), iwork, liwork)) {
        return PPS_ERR_CONVERGENCE;
    }
    square_roots(n, k);
    return PPS_OK;
}

pps_status pps_right_singular(int n, bool squared, double *b, double *k, double *y,
                              double *work) {
    if (squared) {
        return squared_problem(n, b, k, y, work);
    }
    /* dgesvd, not dgesdd: its implicit zero-shift QR keeps the small singular values of
     * a graded matrix, where divide and conquer keeps only eps times the largest. */
    double dummy;
    if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', 'A', n, n, b, n, k, &dummy, 1, y, n,
                            work, (int)pps_lapack_work(n))) {
        return PPS_ERR_CONVERGENCE;
    }
    /* y holds Y^T, k descends: transpose and reverse. */
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) {
            double swap = y[i + j * n];
            y[i + j * n] = y[j + i * n];
            y[j + i * n] = swap;
        }
    }
    for (int j = 0; j < n / 2; j++) {
        int r = n - 1 - j;
        double swap = k[j];
        k[j] = k[r];
        k[r] = swap;
        cblas_dswap(n, y + (size_t)j * (size_t)n, 1, y + (size_t)r * (size_t)n, 1);
    }
    return PPS_OK;
}
