/* The queue of tiles.
 *
 * Everything in it is behind one lock; a tile itself belongs to who took it until it is
 * put, then to the collector.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "queue.h"

#include <stdlib.h>
#include <time.h>

#include "cli.h"
#include "system.h"

enum {
    TILE_ROWS = 1 << 14, /* some 2 MB of text */
    SLOTS_PER_WORKER = 4,
    SPARE_SLOTS = 12
};

static const size_t most_waiting = (size_t)48 << 20;    /* bytes */
static const double short_tile = 0.01, long_tile = 0.1; /* seconds */

int queue_init(queue *q, const sweep_plan *plan, uint64_t first_unit, size_t workers) {
    pthread_condattr_t monotonic;

    *q = (queue){.plan = plan, .next_unit = first_unit, .tile_units = 1};
    q->n_slots = SLOTS_PER_WORKER * workers + SPARE_SLOTS;
    pthread_mutex_init(&q->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&q->filled, &monotonic);
    pthread_cond_init(&q->emptied, &monotonic);
    pthread_condattr_destroy(&monotonic);
    q->slot = calloc(q->n_slots, sizeof *q->slot);
    return q->slot ? CLI_DONE : cli_no_memory();
}

void queue_free(queue *q) {
    for (size_t i = 0; q->slot && i < q->n_slots; i++) {
        buffer_free(&q->slot[i].bytes);
        buffer_free(&q->slot[i].notes);
        record_free(&q->slot[i].record);
    }
    free(q->slot);
    pthread_cond_destroy(&q->filled);
    pthread_cond_destroy(&q->emptied);
    pthread_mutex_destroy(&q->lock);
}

bool queue_stopped(const queue *q) { return atomic_load(&q->stopped); }

void queue_stop(queue *q, int rc) {
    int none = CLI_DONE;

    atomic_compare_exchange_strong(&q->outcome, &none, rc);
    atomic_store(&q->stopped, true);
    pthread_mutex_lock(&q->lock);
    pthread_cond_broadcast(&q->filled);
    pthread_cond_broadcast(&q->emptied);
    pthread_mutex_unlock(&q->lock);
}

static bool no_more(const queue *q) {
    return queue_stopped(q) || q->next_unit == q->plan->n_units;
}

static bool window_full(const queue *q) {
    return q->n_taken - q->n_released == q->n_slots || q->waiting_bytes > most_waiting;
}

/* Where the next tile ends. Of a medium that a tile can hold, all units go to one thread,
 * which then makes its model only once; a longer one is cut. */
static uint64_t tile_end(const queue *q) {
    uint64_t medium = q->plan->units_per_medium, first = q->next_unit;
    uint64_t most = TILE_ROWS / q->plan->unit_rows, n = q->tile_units;
    uint64_t to_boundary = medium - first % medium;
    uint64_t of_method = q->plan->n_units / q->plan->n_methods;

    most = most ? most : 1;
    n = n < most ? n : most;
    if (n >= to_boundary)
        n = to_boundary + (n - to_boundary) / medium * medium;
    else if (2 * n >= medium)
        n = to_boundary;
    to_boundary = of_method - first % of_method; /* another method: another speed */
    return first + (n < to_boundary ? n : to_boundary);
}

/* A tile for the taker. */
static sweep_tile *hand_out(queue *q) {
    sweep_tile *t = &q->slot[q->n_taken++ % q->n_slots];
    uint64_t of_method = q->plan->n_units / q->plan->n_methods;

    if (q->next_unit % of_method == 0)
        q->tile_units = 1;
    t->first = q->next_unit;
    t->n = tile_end(q) - t->first;
    t->cases = 0;
    t->bytes.n = t->notes.n = 0;
    t->taken = system_seconds();
    t->ready = false;
    q->next_unit += t->n;
    return t;
}

sweep_tile *queue_take(queue *q) {
    sweep_tile *t = NULL;

    pthread_mutex_lock(&q->lock);
    while (!no_more(q) && window_full(q))
        pthread_cond_wait(&q->emptied, &q->lock);
    if (!no_more(q))
        t = hand_out(q);
    pthread_mutex_unlock(&q->lock);
    return t;
}

bool queue_try_take(queue *q, sweep_tile **t) {
    bool answer;

    pthread_mutex_lock(&q->lock);
    answer = no_more(q) || !window_full(q);
    *t = answer && !no_more(q) ? hand_out(q) : NULL;
    pthread_mutex_unlock(&q->lock);
    return answer;
}

/* Tiles long enough not to be dominated by their handling, short enough to share out
 * evenly and to lose little when the run is killed. */
static void adapt(queue *q, const sweep_tile *t) {
    double seconds = system_seconds() - t->taken;

    if (seconds < short_tile && t->n >= q->tile_units && q->tile_units < TILE_ROWS)
        q->tile_units *= 2;
    else if (seconds > long_tile && t->n <= q->tile_units && q->tile_units > 1)
        q->tile_units /= 2;
}

void queue_put(queue *q, sweep_tile *t, int rc) {
    if (rc != CLI_DONE) {
        queue_stop(q, rc);
        return;
    }
    pthread_mutex_lock(&q->lock);
    adapt(q, t);
    t->ready = true;
    q->waiting_bytes += t->bytes.n;
    pthread_cond_signal(&q->filled);
    pthread_mutex_unlock(&q->lock);
}

static struct timespec deadline(double seconds) {
    struct timespec t;
    long whole = (long)seconds;

    clock_gettime(CLOCK_MONOTONIC, &t);
    t.tv_sec += whole;
    t.tv_nsec += (long)(1e9 * (seconds - (double)whole));
    if (t.tv_nsec >= 1000000000) {
        t.tv_nsec -= 1000000000;
        t.tv_sec++;
    }
    return t;
}

static bool all_released(const queue *q) {
    return q->n_released == q->n_taken && q->next_unit == q->plan->n_units;
}

static sweep_tile *oldest(const queue *q) {
    sweep_tile *t = &q->slot[q->n_released % q->n_slots];

    return q->n_released < q->n_taken && t->ready ? t : NULL;
}

sweep_tile *queue_collect(queue *q, double patience) {
    struct timespec until = deadline(patience);
    sweep_tile *t;
    int late = 0;

    pthread_mutex_lock(&q->lock);
    while (!(t = oldest(q)) && !late && !all_released(q) && !queue_stopped(q))
        late = pthread_cond_timedwait(&q->filled, &q->lock, &until);
    pthread_mutex_unlock(&q->lock);
    return t;
}

void queue_release(queue *q, sweep_tile *t) {
    record_free(&t->record);
    pthread_mutex_lock(&q->lock);
    q->waiting_bytes -= t->bytes.n;
    q->n_released++;
    pthread_cond_broadcast(&q->emptied);
    pthread_mutex_unlock(&q->lock);
}

bool queue_finished(queue *q) {
    bool finished;

    pthread_mutex_lock(&q->lock);
    finished = all_released(q);
    pthread_mutex_unlock(&q->lock);
    return finished;
}
