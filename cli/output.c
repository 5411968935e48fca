/* What a run leaves: a CSV file or standard output, its sidecar, and the refused rows.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "output.h"

#include <stdlib.h>

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

static int count_refusal(output *out, const pps_method *method, const char *reason) {
    refused_count *grown;

    out->refused_rows++;
    for (size_t i = 0; i < out->n_refusals; i++) {
        if (out->refusals[i].method == method && out->refusals[i].reason == reason) {
            out->refusals[i].rows++;
            return CLI_DONE;
        }
    }
    grown = realloc(out->refusals, (out->n_refusals + 1) * sizeof *grown);
    if (!grown)
        return cli_no_memory();
    out->refusals = grown;
    grown[out->n_refusals++] = (refused_count){method, reason, 1};
    return CLI_DONE;
}

int output_end_row(output *out, const pps_method *method, const char *reason) {
    csv_end_row(&out->csv);
    out->rows++;
    if (csv_broken(&out->csv))
        return CLI_FAILED; /* csv_finish says why */
    return reason ? count_refusal(out, method, reason) : CLI_DONE;
}

int output_used(output *out, const pps_method *method, const pps_info *info) {
    return used_add(&out->used, info->used ? info->used : method, info);
}

static void report_refusals(const output *out) {
    for (size_t i = 0; i < out->n_refusals; i++) {
        const refused_count *r = &out->refusals[i];
        cli_note("method '%s' refused %zu row%s: %s", r->method->name, r->rows,
                 r->rows == 1 ? "" : "s", r->reason);
    }
}

/* The file is complete: describe it, then let it appear. */
static int publish(output *out) {
    int rc = csv_finish(&out->csv);

    if (rc == CLI_DONE && out->csv.part)
        rc = metadata_write(out->csv.path, out->call, &out->used, out->rows,
                            out->refused_rows);
    return rc == CLI_DONE ? csv_publish(&out->csv) : rc;
}

int output_close(output *out, int rc) {
    report_refusals(out);
    if (rc == CLI_DONE)
        rc = publish(out);
    else if (csv_broken(&out->csv))
        csv_finish(&out->csv);
    if (rc == CLI_DONE && out->refused_rows)
        rc = CLI_REFUSED;
    csv_close(&out->csv);
    used_free(&out->used);
    free(out->refusals);
    return rc;
}
