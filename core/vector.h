/* Loops over arrays, compiled for several CPU levels and chosen at run time.
 *
 * Arrays that such loops run over are padded to whole blocks of PPS_LANES numbers
 * (pps_padded). Every lane goes through the same operations in the same order, and
 * -ffp-contract=off holds everywhere, so a number has the same bits wherever it stands in
 * an array, however long that is, and on every CPU level.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_VECTOR_H
#define PPS_CORE_VECTOR_H

#include <stddef.h>

/* A function marked PPS_CLONES exists for x86-64 as configured, for AVX2 and for AVX-512;
 * the dynamic linker picks. Elsewhere (other CPUs, compilers or C libraries, and the
 * sanitizers, whose run time is not up yet when the linker asks) it is a plain function:
 * slower, with the same results. */
#if defined(PPS_HAVE_TARGET_CLONES) && !defined(__clang__) &&                          \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PPS_CLONES                                                                     \
    __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define PPS_CLONES
#endif

enum { PPS_LANES = 8 };

/* n rounded up to whole blocks. */
static inline size_t pps_padded(size_t n) {
    return (n + PPS_LANES - 1) / PPS_LANES * PPS_LANES;
}

/* y_i = e^(x_i) for x_i <= 700, to 1 ulp; 0 below e^-708. n need not be padded; x may be
 * y. */
void pps_exp_array(size_t n, const double *x, double *y);

/* C = A^T B: A is inner x rows, column-major with leading dimension lda; B and C have
 * `padded` columns, rows contiguous, those of B ldb apart. Each element is summed in
 * order of the inner index. */
void pps_rows_multiply(size_t rows, size_t inner, const double *a, size_t lda,
                       size_t padded, const double *b, size_t ldb, double *c);

/* B <- A^-1 B for A = L L^T, n x n column-major in `factor` with the reciprocals of L's
 * diagonal on the diagonal; B has n rows of `padded` columns. */
void pps_rows_solve(size_t n, const double *factor, size_t padded, double *b);

#endif
