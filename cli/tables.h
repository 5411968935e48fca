/* The tables of `ppscat table`: each takes the command line, of which it was checked that
 * its options are for this table, and returns the exit code.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TABLES_H
#define PPSCAT_CLI_TABLES_H

#include "options.h"
#include "output.h"

/* A row of any of them; the columns are described in columns.c. */
typedef struct {
    const char *table, *row, *column, *method;
    double paper, ours, rms_rel, ratio, spread, seconds_per_cell, rms_leaf,
        seconds_per_leaf;         /* or CSV_EMPTY */
    const pps_method *refused_by; /* NULL where no method is to blame */
    const char *refusal;          /* static text; NULL: not refused */
} table_row;

/* A row without numbers. */
table_row table_blank(const char *table, const char *row, const char *column,
                      const char *method); /* cmd_table.c */
int table_write(output *out, const table_row *row);

int table_1(const invocation *call); /* table_slab.c */
int table_2(const invocation *call);
int table_3(const invocation *call); /* table_crown.c */
int table_crowns(const invocation *call);
int table_4(const invocation *call); /* table_system.c */
int table_5(const invocation *call);
int table_figure7(const invocation *call); /* table_leaf.c */
int table_fps(const invocation *call);     /* table_fps.c */

#endif
