/* The eigenproblem of a small symmetric matrix.
 *
 * LAPACK's dsyevd takes 6 us for n = 8 and 94 us for n = 32 where these loops take a
 * quarter of that (ppscat-bench prints both): a solve of 16 to 64 streams is mostly
 * eigenproblems. Above PPS_EIGEN_SMALL the solver uses LAPACK.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_EIGEN_H
#define PPS_SOLVER_EIGEN_H

#include <stdbool.h>

enum { PPS_EIGEN_SMALL = 64 };

/* A = Y diag(value) Y^T, values ascending; A n x n, n <= PPS_EIGEN_SMALL, all of it given
 * (destroyed), columns of y the vectors. Backward stable; false where the iteration does
 * not end. Method: Householder to tridiagonal, then implicit QL (GVL section 8.3). */
bool pps_eigen_small(int n, double *a, double *value, double *y);

#endif
