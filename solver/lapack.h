/* The dense linear algebra the solver needs; lapack.c alone sees LAPACKE.
 *
 * Matrices are column-major, n x n with leading dimension n: a[i + j * n].
 * Workspaces come from the caller: pps_lapack_work(n) doubles serve every call.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_LAPACK_H
#define PPS_SOLVER_LAPACK_H

#include <stdbool.h>
#include <stddef.h>

#include <ppscat/status.h>

size_t pps_lapack_work(int n);

/* A = L L^T: L in the lower triangle, the upper one set to 0. False where A is not
 * positive definite. */
bool pps_cholesky(int n, double *a);

/* b <- L^-1 b or L^-T b for lower triangular L and one column; B <- L^-T B for many. */
void pps_lower_solve(int n, const double *lower, bool transposed, double *b);
void pps_lower_solve_transposed(int n, const double *lower, int n_rhs, double *b);

/* B <- L B for lower triangular L. */
void pps_lower_times(int n, const double *lower, int n_rhs, double *b);

/* A <- R of A = Q R: upper triangle, the lower one set to 0. */
void pps_qr_r(int n, double *a, double *work);

/* C <- op(A) B, A is n x r (or r x n when transposed), B r x cols. */
void pps_multiply(bool transposed, int n, int cols, int r, const double *a, int lda,
                  const double *b, int ldb, double *c, int ldc);

/* Singular values of B, ascending in k, and right singular vectors, the columns of y.
 * Destroys b. With `squared`, by the eigenproblem of B^T B: faster, but what is below
 * sqrt(eps) of the largest k is lost. */
pps_status pps_right_singular(int n, bool squared, double *b, double *k, double *y,
                              double *work);

#endif
