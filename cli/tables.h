/* The tables of `ppscat table`: each takes the command line and returns the exit code.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TABLES_H
#define PPSCAT_CLI_TABLES_H

#include "options.h"

int table_1(const invocation *call); /* table_slab.c */
int table_2(const invocation *call);
int table_3(const invocation *call); /* table_crown.c */
int table_crowns(const invocation *call);
int table_figure7(const invocation *call); /* table_leaf.c */
int table_fps(const invocation *call);

#endif
