/* BLAS and LAPACK behind one file, and an elimination that never subtracts.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/linear.h"

#include <stddef.h>

#include <cblas.h>
#include <lapacke.h>

void pps_linear_multiply(int rows, int cols, int inner, const double *a, int lda,
                         const double *b, int ldb, double keep, double *c, int ldc) {
    if (rows == 0 || cols == 0) {
        return;
    }
    if (cols == 1) {
        cblas_dgemv(CblasColMajor, CblasNoTrans, rows, inner, 1, a, lda, b, 1, keep, c,
                    1);
        return;
    }
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows, cols, inner, 1, a, lda,
                b, ldb, keep, c, ldc);
}

void pps_linear_outer(int rows, int cols, int inner, const double *a, int lda,
                      const double *b, int ldb, double *c, int ldc) {
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, cols, inner, 1, a, lda,
                b, ldb, 0, c, ldc);
}

bool pps_linear_factor(int n, double *a, int *pivot) {
    return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, a, n, pivot) == 0;
}

/* Eliminate column k below the diagonal; the diagonal is mended when its turn comes. */
static void eliminate(int n, double *a, double *excess, int k) {
    double *column = a + (size_t)k * (size_t)n;
    for (int i = k + 1; i < n; i++) {
        column[i] /= column[k];
        excess[i] -= column[i] * excess[k];
    }
    for (int j = k + 1; j < n; j++) {
        double *other = a + (size_t)j * (size_t)n, head = other[k];
        for (int i = k + 1; i < n; i++) {
            other[i] -= column[i] * head;
        }
    }
}

bool pps_linear_factor_excess(int n, double *a, double *excess, int *pivot) {
    for (int k = 0; k < n; k++) {
        double diagonal = excess[k];
        for (int j = k + 1; j < n; j++) {
            diagonal -= a[(size_t)k + (size_t)j * (size_t)n];
        }
        if (!(diagonal > 0)) {
            return false;
        }
        a[(size_t)k * ((size_t)n + 1)] = diagonal;
        pivot[k] = k + 1;
        eliminate(n, a, excess, k);
    }
    return true;
}

void pps_linear_solve(int n, const double *factors, const int *pivot, int n_rhs,
                      double *b, int ldb) {
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, n_rhs, factors, n, pivot, b, ldb);
}
