/* Bytes that grow.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_BUFFER_H
#define PPSCAT_CLI_BUFFER_H

#include <stddef.h>

/* All zero to begin with. */
typedef struct {
    char *data;
    size_t n, room;
} buffer;

/* Make room for `more` bytes behind the n that are there. CLI_FAILED without memory. */
int buffer_reserve(buffer *b, size_t more);

int buffer_append(buffer *b, const void *data, size_t n);

void buffer_free(buffer *b);

#endif
