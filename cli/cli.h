/* What every file of the program shares: exit codes and messages.
 *
 * Only cli/ prints. A message is one line on standard error, "ppscat: ...".
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_H
#define PPSCAT_CLI_H

#include <stddef.h>

/* Functions that can fail return one of these; CLI_DONE is 0. */
enum {
    CLI_DONE = 0,
    CLI_FAILED = 1, /* no memory, a full disk, a closed pipe, a bug */
    CLI_USAGE = 2,  /* bad usage or bad input */
    CLI_REFUSED = 3 /* done, but some rows are empty */
};

/* Print a message; returns CLI_USAGE. Bad usage names the option, the value and what is
 * allowed. */
int cli_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Print a message; returns CLI_FAILED. */
int cli_failed(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Print a message that is no error. */
void cli_note(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* From now on only cli_failed speaks: another process says the rest. */
void cli_mute(void);

/* "out of memory"; returns CLI_FAILED. */
int cli_no_memory(void);

/* The candidate that `word` is probably a misspelling of, or NULL. */
const char *cli_closest(const char *word, size_t n, const char *const *candidates);

#endif
