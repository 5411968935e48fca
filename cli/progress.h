/* Progress on standard error: done / total, rate, time left.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_PROGRESS_H
#define PPSCAT_CLI_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

#include <pthread.h>

typedef struct {
    pthread_mutex_t lock;
    bool shown, terminal;
    size_t done, total;
    double started, last; /* seconds */
} progress_meter;

void progress_start(progress_meter *meter, bool shown, size_t total);

/* One more case is done. Safe from any thread. */
void progress_step(progress_meter *meter);

/* Leave the line clean for what follows. */
void progress_end(progress_meter *meter);

#endif
