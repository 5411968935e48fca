/* The columns that each subcommand prints; header rows, sidecars and --help use them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_COLUMNS_H
#define PPSCAT_CLI_COLUMNS_H

#include "options.h"

typedef struct {
    const char *name;
    const char *datatype; /* of CSV on the Web: string, double, boolean, integer */
    const char *unit;     /* "1" where there is none; NULL for text */
    const char *description;
} column;

/* The columns of a subcommand, ended by one without a name. */
const column *columns_of(subcommand_id subcommand);

#endif
