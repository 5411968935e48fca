/* ppscat error: the error of every method of the grid against `exact`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include <math.h>
#include <stdlib.h>

#include "cli.h"
#include "compare.h"
#include "sweep_file.h"

enum { ERROR_VALUES = 6 };

/* The columns of a row; NAN where it is refused. */
static int settle(const case_grid *grid, const comparison *c, double *row,
                  sweep_tile *t) {
    const double value[ERROR_VALUES] = {grid->beam * sqrt(c->mean_square),
                                        c->rms_rel,
                                        grid->beam * c->max_abs,
                                        c->reflectance_error,
                                        c->transmittance_error,
                                        c->seconds};

    t->record.rows++;
    for (size_t i = 0; i < ERROR_VALUES; i++)
        row[i] = c->refusal ? (double)NAN : value[i];
    return c->refusal ? record_refused(&t->record, c->refused_by, c->refusal, 1)
                      : CLI_DONE;
}

static int evaluate(const sweep_station *own, const sweep_unit *unit, double *values,
                    sweep_tile *t) {
    const case_grid *grid = own->task->grid;
    size_t n = unit->mu0.n * grid->n_methods;
    comparison *c = calloc(n, sizeof *c);
    int rc = c ? compare_unit(own, unit, c, t) : cli_no_memory();

    for (size_t i = 0; i < n && rc == CLI_DONE; i++)
        rc = settle(grid, &c[i], values + i * ERROR_VALUES, t);
    free(c);
    return rc;
}

int cmd_error(const invocation *call) {
    case_grid grid;
    int rc = grid_init(&grid, call, GRID_ERROR);
    sweep_task task = {.grid = &grid,
                       .reference = pps_method_find("exact"),
                       .shape = ROWS_CASE,
                       .n_values = grid.n_methods * ERROR_VALUES,
                       .evaluate = evaluate};

    if (rc == CLI_DONE)
        rc = sweep_file(call, &task);
    grid_free(&grid);
    return rc;
}
