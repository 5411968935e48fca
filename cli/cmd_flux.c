/* ppscat flux: fluxes and mean intensities at every depth of every case.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include <math.h>

#include "case_row.h"
#include "cli.h"
#include "output.h"
#include "sweep.h"

/* The answer to a case: this, then flux[k] at depth k. */
typedef struct {
    const char *refusal;
    pps_info info;
    pps_flux flux[];
} flux_block;

static int evaluate(const sweep_task *task, const sweep_worker *workers,
                    const sweep_case *at, void *block) {
    flux_block *answer = block;
    int rc = sweep_solve(workers, at, &answer->refusal);

    (void)task;
    if (rc != CLI_DONE || answer->refusal)
        return rc;
    if (!workers->method->fluxes) {
        answer->refusal = "the method gives no fluxes";
        return CLI_DONE;
    }
    rc = sweep_judge(
        pps_model_flux(workers->model, at->depth->n, at->depth->tau, answer->flux),
        &answer->refusal);
    if (rc == CLI_DONE && !answer->refusal)
        pps_model_query(workers->model, &answer->info);
    return rc;
}

static int write_row(output *out, const pps_method *method, const char *refusal,
                     const pps_flux *flux, double beam) {
    const double value[] = {flux->up, flux->down, flux->direct, flux->mean_diffuse,
                            flux->mean};

    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++) {
        if (!refusal && !isfinite(value[i]))
            refusal = "the result is not a finite number";
    }
    for (size_t i = 0; i < sizeof value / sizeof value[0]; i++)
        csv_number(&out->csv, refusal ? CSV_EMPTY : beam * value[i]);
    return output_end_row(out, method, refusal);
}

static int emit(const sweep_task *task, const sweep_worker *workers,
                const sweep_case *at, const void *block) {
    static const pps_flux none;
    const flux_block *answer = block;
    output *out = task->context;
    char medium[CASE_ROW_SIZE];
    int rc = CLI_DONE;

    if (!answer->refusal)
        rc = output_used(out, workers->method, &answer->info);
    if (!answer->refusal && option_given(out->call, OPT_EXPLAIN))
        case_explain(at, &answer->info);
    case_row(medium, workers->method, at);
    for (size_t k = 0; k < at->depth->n && rc == CLI_DONE; k++) {
        csv_fields(&out->csv, medium);
        csv_number(&out->csv, at->depth->tau[k]);
        rc = write_row(out, workers->method, answer->refusal,
                       answer->refusal ? &none : &answer->flux[k], task->grid->beam);
    }
    return rc;
}

static int run(const case_grid *grid, const invocation *call) {
    output out;
    sweep_task task = {.grid = grid,
                       .block_size =
                           sizeof(flux_block) + grid->max_depths * sizeof(pps_flux),
                       .evaluate = evaluate,
                       .emit = emit,
                       .context = &out};
    int rc = output_open(&out, call);

    return rc == CLI_DONE ? output_close(&out, sweep_run(&task)) : rc;
}

int cmd_flux(const invocation *call) {
    case_grid grid;
    int rc = grid_init(&grid, call, GRID_FIELD);

    if (rc == CLI_DONE)
        rc = run(&grid, call);
    grid_free(&grid);
    return rc;
}
