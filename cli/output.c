/* What a short run leaves: a CSV file or standard output, its sidecar, and the refused rows.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "output.h"

#include <errno.h>
#include <libgen.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "columns.h"

int output_open(output *out, const invocation *call) {
    const char *path = option_given(call, OPT_OUTPUT) ? call->text[OPT_OUTPUT] : NULL;
    int rc;

    *out = (output){.call = call};
    rc = csv_open(&out->csv, path);
    if (rc != CLI_DONE)
        return rc;
    for (const column *c = columns_of(call->subcommand); c->name; c++)
        csv_text(&out->csv, c->name);
    csv_end_row(&out->csv);
    return CLI_DONE;
}

int output_end_row(output *out, const pps_method *method, const char *reason) {
    csv_end_row(&out->csv);
    out->record.rows++;
    if (csv_broken(&out->csv))
        return CLI_FAILED; /* csv_finish says why */
    return reason ? record_refused(&out->record, method, reason, 1) : CLI_DONE;
}

int output_used(output *out, const pps_method *method, const pps_info *info) {
    return record_used(&out->record, method, info);
}

/* The file is complete: describe it, then let it appear. */
static int publish(output *out) {
    int rc = csv_finish(&out->csv);

    if (rc == CLI_DONE && out->csv.part)
        rc = metadata_write(out->csv.path, out->call, &out->record);
    return rc == CLI_DONE ? csv_publish(&out->csv) : rc;
}

int output_close(output *out, int rc) {
    record_report(&out->record);
    if (rc == CLI_DONE)
        rc = publish(out);
    else if (csv_broken(&out->csv))
        csv_finish(&out->csv);
    if (rc == CLI_DONE && out->record.refused_rows)
        rc = CLI_REFUSED;
    csv_close(&out->csv);
    record_free(&out->record);
    return rc;
}

int output_writable(const char *path) {
    char *folder = malloc(strlen(path) + 1);
    bool good;

    if (!folder)
        return cli_no_memory();
    good = access(dirname(strcpy(folder, path)), W_OK) == 0;
    free(folder);
    return good ? CLI_DONE
                : cli_usage("--output: cannot write '%.200s': %s", path,
                            strerror(errno));
}
