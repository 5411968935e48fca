/* What a short run leaves: a CSV file or standard output, its sidecar, and the refused
 * rows. Sweeps, which are resumed, have files of their own (sweep_file.h).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_OUTPUT_H
#define PPSCAT_CLI_OUTPUT_H

#include "csv.h"
#include "metadata.h"
#include "options.h"

typedef struct {
    csv_file csv;
    const invocation *call;
    record record;
} output;

/* Open what -o names and write the header row. CLI_USAGE where it cannot be written. */
int output_open(output *out, const invocation *call);

/* End a row; with a reason (static text), one that the method, or NULL, refused. */
int output_end_row(output *out, const pps_method *method, const char *reason);

/* Note what a method used for an output; what `auto` picked counts as itself. */
int output_used(output *out, const pps_method *method, const pps_info *info);

/* Whether a file that is no CSV could be written there, before work is done for it;
 * CLI_USAGE if not. */
int output_writable(const char *path);

/* Finish with rc, the outcome so far: report refusals, write the sidecar, name the
 * file. Returns the exit code. Nothing is left under the final name unless all went
 * well. */
int output_close(output *out, int rc);

#endif
