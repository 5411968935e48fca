/* The columns that every slab subcommand's rows begin with.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_CASE_ROW_H
#define PPSCAT_CLI_CASE_ROW_H

#include "csv.h"
#include "sweep.h"

enum { CASE_ROW_SIZE = 320 };

/* "method,albedo,g,thickness,mu0" as fields. */
void case_row(char text[CASE_ROW_SIZE], const pps_method *method, const sweep_case *at);

#endif
