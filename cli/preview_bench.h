/* Times of the preview, by running `ppscat-preview --bench`: the program itself is without
 * OpenGL.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_PREVIEW_BENCH_H
#define PPSCAT_CLI_PREVIEW_BENCH_H

#include <stddef.h>

/* A row of it: a piece of work of one of the six steps. */
typedef struct {
    int step;
    char work[60], renderer[100];
    double ms;
    size_t triangles, cells;
} preview_time;

typedef struct {
    size_t n;
    preview_time row[40];
} preview_times;

/* Run it with these arguments, NULL-terminated, behind --bench. CLI_REFUSED, and why in
 * static text, where there is no preview, or it fails (it says why itself). */
int preview_bench(const char *const *arguments, preview_times *out, const char **why);

/* Milliseconds of a piece of work; NAN where it is not there. */
double preview_ms(const preview_times *times, const char *work);

#endif
