/* What the test programs share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void support_assert_close(double got, double want, double rtol, double atol,
                          const char *what, const char *file, int line) {
    double error = fabs(got - want);
    if (error <= rtol * fabs(want) + atol || got == want) {
        return;
    }
    print_error("%s = %.17g, want %.17g: off by %.3g (relative %.3g)\n", what, got,
                want, error, error / fabs(want));
    _fail(file, line);
}

double support_relative_error(double got, double want) {
    if (fabs(got) < 1e-290 && fabs(want) < 1e-290) {
        return 0;
    }
    return fabs(got - want) / fabs(want);
}

static size_t count_columns(const char *line) {
    size_t n = 1;
    for (; *line; line++) {
        n += *line == ',';
    }
    return n;
}

static void read_row(char *line, size_t n, double *row) {
    char *field = line;
    for (size_t i = 0; i < n; i++) {
        char *comma = strchr(field, ','), *end;
        if (comma) {
            *comma = '\0';
        }
        row[i] = strtod(field, &end);
        if (end == field) {
            row[i] = (double)NAN;
        }
        field = comma ? comma + 1 : field + strlen(field);
    }
}

support_table support_read(const char *name) {
    char path[512], line[4096];
    snprintf(path, sizeof path, "%s/reference/%s", PPS_DATA_DIR, name);
    FILE *file = fopen(path, "r");
    if (!file) {
        fail_msg("cannot read %s", path);
    }
    support_table table = {0};
    size_t room = 0;
    while (fgets(line, sizeof line, file)) {
        if (line[0] == '#') {
            continue;
        }
        if (table.n_columns == 0) {
            table.n_columns = count_columns(line);
            continue;
        }
        if (table.n_rows == room) {
            room = 2 * room + 64;
            double *more =
                realloc(table.value, room * table.n_columns * sizeof *table.value);
            assert_non_null(more);
            table.value = more;
        }
        read_row(line, table.n_columns, table.value + table.n_rows * table.n_columns);
        table.n_rows++;
    }
    fclose(file);
    return table;
}

void support_table_free(support_table *table) {
    free(table->value);
    *table = (support_table){0};
}

double support_random(uint64_t *state) {
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}
