/* ppscat field: the diffuse radiance at every depth, mu and phi of every case.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include "block.h"
#include "cli.h"
#include "sweep_file.h"

static int evaluate(const sweep_station *own, const sweep_unit *unit, double *values,
                    sweep_tile *t) {
    block_answer answer[UNIT_BEAMS];
    size_t n = unit->depth.n * unit->mu.n * unit->phi.n;
    int rc = block_radiance(own, own->workers, unit, values, answer);

    return rc == CLI_DONE
               ? block_settle(own, own->workers, unit, answer, 1, n, values, t)
               : rc;
}

int cmd_field(const invocation *call) {
    case_grid grid;
    int rc = grid_init(&grid, call, GRID_FIELD);
    sweep_task task = {.grid = &grid,
                       .shape = ROWS_DIRECTIONS,
                       .n_values = 1,
                       .evaluate = evaluate,
                       .explain = option_given(call, OPT_EXPLAIN)};

    if (rc == CLI_DONE)
        rc = sweep_file(call, &task);
    grid_free(&grid);
    return rc;
}
