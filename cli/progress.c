/* Progress on standard error: one line that rewrites itself, or lines in a log.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

#include <omp.h>

void progress_start(progress_meter *meter, bool shown, size_t total) {
    *meter = (progress_meter){.shown = shown, .total = total};
    meter->terminal = isatty(STDERR_FILENO);
    pthread_mutex_init(&meter->lock, NULL);
    meter->started = meter->last = omp_get_wtime();
}

static void print(const progress_meter *meter, double now) {
    double elapsed = now - meter->started;
    double rate = elapsed > 0 ? (double)meter->done / elapsed : 0;
    double left = rate > 0 ? (double)(meter->total - meter->done) / rate : 0;

    fprintf(stderr, "%s%zu / %zu cases, %.3g/s, %.0f s left%s",
            meter->terminal ? "\r\033[K" : "", meter->done, meter->total, rate, left,
            meter->terminal ? "" : "\n");
}

void progress_step(progress_meter *meter) {
    double now = omp_get_wtime(), wait = meter->terminal ? 0.1 : 1;

    if (!meter->shown)
        return;
    pthread_mutex_lock(&meter->lock);
    meter->done++;
    if (now - meter->last >= wait || meter->done == meter->total) {
        print(meter, now);
        meter->last = now;
    }
    pthread_mutex_unlock(&meter->lock);
}

void progress_end(progress_meter *meter) {
    pthread_mutex_lock(&meter->lock);
    if (meter->shown && meter->terminal)
        fputc('\n', stderr);
    pthread_mutex_unlock(&meter->lock);
    pthread_mutex_destroy(&meter->lock);
}
