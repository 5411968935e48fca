/* The engine under `field`, `flux` and `error`: cases in, answers out in order.
 *
 * The slow parameters are outside: a tile is one (method, albedo, g), or one
 * (albedo, g) with all methods together; it owns one model a method and visits every
 * thickness and every mu0 with it. Threads share the tiles; the order of the answers
 * and every bit of them depend on the grid alone.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_SWEEP_H
#define PPSCAT_CLI_SWEEP_H

#include "grid.h"

/* A method at work on a tile. */
typedef struct {
    const pps_method *method;
    pps_model *model;
    const char *refusal; /* why there is no model; NULL when there is */
} sweep_worker;

/* One case of a tile. */
typedef struct {
    double albedo, g, thickness, mu0;
    const depth_list *depth;
    size_t index; /* of the case in its order: [method,] albedo, g, thickness, mu0 */
} sweep_case;

/* What to do with every case. `evaluate` runs on any thread and fills a block of
 * block_size bytes; `emit` gets the blocks one at a time, in order. Both return
 * CLI_DONE or CLI_FAILED, which ends the sweep. */
typedef struct sweep_task {
    const case_grid *grid;
    const pps_method *reference; /* when not NULL: all methods together, then this */
    size_t block_size;
    int (*evaluate)(const struct sweep_task *task, const sweep_worker *workers,
                    const sweep_case *at, void *block);
    int (*emit)(const struct sweep_task *task, const sweep_worker *workers,
                const sweep_case *at, const void *block);
    void *context;
} sweep_task;

int sweep_run(const sweep_task *task);

/* Solve a case with one worker. *refusal is NULL, or static text that says why the
 * method cannot do it. CLI_FAILED without memory. */
int sweep_solve(const sweep_worker *worker, const sweep_case *at, const char **refusal);

/* The same distinction for any status of the library. */
int sweep_judge(pps_status status, const char **refusal);

#endif
