/* Writing CSV (RFC 4180): one header row, LF ends, numbers that read back the same.
 *
 * Write errors are kept and reported once, by csv_commit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_CSV_H
#define PPSCAT_CLI_CSV_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "number.h"

typedef struct {
    FILE *file;
    const char *path; /* NULL for standard output */
    char *part;       /* what is written until the end; NULL when written in place */
    int error;        /* errno of the first failure */
    bool row_begun;
} csv_file;

enum { CSV_NUMBER_SIZE = NUMBER_SIZE };

#define CSV_EMPTY ((double)NAN) /* the number that is an empty field */

/* The shortest decimal text that reads back as x: "0.1", "1e-05", "inf"; "" for NAN,
 * the empty field. Returns its length. */
size_t csv_format(double x, char text[CSV_NUMBER_SIZE]);

/* Open FILE.part beside path, or standard output for NULL. Something that exists and is
 * no regular file (/dev/null, a pipe) is written in place. CLI_USAGE where path cannot
 * be written. */
int csv_open(csv_file *csv, const char *path);

void csv_text(csv_file *csv, const char *text);     /* quoted where it must be */
void csv_number(csv_file *csv, double x);           /* NAN is an empty field */
void csv_fields(csv_file *csv, const char *fields); /* fields already put together */
void csv_end_row(csv_file *csv);

/* Whether a write has failed: no use going on. */
bool csv_broken(const csv_file *csv);

/* Hand everything to the system; a failure is reported. FILE.part stays as it is. */
int csv_finish(csv_file *csv);

/* Give FILE.part its name; a failure is reported. */
int csv_publish(csv_file *csv);

/* Close, and remove FILE.part if it is still there. */
void csv_close(csv_file *csv);

#endif
