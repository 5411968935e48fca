/* The texts of --help, made from the tables of subcommands, options and columns.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_USAGE_H
#define PPSCAT_CLI_USAGE_H

#include <stdio.h>

#include "options.h"

/* What the program is and which subcommands it has. */
void usage_program(FILE *file);

/* One subcommand: its options with their defaults, and its columns. */
void usage_subcommand(FILE *file, subcommand_id id);

#endif
