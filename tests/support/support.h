/* What the test programs share: cmocka, a double-precision comparison, CSV tables.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TESTS_SUPPORT_H
#define PPS_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* |got - want| <= rtol |want| + atol, else fails and prints both and the error. */
#define assert_close(got, want, rtol, atol)                                            \
    support_assert_close((got), (want), (rtol), (atol), #got, __FILE__, __LINE__)

void support_assert_close(double got, double want, double rtol, double atol,
                          const char *what, const char *file, int line);

/* |got/want - 1|, 0 where both are below 1e-290. */
double support_relative_error(double got, double want);

/* A table of numbers from data/reference: comment lines and the header are skipped, text
 * that is no number reads as NAN. Fails the test when the file cannot be read. */
typedef struct {
    size_t n_rows, n_columns;
    double *value; /* value[row * n_columns + column] */
} support_table;

support_table support_read(const char *name);
void support_table_free(support_table *table);

/* Numbers in [0, 1) that are the same on every machine: splitmix64. */
double support_random(uint64_t *state);

#endif
