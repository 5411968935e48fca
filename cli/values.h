/* Reading the text of one option: numbers within their range, words, whole numbers.
 *
 * Where the text is wrong, every function that returns int prints one line that names
 * the option, the value and what is allowed, and gives CLI_USAGE.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_VALUES_H
#define PPSCAT_CLI_VALUES_H

#include <stdint.h>

#include "list.h"
#include "options.h"

/* A list of numbers, each allowed for the option; free it in every case. */
int value_list(option_id id, const char *text, number_list *out);

/* One number allowed for the option. */
int value_number(const invocation *call, option_id id, double *out);

/* Which of the words in the option's metavar was given: 0, 1, .. */
int value_choice(const invocation *call, option_id id, int *out);

/* A whole number from lo to hi. */
int value_count(const invocation *call, option_id id, uint64_t lo, uint64_t hi,
                uint64_t *out);

/* Two numbers and a comma between them. */
int value_pair(const invocation *call, option_id id, double out[2]);

/* --jobs, or all cores. */
int value_threads(const invocation *call, int *out);

/* --progress: whether it is shown. */
int value_progress(const invocation *call, bool *out);

/* A whole number from lo to hi, in digits only. */
bool value_whole(const char *text, long lo, long hi, int *out);

/* Say what is wrong with a number's option, and what is allowed; CLI_USAGE. */
int value_refuse(option_id id, const char *what);

#endif
