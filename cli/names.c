/* Lists of names.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "names.h"

#include <stdio.h>
#include <string.h>

#include "cli.h"

enum { NAME_SIZE = 64 }; /* longer than any there is */

/* Say which names there are. */
static int refuse(option_id id, const name_table *table, const char *name) {
    const char *all_names[NAMES_MAX], *closest;
    char all[512] = "";
    size_t length = 0;

    for (size_t i = 0; i < table->n; i++) {
        all_names[i] = table->name(i);
        if (length < sizeof all)
            length += (size_t)snprintf(all + length, sizeof all - length, "%s%s",
                                       i ? ", " : "", all_names[i]);
    }
    closest = cli_closest(name, table->n, all_names);
    return cli_usage("--%s: unknown %s '%s'; %s%s%sallowed: %s", option_table[id].name,
                     table->kind, name, closest ? "did you mean '" : "",
                     closest ? closest : "", closest ? "'? " : "", all);
}

static int add(option_id id, const name_table *table, const char *name,
               name_list *out) {
    size_t found = 0;

    while (found < table->n && strcmp(table->name(found), name) != 0)
        found++;
    if (found == table->n)
        return refuse(id, table, name);
    for (size_t i = 0; i < out->n; i++) {
        if (out->index[i] == found)
            return cli_usage("--%s: '%s' is there twice; allowed: each %s once",
                             option_table[id].name, name, table->kind);
    }
    out->index[out->n++] = found;
    return CLI_DONE;
}

int names_read(const invocation *call, option_id id, const name_table *table,
               name_list *out) {
    const char *at = option_text(call, id);
    int rc = CLI_DONE;

    out->n = 0;
    for (bool more = true; more && rc == CLI_DONE; at++) {
        size_t length = strcspn(at, ",");
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "%.*s",
                 (int)(length < NAME_SIZE ? length : NAME_SIZE - 1), at);
        rc = add(id, table, name, out);
        at += length;
        more = *at == ',';
    }
    return rc;
}
