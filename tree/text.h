/* Strings that are made.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_TEXT_H
#define PPS_TREE_TEXT_H

#include <stdlib.h>
#include <string.h>

/* The first n bytes of a, and then b; the caller frees it. NULL: no memory. */
static inline char *text_join(const char *a, size_t n, const char *b) {
    size_t m = strlen(b);
    char *text = malloc(n + m + 1);
    if (text) {
        memcpy(text, a, n);
        memcpy(text + n, b, m + 1);
    }
    return text;
}

static inline char *text_copy(const char *s) { return text_join("", 0, s); }

#endif
