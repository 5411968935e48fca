/* The queue of tiles: runs of units handed out in order, and taken back in order.
 *
 * A tile is as many units as take some milliseconds. Threads (or other ranks) take and
 * put them in any order; one collector gets them in the order of the rows. A window
 * bounds how far the fastest runs ahead of the slowest, and so the memory.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_QUEUE_H
#define PPSCAT_CLI_QUEUE_H

#include <pthread.h>
#include <stdatomic.h>

#include "buffer.h"
#include "plan.h"
#include "record.h"

typedef struct {
    uint64_t first, n; /* units */
    uint64_t cases;
    buffer bytes; /* of all its rows */
    buffer notes; /* lines for standard error */
    record record;
    double taken; /* at that time, in seconds */
    bool ready;
} sweep_tile;

typedef struct {
    const sweep_plan *plan;
    pthread_mutex_t lock;
    pthread_cond_t filled, emptied; /* a tile is put; a slot of the window is free */
    sweep_tile *slot;               /* the window: tile t is slot[t % n_slots] */
    size_t n_slots;
    uint64_t n_taken, n_released; /* tiles */
    uint64_t next_unit, tile_units;
    size_t waiting_bytes; /* in tiles put but not released */
    atomic_int outcome;   /* CLI_DONE until it fails */
    atomic_bool stopped;  /* nobody takes any more */
} queue;

/* Start at a unit; so many are at work on tiles at a time. */
int queue_init(queue *q, const sweep_plan *plan, uint64_t first_unit, size_t workers);

/* The next tile to work on; waits while the window is full. NULL: no more. */
sweep_tile *queue_take(queue *q);

/* The same without waiting: false while the window is full. */
bool queue_try_take(queue *q, sweep_tile **t);

/* Give a tile back; rc other than CLI_DONE ends it all. */
void queue_put(queue *q, sweep_tile *t, int rc);

/* The next tile in order, to be released; NULL after so many seconds, at the end, or
 * once stopped. */
sweep_tile *queue_collect(queue *q, double patience);
void queue_release(queue *q, sweep_tile *t);

/* Whether all is released. */
bool queue_finished(queue *q);

/* Let nobody take any more. */
void queue_stop(queue *q, int rc);

/* Whether working on is of no use. */
bool queue_stopped(const queue *q);

void queue_free(queue *q);

#endif
