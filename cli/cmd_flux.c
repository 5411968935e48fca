/* ppscat flux: fluxes and mean intensities at every depth of every case.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include "block.h"
#include "cli.h"
#include "sweep_file.h"

enum {
    FLUX_VALUES = sizeof(pps_flux) / sizeof(double) /* the columns, in their order */
};

static int evaluate(const sweep_station *own, const sweep_unit *unit, double *values,
                    sweep_tile *t) {
    block_answer answer[UNIT_BEAMS];
    int rc = block_flux(own, own->workers, unit, (pps_flux *)values, answer);

    return rc == CLI_DONE ? block_settle(own, own->workers, unit, answer, FLUX_VALUES,
                                         unit->depth.n * FLUX_VALUES, values, t)
                          : rc;
}

int cmd_flux(const invocation *call) {
    case_grid grid;
    int rc = grid_init(&grid, call, GRID_FIELD);
    sweep_task task = {.grid = &grid,
                       .shape = ROWS_DEPTHS,
                       .n_values = FLUX_VALUES,
                       .evaluate = evaluate,
                       .explain = option_given(call, OPT_EXPLAIN)};

    if (rc == CLI_DONE)
        rc = sweep_file(call, &task);
    grid_free(&grid);
    return rc;
}
