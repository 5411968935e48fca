/* Progress on standard error: one line that rewrites itself, or lines in a log.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

#include "system.h"

void progress_start(progress_meter *meter, bool shown, size_t total) {
    *meter = (progress_meter){.shown = shown, .total = total};
    meter->terminal = isatty(STDERR_FILENO);
    pthread_mutex_init(&meter->lock, NULL);
    meter->started = meter->last = system_seconds();
}

void progress_resume(progress_meter *meter, size_t done) {
    atomic_store(&meter->done, done);
    meter->before = done;
}

void progress_count(progress_meter *meter, size_t cases) {
    if (meter->shown)
        atomic_fetch_add_explicit(&meter->done, cases, memory_order_relaxed);
}

static void print(progress_meter *meter, size_t done, double now) {
    double elapsed = now - meter->started;
    double rate = elapsed > 0 ? (double)(done - meter->before) / elapsed : 0;
    double left = rate > 0 ? (double)(meter->total - done) / rate : 0;

    fprintf(stderr, "%s%zu / %zu cases, %.3g/s, %.0f s left%s",
            meter->terminal ? "\r\033[K" : "", done, meter->total, rate, left,
            meter->terminal ? "" : "\n");
    meter->told = done;
    meter->last = now;
}

void progress_show(progress_meter *meter) {
    double now, wait = meter->terminal ? 0.1 : 1;
    size_t done = atomic_load(&meter->done);

    if (!meter->shown)
        return;
    now = system_seconds();
    pthread_mutex_lock(&meter->lock);
    if (now - meter->last >= wait && done > meter->told)
        print(meter, done, now);
    pthread_mutex_unlock(&meter->lock);
}

void progress_step(progress_meter *meter) {
    progress_count(meter, 1);
    progress_show(meter);
}

void progress_end(progress_meter *meter) {
    size_t done = atomic_load(&meter->done);

    pthread_mutex_lock(&meter->lock);
    if (meter->shown && done > meter->told)
        print(meter, done, system_seconds());
    if (meter->shown && meter->terminal)
        fputc('\n', stderr);
    pthread_mutex_unlock(&meter->lock);
    pthread_mutex_destroy(&meter->lock);
}
