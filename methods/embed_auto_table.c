/* Turns data/auto_errors.csv (standard input) into the C table that auto.c includes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "methods/auto_grid.h"

/* As a C string literal. */
static void print_quoted(const char *text) {
    putchar('"');
    for (; *text; text++) {
        if (*text == '\\' || *text == '"') {
            putchar('\\');
        }
        putchar(*text);
    }
    printf("\",");
}

int main(void) {
    char line[256];
    int rows = 0;
    if (!fgets(line, sizeof line, stdin)) {
        return 1;
    }
    while (fgets(line, sizeof line, stdin)) {
        char *field = strtok(line, ",\n");
        putchar('{');
        for (int i = 0; field && i < 4 + PPS_AUTO_METRICS; i++) {
            if (i >= 4 && strlen(field) != PPS_AUTO_N_CANDIDATES) {
                fprintf(stderr, "row %d: %s has not one character a candidate\n",
                        rows + 2, field);
                return 1;
            }
            if (i >= 4) {
                print_quoted(field);
            }
            field = strtok(NULL, ",\n");
        }
        printf("},\n");
        rows++;
    }
    if (rows != PPS_AUTO_N_CELLS) {
        fprintf(stderr, "%d rows, want %d: make the table again\n", rows,
                (int)PPS_AUTO_N_CELLS);
        return 1;
    }
    return 0;
}
