/* ppscat table N: tables of the two papers, the printed figure beside ours.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "tables.h"

static const struct {
    const char *name;
    int (*run)(const invocation *call);
} tables[] = {
    {"1", table_1},     {"2", table_2},
    {"3", table_3},     {"figure7", table_figure7},
    {"fps", table_fps}, {"crowns", table_crowns},
};
enum { N_TABLES = sizeof tables / sizeof tables[0] };

int cmd_table(const invocation *call) {
    char all[80] = "";
    size_t used = 0;

    for (size_t i = 0; i < N_TABLES; i++) {
        if (call->operand && strcmp(tables[i].name, call->operand) == 0)
            return tables[i].run(call);
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "",
                                 tables[i].name);
    }
    return cli_usage("table: no table '%.60s'; allowed: %s",
                     call->operand ? call->operand : "", all);
}
