/* Which methods and settings a chart has: streams, photons, tolerances.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "settings.h"

#include <stdio.h>
#include <string.h>

#include "csv.h"

typedef enum { STREAMS, PHOTONS, TOLERANCE } knob;

enum { MAX_VALUES = 5 };

/* A method that is not listed here has one setting, "-". */
static const struct {
    const char *method;
    knob turned;
    size_t n;
    double value[MAX_VALUES];
} table[] = {
    {"auto", TOLERANCE, 5, {0.3, 0.1, 0.01, 1e-4, 1e-6}},
    {"exact", STREAMS, 5, {4, 8, 16, 32, 64}},
    {"exact", TOLERANCE, 1, {1e-6}},
    {"adding", TOLERANCE, 3, {1e-2, 1e-4, 1e-6}},
    {"rk", TOLERANCE, 3, {1e-2, 1e-4, 1e-6}},
    {"rk-shooting", TOLERANCE, 3, {1e-2, 1e-4, 1e-6}},
    {"mc", PHOTONS, 3, {1e2, 1e3, 1e4}},
};
enum { N_TABLE = sizeof table / sizeof table[0] };

size_t settings_count(const pps_method *method) {
    size_t n = 0;

    for (size_t row = 0; row < N_TABLE; row++) {
        if (strcmp(table[row].method, method->name) == 0)
            n += table[row].n;
    }
    return n ? n : 1;
}

static void turn(setting *s, knob which, double value) {
    static const char *const names[] = {
        [STREAMS] = "streams", [PHOTONS] = "photons", [TOLERANCE] = "tol"};
    char number[CSV_NUMBER_SIZE];

    if (which == STREAMS)
        s->options.streams = (int)value;
    else if (which == PHOTONS)
        s->options.photons = (uint64_t)value;
    else
        s->options.tolerance = value;
    if (which == TOLERANCE)
        csv_format(value, number);
    else
        snprintf(number, sizeof number, "%.0f", value);
    snprintf(s->text, sizeof s->text, "%s=%s", names[which], number);
}

setting settings_at(const pps_method *method, size_t i, const pps_options *base) {
    setting s = {.method = method, .options = *base, .text = "-"};

    for (size_t row = 0; row < N_TABLE; row++) {
        if (strcmp(table[row].method, method->name) != 0)
            continue;
        if (i < table[row].n) {
            turn(&s, table[row].turned, table[row].value[i]);
            break;
        }
        i -= table[row].n;
    }
    return s;
}

void every_method(char names[METHOD_NAMES_SIZE]) {
    size_t n, length = 0;
    const pps_method *const *all = pps_method_table(&n);

    for (size_t i = 0; i < n && length < METHOD_NAMES_SIZE; i++)
        length += (size_t)snprintf(names + length, METHOD_NAMES_SIZE - length, "%s%s",
                                   i ? "," : "", all[i]->name);
}
