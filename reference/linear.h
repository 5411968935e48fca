/* The dense linear algebra that adding needs; linear.c alone sees BLAS and LAPACK.
 *
 * Matrices are column-major: a[i + j * lda].
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_REFERENCE_LINEAR_H
#define PPS_REFERENCE_LINEAR_H

#include <stdbool.h>

/* C <- A B + keep C; A is rows x inner, B inner x cols. */
void pps_linear_multiply(int rows, int cols, int inner, const double *a, int lda,
                         const double *b, int ldb, double keep, double *c, int ldc);

/* C <- A B^T, A is rows x inner, B cols x inner. */
void pps_linear_outer(int rows, int cols, int inner, const double *a, int lda,
                      const double *b, int ldb, double *c, int ldc);

/* A <- its triangular factors, A n x n. False where it is singular. */
bool pps_linear_factor(int n, double *a, int *pivot);

/* The same for A with no positive entry off the diagonal, whose row sums `excess` >= 0
 * are known better than the entries tell: the diagonal is taken from the row sums, so
 * that nothing is ever subtracted and the solution of A x = b >= 0 keeps its relative
 * accuracy however small the excess is (Grassmann, Taksar & Heyman: GTH85). Destroys
 * excess. */
bool pps_linear_factor_excess(int n, double *a, double *excess, int *pivot);

/* B <- A^-1 B for A factored by either, n_rhs columns. */
void pps_linear_solve(int n, const double *factors, const int *pivot, int n_rhs,
                      double *b, int ldb);

#endif
