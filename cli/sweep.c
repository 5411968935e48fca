/* The engine: threads take tiles, the caller collects them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "sweep.h"

#include <stdlib.h>

#include "cli.h"
#include "progress.h"
#include "system.h"
#include "team.h"

static const double patience = 0.05;      /* seconds between looks at signals */
static const double team_patience = 5e-4; /* ... at the other ranks */
static const double last_wait = 0.5;      /* for threads when a signal has come */

typedef struct sweep {
    const sweep_task *task;
    const sweep_plan *plan;
    queue queue;
    progress_meter progress;
    size_t n_threads;
    pthread_t *thread;
    atomic_size_t n_working;
} sweep;

/* ---- a thread at work ---- */

static int open_station(sweep_station *own, const sweep_task *task,
                        const sweep_plan *plan) {
    *own = (sweep_station){.task = task, .plan = plan, .medium = UINT64_MAX};
    own->n_workers = task->reference ? task->grid->n_methods + 1 : 1;
    own->workers = calloc(own->n_workers, sizeof *own->workers);
    own->values =
        malloc(((size_t)plan->unit_rows * task->n_values + 1) * sizeof *own->values);
    return own->workers && own->values ? CLI_DONE : cli_no_memory();
}

static void close_station(sweep_station *own) {
    for (size_t i = 0; own->workers && i < own->n_workers; i++)
        pps_model_free(own->workers[i].model);
    free(own->workers);
    free(own->values);
}

static const pps_method *method_of(const sweep_station *own, const sweep_unit *unit,
                                   size_t i) {
    const case_grid *grid = own->task->grid;

    if (unit->method)
        return unit->method;
    return i < grid->n_methods ? grid->method[i] : own->task->reference;
}

/* Make the models of the unit's medium, unless they are there. */
static int enter_medium(sweep_station *own, const sweep_unit *unit) {
    pps_slab slab = {unit->albedo, unit->g, own->task->grid->thickness.value[0]};
    int rc = CLI_DONE;

    if (own->medium == unit->medium)
        return CLI_DONE;
    own->medium = unit->medium;
    for (size_t i = 0; i < own->n_workers && rc == CLI_DONE; i++) {
        sweep_worker *worker = &own->workers[i];
        pps_model_free(worker->model);
        *worker = (sweep_worker){.method = method_of(own, unit, i)};
        rc = sweep_judge(pps_model_create(worker->method, &slab,
                                          &own->task->grid->options, &worker->model),
                         &worker->refusal);
    }
    return rc;
}

static int compute_tile(void *station, sweep_tile *t) {
    sweep_station *own = station;
    int rc = CLI_DONE;

    for (uint64_t i = t->first; i < t->first + t->n && rc == CLI_DONE; i++) {
        sweep_unit unit = plan_unit(own->plan, i);
        if (own->of && queue_stopped(&own->of->queue))
            return CLI_FAILED;
        rc = enter_medium(own, &unit);
        if (rc == CLI_DONE)
            rc = own->task->evaluate(own, &unit, own->values, t);
        if (own->of && queue_stopped(&own->of->queue))
            return CLI_FAILED; /* not all of the unit is done */
        if (rc == CLI_DONE)
            rc = own->task->render(own, &unit, own->values, t);
        t->cases += unit.mu0.n;
    }
    return rc;
}

static void *work(void *argument) {
    sweep *s = argument;
    sweep_station own;
    int rc = open_station(&own, s->task, s->plan);
    sweep_tile *t;

    own.of = s;
    if (rc != CLI_DONE)
        queue_stop(&s->queue, rc);
    while ((t = queue_take(&s->queue)))
        queue_put(&s->queue, t, compute_tile(&own, t));
    close_station(&own);
    atomic_fetch_sub(&s->n_working, 1);
    return NULL;
}

bool sweep_go_on(const sweep_station *own) {
    if (!own->of)
        return true;
    progress_count(&own->of->progress, 1);
    return !queue_stopped(&own->of->queue);
}

/* ---- the collector ---- */

static int start_threads(sweep *s) {
    s->thread = calloc(s->n_threads, sizeof *s->thread);
    if (!s->thread)
        return cli_no_memory();
    system_shield(true); /* signals come to the collector */
    for (size_t i = 0; i < s->n_threads; i++) {
        atomic_fetch_add(&s->n_working, 1);
        if (pthread_create(&s->thread[i], NULL, work, s) != 0) {
            atomic_fetch_sub(&s->n_working, 1);
            s->n_threads = i;
        }
    }
    system_shield(false);
    return s->n_threads ? CLI_DONE : cli_failed("no thread can be started");
}

/* All that is ready, in order. */
static int deliver_ready(sweep *s, double wait, sweep_sink *deliver, void *context) {
    int rc = CLI_DONE;
    sweep_tile *t = queue_collect(&s->queue, wait);

    while (t && rc == CLI_DONE) {
        rc = deliver(context, t);
        queue_release(&s->queue, t);
        t = rc == CLI_DONE ? queue_collect(&s->queue, 0) : NULL;
    }
    return rc;
}

/* Returns how delivering went. */
static int collect(sweep *s, bool alone, sweep_sink *deliver, void *context) {
    bool team = !alone && team_size() > 1;
    int rc = CLI_DONE;

    while (rc == CLI_DONE && !queue_finished(&s->queue) && !queue_stopped(&s->queue)) {
        rc = deliver_ready(s, team ? team_patience : patience, deliver, context);
        if (team)
            progress_count(&s->progress, team_serve(&s->queue));
        progress_show(&s->progress);
        if (rc != CLI_DONE || system_signal())
            queue_stop(&s->queue, CLI_FAILED);
    }
    return rc == CLI_DONE ? deliver_ready(s, 0, deliver, context) : rc;
}

/* Let threads end; false when, after a signal, one is too deep in a case to wait for. */
static bool join_threads(sweep *s) {
    double until = system_seconds() + last_wait;

    while (system_signal() && atomic_load(&s->n_working) > 0) {
        struct timespec pause = {0, 5000000};
        if (system_seconds() > until)
            return false;
        nanosleep(&pause, NULL);
    }
    for (size_t i = 0; i < s->n_threads; i++)
        pthread_join(s->thread[i], NULL);
    return true;
}

static void end(sweep *s) {
    if (!join_threads(s))
        return; /* what they use stays; the process is about to end */
    queue_free(&s->queue);
    free(s->thread);
    free(s);
}

int sweep_run(const sweep_task *task, const sweep_plan *plan, uint64_t first_unit,
              bool alone, sweep_sink *deliver, void *context) {
    sweep *s = calloc(1, sizeof *s);
    size_t helpers = alone ? 0 : (size_t)team_size() - 1;
    int rc;

    if (!s)
        return cli_no_memory();
    s->task = task;
    s->plan = plan;
    s->n_threads = (size_t)task->grid->threads;
    if (s->n_threads > plan->n_units - first_unit && plan->n_units > first_unit)
        s->n_threads = (size_t)(plan->n_units - first_unit);
    rc = queue_init(&s->queue, plan, first_unit, s->n_threads + helpers);
    progress_start(&s->progress, task->grid->progress, (size_t)plan->cases);
    progress_resume(&s->progress, (size_t)((double)plan->cases * (double)first_unit /
                                           (double)plan->n_units));
    if (rc == CLI_DONE)
        rc = start_threads(s);
    if (rc == CLI_DONE)
        rc = collect(s, alone, deliver, context);
    if (rc != CLI_DONE)
        queue_stop(&s->queue, rc);
    progress_end(&s->progress);
    rc = atomic_load(&s->queue.outcome);
    end(s);
    return rc;
}

int sweep_help(const sweep_task *task, const sweep_plan *plan) {
    sweep_station own;
    int rc = open_station(&own, task, plan);

    rc = team_help(rc, compute_tile, &own);
    close_station(&own);
    return rc;
}

int sweep_judge(pps_status status, const char **refusal) {
    *refusal = status == PPS_OK ? NULL : pps_status_string(status);
    return status == PPS_ERR_MEMORY ? cli_no_memory() : CLI_DONE;
}

int sweep_solve(const sweep_worker *worker, double thickness, double mu0,
                const char **refusal) {
    *refusal = worker->refusal;
    if (worker->refusal)
        return CLI_DONE;
    return sweep_judge(pps_model_solve(worker->model, thickness, mu0), refusal);
}
