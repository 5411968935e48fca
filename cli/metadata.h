/* The sidecar FILE-metadata.json: what a CSV file holds and how it was made.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_METADATA_H
#define PPSCAT_CLI_METADATA_H

#include <ppscat/ppscat.h>

#include "options.h"

/* How often a method used a setting. */
typedef struct {
    const pps_method *method;
    int streams;
    pps_nodes nodes;
    bool delta_m;
    size_t outputs;
} used_count;

/* What the methods used over a run; all zero to begin with. */
typedef struct {
    size_t n;
    used_count *count;
    int min_orders, max_orders;
    double worst_error; /* largest error estimate; 0 where there is none */
    bool estimated;
} used_log;

/* Add what one output used; methods without streams leave no trace. */
int used_add(used_log *log, const pps_method *method, const pps_info *info);

void used_free(used_log *log);

/* Write the sidecar of csv_path, complete or not at all: W3C "CSV on the Web", with the
 * version, the command line, the date and what was used under `notes`. */
int metadata_write(const char *csv_path, const invocation *call, const used_log *used,
                   size_t rows, size_t refused_rows);

#endif
