/* Species and scenes that come with the library: the files of data/species and
 * data/scenes, embedded, so that they are found wherever it is installed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_BUILTIN_H
#define PPS_TREE_BUILTIN_H

#include <ppscat/tree/mesh.h>

typedef struct pps_builtin {
    const char *name, *text; /* "cherry", JSON; a row without a name ends the table */
} pps_builtin;

extern const pps_builtin pps_builtin_species[], pps_builtin_scenes[];

/* The text of that name; NULL: there is none. */
const char *pps_builtin_find(const pps_builtin *table, const char *name);

/* ARGUMENT: "no KIND 'NAME'; there are ..". */
pps_status pps_builtin_missing(const pps_builtin *table, const char *kind,
                               const char *name, pps_problem *problem);

#endif
