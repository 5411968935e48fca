/* What a run did: rows, refusals and why, and what the methods used.
 *
 * Records of parts of a run add up to that of the whole, in any grouping.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_RECORD_H
#define PPSCAT_CLI_RECORD_H

#include <stdbool.h>
#include <stdint.h>

#include <ppscat/ppscat.h>

/* How often a method used a setting. */
typedef struct {
    const pps_method *method;
    int streams;
    pps_nodes nodes;
    bool delta_m;
    uint64_t outputs;
} used_count;

/* Rows that one method refused for one reason; NULL: what the reason itself names. */
typedef struct {
    const pps_method *method;
    char *reason;
    uint64_t rows;
} refused_count;

/* All zero to begin with. */
typedef struct {
    uint64_t rows, refused_rows;
    size_t n_used;
    used_count *used;
    int min_orders, max_orders;
    double worst_error; /* largest error estimate; 0 where there is none */
    bool estimated;
    size_t n_refused;
    refused_count *refused;
} record;

/* Functions that can fail return CLI_FAILED without memory. */

/* Add what one output used; methods without streams leave no trace. What `auto` picked
 * counts as itself. */
int record_used(record *r, const pps_method *method, const pps_info *info);

/* Count rows that the method, or NULL, refused; they are not added to r->rows. */
int record_refused(record *r, const pps_method *method, const char *reason,
                   uint64_t rows);

int record_add(record *r, const record *more);

/* Say on standard error which method refused how many rows, and why. */
void record_report(const record *r);

/* As JSON text to be freed, and back; NULL and CLI_FAILED where it is none. */
char *record_write(const record *r);
int record_read(record *r, const char *text);

void record_free(record *r);

#endif
