/* Bytes that grow.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "buffer.h"

#include <stdlib.h>
#include <string.h>

#include "cli.h"

int buffer_reserve(buffer *b, size_t more) {
    size_t room = b->room;
    char *grown;

    if (more <= b->room - b->n)
        return CLI_DONE;
    room = b->n + more > 2 * room ? b->n + more : 2 * room;
    grown = realloc(b->data, room);
    if (!grown)
        return cli_no_memory();
    b->data = grown;
    b->room = room;
    return CLI_DONE;
}

int buffer_append(buffer *b, const void *data, size_t n) {
    int rc = buffer_reserve(b, n);

    if (rc == CLI_DONE && n) {
        memcpy(b->data + b->n, data, n);
        b->n += n;
    }
    return rc;
}

void buffer_free(buffer *b) {
    free(b->data);
    *b = (buffer){0};
}
