/* What the program asks of the system: time, cores, signals.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* sched_getaffinity: what taskset, a cgroup or Slurm leaves us */
#include "system.h"

#include <sched.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static const int watched[] = {SIGINT, SIGTERM, SIGHUP};
enum { N_WATCHED = sizeof watched / sizeof watched[0] };

static volatile sig_atomic_t caught;

double system_seconds(void) {
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void system_pause(double seconds) {
    struct timespec t = {(time_t)seconds, 0};

    t.tv_nsec = (long)(1e9 * (seconds - (double)t.tv_sec));
    nanosleep(&t, NULL);
}

int system_cores(void) {
    cpu_set_t set;
    long cores = sysconf(_SC_NPROCESSORS_ONLN);

    if (sched_getaffinity(0, sizeof set, &set) == 0)
        cores = CPU_COUNT(&set);
    return cores > 1 ? (int)cores : 1;
}

void system_processor(char *name, size_t size) {
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[200];

    snprintf(name, size, "unknown processor");
    while (file && fgets(line, sizeof line, file)) {
        const char *value = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && value) {
            line[strcspn(line, "\n")] = '\0';
            snprintf(name, size, "%s", value + 1 + strspn(value + 1, " "));
            break;
        }
    }
    if (file)
        fclose(file);
}

/* A second signal ends the program where it stands, but not one that comes with the
 * first: `timeout` and batch systems send to the process and to its group. */
static void note(int signal_number) {
    static const double together = 0.3; /* seconds */
    static double first;
    double now = system_seconds();

    if (!caught) {
        caught = signal_number;
        first = now;
    } else if (now - first > together) {
        signal(signal_number, SIG_DFL);
        raise(signal_number); /* once the handler has returned */
    }
}

void system_watch_signals(void) {
    struct sigaction before, ours = {.sa_handler = note};

    sigemptyset(&ours.sa_mask);
    for (int i = 0; i < N_WATCHED; i++)
        sigaddset(&ours.sa_mask, watched[i]);
    for (int i = 0; i < N_WATCHED; i++) {
        if (sigaction(watched[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(watched[i], &ours, NULL);
    }
}

int system_signal(void) { return caught; }

void system_die(void) {
    signal(caught, SIG_DFL);
    raise(caught);
    _exit(128 + caught);
}

void system_shield(bool on) {
    sigset_t set;

    sigemptyset(&set);
    for (int i = 0; i < N_WATCHED; i++)
        sigaddset(&set, watched[i]);
    pthread_sigmask(on ? SIG_BLOCK : SIG_UNBLOCK, &set, NULL);
}
