/* ppscat tree models: the library's table of light models, and the references, as CSV.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>

#include "cli.h"
#include "commands.h"
#include "output.h"
#include "tree_answer.h"

static void components(csv_file *csv, unsigned sources) {
    char text[80] = "";
    size_t used = 0;

    for (size_t i = 1; i < TREE_COMPONENTS; i++) {
        if (tree_components[i].sources & sources)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                     used ? " " : "", tree_components[i].name);
    }
    csv_text(csv, text);
}

int cmd_tree_models(const invocation *call) {
    output out;
    int rc = output_open(&out, call);

    if (rc != CLI_DONE)
        return rc;
    for (size_t i = 0; i < tree_method_count() && rc == CLI_DONE; i++) {
        tree_method method = tree_method_at(i);
        csv_text(&out.csv, method.name);
        components(&out.csv, method.sources);
        csv_text(&out.csv, method.compensates ? "true" : "false");
        csv_text(&out.csv, method.summary);
        csv_text(&out.csv, method.source);
        rc = output_end_row(&out, NULL, NULL);
    }
    return output_close(&out, rc);
}
