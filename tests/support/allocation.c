/* Allocation that fails when a test wants it to.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/allocation.h"

#include <stdbool.h>
#include <stddef.h>

/* The linker gives them these names: --wrap. */
void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *old, size_t size);

long allocations_left = -1;

static bool allowed(void) {
    if (allocations_left > 0) {
        allocations_left--;
        return true;
    }
    return allocations_left < 0;
}

void *__wrap_malloc(size_t size) { return allowed() ? __real_malloc(size) : NULL; }

void *__wrap_calloc(size_t n, size_t size) {
    return allowed() ? __real_calloc(n, size) : NULL;
}

void *__wrap_realloc(void *old, size_t size) {
    return allowed() ? __real_realloc(old, size) : NULL;
}
