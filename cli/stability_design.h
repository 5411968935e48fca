/* The hard places that `stability` walks: lists of cases as texts of options.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_STABILITY_DESIGN_H
#define PPSCAT_CLI_STABILITY_DESIGN_H

#include "grid.h"

enum { MAX_BLOCKS = 10 };

/* The grids of a command line: of the lists given, or the default design's. *n of them to
 * free, in every case. */
int design_init(case_grid grid[MAX_BLOCKS], size_t *n, const invocation *call);

#endif
