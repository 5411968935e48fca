/* ppscat field: the diffuse radiance at every depth, mu and phi of every case.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "commands.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "case_row.h"
#include "cli.h"
#include "output.h"
#include "sweep.h"

/* The answer to a case: this, then radiance[(k * n_mu + j) * n_phi + i]. */
typedef struct {
    const char *refusal;
    pps_info info;
    double radiance[];
} field_block;

/* The directions of all rows as text: "mu,phi". */
typedef struct {
    output out;
    char (*direction)[2 * CSV_NUMBER_SIZE];
} field_job;

static int evaluate(const sweep_task *task, const sweep_worker *workers,
                    const sweep_case *at, void *block) {
    field_block *answer = block;
    const case_grid *grid = task->grid;
    pps_grid where = {at->depth->n,   grid->mu.n,     grid->phi.n,
                      at->depth->tau, grid->mu.value, grid->phi.value};
    int rc = sweep_solve(workers, at, &answer->refusal);

    if (rc != CLI_DONE || answer->refusal)
        return rc;
    if (!workers->method->fields) {
        answer->refusal = "the method gives fluxes only, no radiance";
        return CLI_DONE;
    }
    rc = sweep_judge(pps_model_radiance(workers->model, &where, answer->radiance),
                     &answer->refusal);
    if (rc == CLI_DONE && !answer->refusal)
        pps_model_query(workers->model, &answer->info);
    return rc;
}

/* One row; a value that is no finite number is refused like any other. */
static int write_row(field_job *job, const pps_method *method, const char *refusal,
                     double radiance) {
    if (!refusal && !isfinite(radiance))
        refusal = "the result is not a finite number";
    csv_number(&job->out.csv, refusal ? CSV_EMPTY : radiance);
    return output_end_row(&job->out, method, refusal);
}

static int emit(const sweep_task *task, const sweep_worker *workers,
                const sweep_case *at, const void *block) {
    const field_block *answer = block;
    field_job *job = task->context;
    size_t n_directions = task->grid->mu.n * task->grid->phi.n;
    char medium[CASE_ROW_SIZE], depth[CSV_NUMBER_SIZE];
    int rc = CLI_DONE;

    if (!answer->refusal)
        rc = output_used(&job->out, workers->method, &answer->info);
    if (!answer->refusal && option_given(job->out.call, OPT_EXPLAIN))
        case_explain(at, &answer->info);
    case_row(medium, workers->method, at);
    for (size_t k = 0; k < at->depth->n; k++) {
        csv_format(at->depth->tau[k], depth);
        for (size_t i = 0; i < n_directions && rc == CLI_DONE; i++) {
            double x =
                answer->refusal ? CSV_EMPTY : answer->radiance[k * n_directions + i];
            csv_fields(&job->out.csv, medium);
            csv_fields(&job->out.csv, depth);
            csv_fields(&job->out.csv, job->direction[i]);
            rc = write_row(job, workers->method, answer->refusal, task->grid->beam * x);
        }
    }
    return rc;
}

static int format_directions(field_job *job, const case_grid *grid) {
    job->direction = malloc(grid->mu.n * grid->phi.n * sizeof *job->direction);
    if (!job->direction)
        return cli_no_memory();
    for (size_t j = 0; j < grid->mu.n; j++) {
        for (size_t i = 0; i < grid->phi.n; i++) {
            char *text = job->direction[j * grid->phi.n + i];
            size_t length = csv_format(grid->mu.value[j], text);
            text[length] = ',';
            csv_format(grid->phi.value[i], text + length + 1);
        }
    }
    return CLI_DONE;
}

static int run(const case_grid *grid, const invocation *call) {
    field_job job = {0};
    size_t n_values = grid->max_depths * grid->mu.n * grid->phi.n;
    sweep_task task = {.grid = grid,
                       .block_size = sizeof(field_block) + n_values * sizeof(double),
                       .evaluate = evaluate,
                       .emit = emit,
                       .context = &job};
    int rc = output_open(&job.out, call);

    if (rc != CLI_DONE)
        return rc;
    rc = format_directions(&job, grid);
    if (rc == CLI_DONE)
        rc = sweep_run(&task);
    free(job.direction);
    return output_close(&job.out, rc);
}

int cmd_field(const invocation *call) {
    case_grid grid;
    int rc = grid_init(&grid, call, GRID_FIELD);

    if (rc == CLI_DONE)
        rc = run(&grid, call);
    grid_free(&grid);
    return rc;
}
