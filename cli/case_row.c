/* The columns that every slab subcommand's rows begin with.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "case_row.h"

#include <stdio.h>
void case_row(char text[CASE_ROW_SIZE], const pps_method *method,
              const sweep_case *at) {
    char albedo[CSV_NUMBER_SIZE], g[CSV_NUMBER_SIZE], thickness[CSV_NUMBER_SIZE];
    char mu0[CSV_NUMBER_SIZE];

    csv_format(at->albedo, albedo);
    csv_format(at->g, g);
    csv_format(at->thickness, thickness);
    csv_format(at->mu0, mu0);
    snprintf(text, CASE_ROW_SIZE, "%s,%s,%s,%s,%s", method->name, albedo, g, thickness,
             mu0);
}
