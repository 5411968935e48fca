/* ppscat methods: the library's table of methods as CSV.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include "cli.h"
#include "output.h"

static void flag(csv_file *csv, bool value) { csv_text(csv, value ? "true" : "false"); }

int cmd_methods(const invocation *call) {
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    output out;
    int rc = output_open(&out, call);

    if (rc != CLI_DONE)
        return rc;
    for (size_t i = 0; i < n && rc == CLI_DONE; i++) {
        csv_text(&out.csv, table[i]->name);
        csv_text(&out.csv, table[i]->cost);
        flag(&out.csv, table[i]->fields);
        flag(&out.csv, table[i]->fluxes);
        flag(&out.csv, table[i]->half_space);
        csv_text(&out.csv, table[i]->summary);
        csv_text(&out.csv, table[i]->limits);
        rc = output_end_row(&out, table[i], NULL);
    }
    return output_close(&out, rc);
}
