/* Turns data/auto_errors.csv (standard input) into the C table that auto.c includes.
 *
 * Where the file is of another grid or of other candidates, every candidate "cannot" in the
 * table ('~'): `auto` is then `exact`, and the program that makes the file can be built.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "methods/auto_grid.h"

enum { PARAMETERS = 4, LINE = 256 };

/* The fields of the errors of a row; false where they are not of these candidates. */
static bool split(char *line, char *field[PPS_AUTO_METRICS]) {
    char *next = strtok(line, ",\n");
    for (int i = 0; next && i < PARAMETERS; i++) {
        next = strtok(NULL, ",\n");
    }
    for (int i = 0; i < PPS_AUTO_METRICS; i++) {
        if (!next || strlen(next) != PPS_AUTO_N_CANDIDATES) {
            return false;
        }
        field[i] = next;
        next = strtok(NULL, ",\n");
    }
    return true;
}

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

static void print_row(char *const field[PPS_AUTO_METRICS]) {
    putchar('{');
    for (int i = 0; i < PPS_AUTO_METRICS; i++) {
        print_quoted(field[i]);
    }
    printf("},\n");
}

static bool file_fits(void) {
    char line[LINE], *field[PPS_AUTO_METRICS];
    int rows = 0;
    bool fits = fgets(line, sizeof line, stdin);
    while (fits && fgets(line, sizeof line, stdin)) {
        fits = split(line, field);
        rows++;
    }
    rewind(stdin);
    return fits && rows == PPS_AUTO_N_CELLS;
}

int main(void) {
    char line[LINE], *field[PPS_AUTO_METRICS], cannot[PPS_AUTO_N_CANDIDATES + 1] = {0};
    bool fits = file_fits();
    memset(cannot, '~', PPS_AUTO_N_CANDIDATES);
    for (int i = 0; i < PPS_AUTO_METRICS; i++) {
        field[i] = cannot;
    }
    if (!fits) {
        fprintf(stderr, "data/auto_errors.csv is of other candidates or another grid: "
                        "make it again by the target auto-table\n");
    } else if (!fgets(line, sizeof line, stdin)) {
        return 1;
    }
    for (int i = 0; i < PPS_AUTO_N_CELLS; i++) {
        if (fits && (!fgets(line, sizeof line, stdin) || !split(line, field))) {
            return 1;
        }
        print_row(field);
    }
    return fflush(stdout) ? 1 : 0;
}
