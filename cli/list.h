/* Lists of numbers as options give them: `0.5,0.9`, `0:1:11`, `0.1:10:5log`, `25%`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_LIST_H
#define PPSCAT_CLI_LIST_H

#include <stdbool.h>
#include <stddef.h>

typedef struct {
    size_t n;
    double *value;
    bool *share; /* value[i] is a percentage */
} number_list;

/* Besides plain numbers. */
enum { LIST_INF = 1, LIST_SHARE = 2 };

enum { LIST_MAX = 10000000 /* numbers in a list */ };

/* Read a list. Items are separated by commas:
 *   x             a decimal number
 *   inf           with LIST_INF
 *   x%            with LIST_SHARE
 *   lo:hi:n       n evenly spaced numbers, both ends exact; n = 1 only where lo = hi
 *   lo:hi:nlog    the same, logarithmically, lo and hi above 0
 * Returns CLI_DONE with *out to be freed; CLI_USAGE with one line in `why`, which names
 * the item; CLI_FAILED without memory. *out is empty then. */
int list_read(const char *text, unsigned allow, number_list *out, char *why,
              size_t size);

/* One number, no list; false where the text is anything else. */
bool list_read_number(const char *text, double *out);

void list_free(number_list *list);

#endif
