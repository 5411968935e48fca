/* The engine under `field`, `flux` and `error`: units of the grid in, their rows out in
 * order.
 *
 * Threads take tiles of units from a queue (queue.h), each with models of its own; the
 * thread that called collects the tiles in order. Under mpirun other ranks take tiles,
 * too (team.h). The order of the rows and every bit of them depend on the grid alone.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_SWEEP_H
#define PPSCAT_CLI_SWEEP_H

#include "grid.h"
#include "plan.h"
#include "queue.h"

/* A case, for those who look at one at a time. */
typedef struct {
    double albedo, g, thickness, mu0;
    const depth_list *depth;
    size_t index;
} sweep_case;

/* A method at work on a medium: (method, albedo, g). */
typedef struct {
    const pps_method *method;
    pps_model *model;
    const char *refusal; /* why there is no model; NULL when there is */
} sweep_worker;

typedef struct sweep_task sweep_task;

/* What a thread works with. */
typedef struct {
    const sweep_task *task;
    const sweep_plan *plan;
    sweep_worker
        *workers; /* of the unit's method; all of the grid, then the reference */
    size_t n_workers;
    uint64_t medium;  /* theirs */
    double *values;   /* of a unit: [row * n_values + i] */
    struct sweep *of; /* NULL in another rank */
} sweep_station;

/* What to do with a unit. `evaluate` runs on any thread and fills `values`, in the order
 * of the rows, NAN where a value is refused; t takes the record and the notes. `render`
 * appends what the values are in the file to t->bytes. Both return CLI_DONE or
 * CLI_FAILED, which ends the sweep. */
struct sweep_task {
    const case_grid *grid;
    const pps_method *reference; /* of ROWS_CASE */
    row_shape shape;
    size_t n_values; /* of a row; ROWS_CASE: of a case, all methods together */
    int (*evaluate)(const sweep_station *own, const sweep_unit *unit, double *values,
                    sweep_tile *t);
    int (*render)(const sweep_station *own, const sweep_unit *unit,
                  const double *values, sweep_tile *t);
    void *context;
    bool explain; /* note what `auto` picked */
};

/* Gets the tiles in order, on the thread that called. */
typedef int sweep_sink(void *context, const sweep_tile *t);

/* Sweep from a unit on. CLI_FAILED when anything went wrong, or a signal came, which
 * system_signal tells; all tiles before the first failure have been delivered then. With
 * `alone`, other ranks do not help. */
int sweep_run(const sweep_task *task, const sweep_plan *plan, uint64_t first_unit,
              bool alone, sweep_sink *deliver, void *context);

/* In a rank other than 0: work for rank 0 until it needs no more. */
int sweep_help(const sweep_task *task, const sweep_plan *plan);

/* One more case of the unit is done; false where the rest is of no use any more. */
bool sweep_go_on(const sweep_station *own);

/* Solve a case with one worker. *refusal is NULL, or static text that says why the
 * method cannot do it. CLI_FAILED without memory. */
int sweep_solve(const sweep_worker *worker, double thickness, double mu0,
                const char **refusal);

/* The same distinction for any status of the library. */
int sweep_judge(pps_status status, const char **refusal);

#endif
