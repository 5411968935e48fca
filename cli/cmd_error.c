/* ppscat error: the error of every method of the grid against `exact`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include <math.h>
#include <stdlib.h>

#include "case_row.h"
#include "cli.h"
#include "compare.h"

static int write_row(const case_grid *grid, output *out, const sweep_case *at,
                     const pps_method *method, const comparison *c) {
    char medium[CASE_ROW_SIZE];
    const double value[] = {grid->beam * sqrt(c->mean_square),
                            c->rms_rel,
                            grid->beam * c->max_abs,
                            c->reflectance_error,
                            c->transmittance_error,
                            c->seconds};

    case_row(medium, method, at);
    csv_fields(&out->csv, medium);
    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++)
        csv_number(&out->csv, c->refusal ? CSV_EMPTY : value[i]);
    return output_end_row(out, c->refusal ? c->refused_by : method, c->refusal);
}

/* Row i of all, the last list running fastest. */
static int write_result(const case_grid *grid, output *out, size_t i,
                        const comparison *result) {
    const number_list *lists[] = {&grid->mu0, &grid->thickness, &grid->g,
                                  &grid->albedo};
    sweep_case at = {0};
    double *member[] = {&at.mu0, &at.thickness, &at.g, &at.albedo};
    size_t rest = i;

    for (size_t l = 0; l < 4; l++) {
        *member[l] = lists[l]->value[rest % lists[l]->n];
        rest /= lists[l]->n;
    }
    return write_row(grid, out, &at, grid->method[rest], &result[i]);
}

static int run(const case_grid *grid, const invocation *call) {
    output out;
    size_t n = compare_count(grid);
    comparison *result;
    int rc = output_open(&out, call);

    if (rc != CLI_DONE)
        return rc;
    result = malloc(n * sizeof *result);
    rc = result ? compare_run(grid, &out, result) : cli_no_memory();
    for (size_t i = 0; i < n && rc == CLI_DONE; i++)
        rc = write_result(grid, &out, i, result);
    free(result);
    return output_close(&out, rc);
}

int cmd_error(const invocation *call) {
    case_grid grid;
    int rc = grid_init(&grid, call, GRID_ERROR);

    if (rc == CLI_DONE)
        rc = run(&grid, call);
    grid_free(&grid);
    return rc;
}
