/* Progress on standard error: done / total, rate, time left.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_PROGRESS_H
#define PPSCAT_CLI_PROGRESS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include <pthread.h>

typedef struct {
    pthread_mutex_t lock;
    bool shown, terminal;
    atomic_size_t done;
    size_t total, before; /* before: done by an earlier run */
    size_t told;
    double started, last; /* seconds */
} progress_meter;

void progress_start(progress_meter *meter, bool shown, size_t total);

/* So many are done already, by an earlier run. */
void progress_resume(progress_meter *meter, size_t done);

/* So many more cases are done. Safe from any thread. */
void progress_count(progress_meter *meter, size_t cases);

/* Show it, when that was long ago. Safe from any thread. */
void progress_show(progress_meter *meter);

/* Both, for one case. */
void progress_step(progress_meter *meter);

/* Leave the line clean for what follows. */
void progress_end(progress_meter *meter);

#endif
