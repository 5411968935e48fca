/* The embedded species and scenes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/builtin.h"

#include <stdio.h>
#include <string.h>

#include "tree/problem.h"

const pps_builtin pps_builtin_species[] = {
#include "builtin_species.inc"
    {NULL, NULL}};

const pps_builtin pps_builtin_scenes[] = {
#include "builtin_scenes.inc"
    {NULL, NULL}};

const char *pps_builtin_find(const pps_builtin *table, const char *name) {
    for (; table->name; table++) {
        if (strcmp(table->name, name) == 0) {
            return table->text;
        }
    }
    return NULL;
}

pps_status pps_builtin_missing(const pps_builtin *table, const char *kind,
                               const char *name, pps_problem *problem) {
    char all[300] = "";
    size_t at = 0;
    for (const pps_builtin *row = table; row->name && at < sizeof all; row++) {
        at += (size_t)snprintf(all + at, sizeof all - at, "%s, ", row->name);
    }
    return pps_complain(problem, PPS_ERR_ARGUMENT,
                        "no %s '%.60s'; there are %sand files ending in .json", kind,
                        name, all);
}
