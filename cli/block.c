/* What a method answers to a unit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "block.h"

#include <math.h>
#include <stdio.h>

#include "cli.h"

int block_radiance(const sweep_station *own, const sweep_worker *worker,
                   const sweep_unit *unit, double *radiance, block_answer *answer) {
    pps_grid where = {unit->depth.n,     unit->mu.n,     unit->phi.n,
                      unit->depth.value, unit->mu.value, unit->phi.value};
    size_t n = where.n_tau * where.n_mu * where.n_phi;
    int rc = CLI_DONE;

    for (size_t b = 0; b < unit->mu0.n && rc == CLI_DONE; b++) {
        block_answer *a = &answer[b];
        rc = sweep_solve(worker, unit->thickness, unit->mu0.value[b], &a->refusal);
        if (rc == CLI_DONE && !a->refusal && !worker->method->fields)
            a->refusal = "the method gives fluxes only, no radiance";
        if (rc == CLI_DONE && !a->refusal)
            rc =
                sweep_judge(pps_model_radiance(worker->model, &where, radiance + b * n),
                            &a->refusal);
        if (rc == CLI_DONE && !a->refusal)
            pps_model_query(worker->model, &a->info);
        if (!sweep_go_on(own))
            return CLI_FAILED;
    }
    return rc;
}

int block_flux(const sweep_station *own, const sweep_worker *worker,
               const sweep_unit *unit, pps_flux *flux, block_answer *answer) {
    size_t n = unit->depth.n;
    int rc = CLI_DONE;

    for (size_t b = 0; b < unit->mu0.n && rc == CLI_DONE; b++) {
        block_answer *a = &answer[b];
        rc = sweep_solve(worker, unit->thickness, unit->mu0.value[b], &a->refusal);
        if (rc == CLI_DONE && !a->refusal && !worker->method->fluxes)
            a->refusal = "the method gives no fluxes";
        if (rc == CLI_DONE && !a->refusal)
            rc = sweep_judge(
                pps_model_flux(worker->model, n, unit->depth.value, flux + b * n),
                &a->refusal);
        if (rc == CLI_DONE && !a->refusal)
            pps_model_query(worker->model, &a->info);
        if (!sweep_go_on(own))
            return CLI_FAILED;
    }
    return rc;
}

/* What method `auto` picked, and why, as a line of the notes; nothing for the others. */
static int explain(const sweep_unit *unit, double mu0, const pps_info *info,
                   buffer *notes) {
    char line[320], streams[32] = "";
    int length;

    if (!info->used)
        return CLI_DONE;
    if (info->streams > 0)
        snprintf(streams, sizeof streams, ", %d streams", info->streams);
    length = snprintf(
        line, sizeof line,
        "ppscat: auto: albedo %g, g %g, thickness %g, mu0 %g: %s%s, error %s %.1e\n",
        unit->albedo, unit->g, unit->thickness, mu0, info->used->name, streams,
        info->by_table ? "by the table at most" : "by its own estimate",
        info->error_estimate);
    return buffer_append(notes, line, (size_t)length);
}

static void erase(double *row, size_t n) {
    for (size_t i = 0; i < n; i++)
        row[i] = (double)NAN;
}

/* Scale a row; false, and the row erased, where a value is no finite number. */
static bool scale(double *row, size_t n, double beam) {
    bool finite = true;

    for (size_t i = 0; i < n; i++) {
        row[i] *= beam;
        finite &= isfinite(row[i]) != 0;
    }
    if (!finite)
        erase(row, n);
    return finite;
}

/* The rows of one mu0 that was answered. */
static int settle_rows(const sweep_station *own, const sweep_worker *worker,
                       size_t per_row, size_t n_values, double *values, sweep_tile *t) {
    uint64_t bad = 0;

    for (size_t i = 0; i < n_values; i += per_row)
        bad += !scale(values + i, per_row, own->task->grid->beam);
    return bad ? record_refused(&t->record, worker->method,
                                "the result is not a finite number", bad)
               : CLI_DONE;
}

int block_settle(const sweep_station *own, const sweep_worker *worker,
                 const sweep_unit *unit, const block_answer *answer, size_t per_row,
                 size_t n_values, double *values, sweep_tile *t) {
    int rc = CLI_DONE;

    for (size_t b = 0; b < unit->mu0.n && rc == CLI_DONE; b++, values += n_values) {
        const block_answer *a = &answer[b];
        t->record.rows += n_values / per_row;
        if (a->refusal) {
            erase(values, n_values);
            rc = record_refused(&t->record, worker->method, a->refusal,
                                n_values / per_row);
            continue;
        }
        rc = record_used(&t->record, worker->method, &a->info);
        if (rc == CLI_DONE && own->task->explain)
            rc = explain(unit, unit->mu0.value[b], &a->info, &t->notes);
        if (rc == CLI_DONE)
            rc = settle_rows(own, worker, per_row, n_values, values, t);
    }
    return rc;
}
