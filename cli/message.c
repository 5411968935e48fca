/* Messages on standard error, and the guess at what a misspelt word meant.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE_SIZE = 1024, WORD_SIZE = 32 };

static bool muted;

void cli_mute(void) { muted = true; }

/* One line, whatever the user's text holds. */
static void print(const char *format, va_list arguments) {
    char text[MESSAGE_SIZE];

    vsnprintf(text, sizeof text, format, arguments);
    for (char *c = text; *c; c++) {
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?';
    }
    fprintf(stderr, "ppscat: %s\n", text);
}

int cli_usage(const char *format, ...) {
    va_list arguments;

    va_start(arguments, format);
    if (!muted)
        print(format, arguments);
    va_end(arguments);
    return CLI_USAGE;
}

int cli_failed(const char *format, ...) {
    va_list arguments;

    va_start(arguments, format);
    print(format, arguments);
    va_end(arguments);
    return CLI_FAILED;
}

void cli_note(const char *format, ...) {
    va_list arguments;

    va_start(arguments, format);
    if (!muted)
        print(format, arguments);
    va_end(arguments);
}

int cli_no_memory(void) { return cli_failed("out of memory"); }

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Levenshtein distance: letters to insert, drop or change to make a into b. */
static size_t edit_distance(const char *a, const char *b) {
    size_t row[WORD_SIZE + 1], n = strlen(b);

    if (strlen(a) > WORD_SIZE || n > WORD_SIZE)
        return WORD_SIZE;
    for (size_t j = 0; j <= n; j++)
        row[j] = j;
    for (size_t i = 0; a[i]; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < n; j++) {
            size_t above = row[j + 1];
            size_t step = least(above, row[j]) + 1;
            row[j + 1] = least(step, diagonal + (a[i] != b[j]));
            diagonal = above;
        }
    }
    return row[n];
}

const char *cli_closest(const char *word, size_t n, const char *const *candidates) {
    const char *closest = NULL;
    size_t best = strlen(word) / 3 + 1; /* one slip in three letters */

    for (size_t i = 0; i < n; i++) {
        size_t distance = edit_distance(word, candidates[i]);
        if (distance <= best && distance < strlen(candidates[i])) {
            if (!closest || distance < best)
                closest = candidates[i];
            best = distance;
        }
    }
    return closest;
}
