/* What the program asks of the system: time, cores, signals.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_SYSTEM_H
#define PPSCAT_CLI_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

/* Seconds of a clock that only goes forward. */
double system_seconds(void);

void system_pause(double seconds);

/* Cores that this process may use, at least 1. */
int system_cores(void);

/* What the processor calls itself; "unknown processor" where that is not known. */
void system_processor(char *name, size_t size);

/* From now on SIGINT, SIGTERM and SIGHUP are noted rather than deadly, but for those that
 * are ignored already (nohup). A second one kills as ever, 0.3 s later or more. */
void system_watch_signals(void);

/* The signal that came, or 0. */
int system_signal(void);

/* Die of that signal, so that the shell, too, knows that the run was stopped. */
_Noreturn void system_die(void);

/* Leave signals to the thread that calls, in threads it starts until `false`. */
void system_shield(bool on);

#endif
