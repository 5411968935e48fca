/* What a method answers to a unit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "block.h"

#include <math.h>
#include <stdio.h>

#include "cli.h"

/* Where the answers of a unit go: radiances or fluxes. */
typedef struct {
    double *radiance; /* NULL for fluxes */
    pps_flux *flux;
} block_output;

/* Beams first .. first + n - 1 of the unit. */
static pps_status answer_beams(const sweep_worker *worker, const sweep_unit *unit,
                               size_t first, size_t n, const block_output *out,
                               block_answer *answer) {
    pps_grid at = {unit->depth.n,     unit->mu.n,     unit->phi.n,
                   unit->depth.value, unit->mu.value, unit->phi.value};
    size_t per_beam = at.n_tau * at.n_mu * at.n_phi;
    pps_status status = pps_model_solve_beams(worker->model, unit->thickness, n,
                                              unit->mu0.value + first);

    if (status == PPS_OK)
        status = out->radiance ? pps_model_radiance(worker->model, &at,
                                                    out->radiance + first * per_beam)
                               : pps_model_flux(worker->model, at.n_tau, at.tau,
                                                out->flux + first * at.n_tau);
    for (size_t b = 0; b < n && status == PPS_OK; b++)
        pps_model_query_beam(worker->model, b, &answer[first + b].info);
    return status;
}

/* All beams at once where that saves work; false where one of them is refused, or memory
 * for all is lacking. */
static bool answer_together(const sweep_station *own, const sweep_worker *worker,
                            const sweep_unit *unit, const block_output *out,
                            block_answer *answer) {
    bool shared = worker->method->shares_beams && own->task->grid->options.streams > 0;

    return shared && unit->mu0.n > 1 &&
           answer_beams(worker, unit, 0, unit->mu0.n, out, answer) == PPS_OK;
}

static int answer_unit(const sweep_station *own, const sweep_worker *worker,
                       const sweep_unit *unit, const char *refusal,
                       const block_output *out, block_answer *answer) {
    bool together = !refusal && answer_together(own, worker, unit, out, answer);
    int rc = CLI_DONE;

    for (size_t b = 0; b < unit->mu0.n && rc == CLI_DONE; b++) {
        answer[b].refusal = refusal;
        if (!refusal && !together)
            rc = sweep_judge(answer_beams(worker, unit, b, 1, out, answer),
                             &answer[b].refusal);
        if (!sweep_go_on(own))
            return CLI_FAILED;
    }
    return rc;
}

int block_radiance(const sweep_station *own, const sweep_worker *worker,
                   const sweep_unit *unit, double *radiance, block_answer *answer) {
    const char *refusal = worker->refusal;

    if (!refusal && !worker->method->fields)
        refusal = "the method gives fluxes only, no radiance";
    return answer_unit(own, worker, unit, refusal,
                       &(block_output){.radiance = radiance}, answer);
}

int block_flux(const sweep_station *own, const sweep_worker *worker,
               const sweep_unit *unit, pps_flux *flux, block_answer *answer) {
    const char *refusal = worker->refusal;

    if (!refusal && !worker->method->fluxes)
        refusal = "the method gives no fluxes";
    return answer_unit(own, worker, unit, refusal, &(block_output){.flux = flux},
                       answer);
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
