/* The columns that every slab subcommand's rows begin with.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "case_row.h"

#include <stdio.h>

#include "cli.h"

void case_row(char text[CASE_ROW_SIZE], const pps_method *method,
              const sweep_case *at) {
    char albedo[CSV_NUMBER_SIZE], g[CSV_NUMBER_SIZE], thickness[CSV_NUMBER_SIZE];
    char mu0[CSV_NUMBER_SIZE];

    csv_format(at->albedo, albedo);
    csv_format(at->g, g);
    csv_format(at->thickness, thickness);
    csv_format(at->mu0, mu0);
    snprintf(text, CASE_ROW_SIZE, "%s,%s,%s,%s,%s", method->name, albedo, g, thickness,
             mu0);
}

void case_explain(const sweep_case *at, const pps_info *info) {
    char streams[32] = "";
    if (!info->used)
        return;
    if (info->streams > 0)
        snprintf(streams, sizeof streams, ", %d streams", info->streams);
    cli_note("auto: albedo %g, g %g, thickness %g, mu0 %g: %s%s, error %s %.1e",
             at->albedo, at->g, at->thickness, at->mu0, info->used->name, streams,
             info->by_table ? "by the table at most" : "by its own estimate",
             info->error_estimate);
}
