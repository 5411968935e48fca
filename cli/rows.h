/* The values of a unit as bytes: rows of CSV, or the bare numbers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_ROWS_H
#define PPSCAT_CLI_ROWS_H

#include "sweep.h"

/* Append the rows of a unit of ROWS_DEPTHS or ROWS_DIRECTIONS to t->bytes. What rows
 * share is formatted once. */
int rows_csv(const sweep_station *own, const sweep_unit *unit, const double *values,
             sweep_tile *t);

/* Append the values as they are in memory. */
int rows_values(const sweep_station *own, const sweep_unit *unit, const double *values,
                sweep_tile *t);

/* Write "method,albedo,g,thickness,"; returns the length. */
enum { MEDIUM_TEXT_SIZE = 192 };
size_t rows_medium(const sweep_unit *unit, const pps_method *method,
                   char text[MEDIUM_TEXT_SIZE]);

#endif
