/* Reading a list of names, such as methods, against a table of those there are.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_NAMES_H
#define PPSCAT_CLI_NAMES_H

#include <stddef.h>

#include "options.h"

enum { NAMES_MAX = 64 }; /* in a table */

/* Names that were chosen, by their places in the table. */
typedef struct {
    size_t n, index[NAMES_MAX];
} name_list;

typedef struct {
    const char *kind; /* of names: "method" */
    size_t n;
    const char *(*name)(size_t i);
} name_table;

/* Read the option's list. A name that is none of the table's, or there twice, is
 * CLI_USAGE with a message. */
int names_read(const invocation *call, option_id id, const name_table *table,
               name_list *out);

#endif
