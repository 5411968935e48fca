/* JSON as people write it by hand: Jansson parses, this checks.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/json.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tree/path.h"
#include "tree/problem.h"

pps_status pps_json_parse(const pps_json_file *file, const char *text, size_t n,
                          pps_json *root) {
    json_error_t error;
    *root = (pps_json){.file = file};
    root->value = json_loadb(text, n, JSON_REJECT_DUPLICATES, &error);
    if (root->value) {
        return PPS_OK;
    }
    if (!*error.text || json_error_code(&error) == json_error_out_of_memory) {
        return pps_complain(file->problem, PPS_ERR_MEMORY, "%s: out of memory",
                            file->path);
    }
    return pps_complain(file->problem, PPS_ERR_FORMAT, "%s:%d:%d: %s", file->path,
                        error.line, error.column, error.text);
}

pps_status pps_json_load(const pps_json_file *file, pps_json *root) {
    unsigned char *bytes;
    size_t n;
    pps_status status = pps_path_load(file->path, &bytes, &n);
    if (status) {
        return pps_complain(file->problem, status, "%s: %s", file->path,
                            status == PPS_ERR_FILE ? strerror(errno) : "out of memory");
    }
    status = pps_json_parse(file, (const char *)bytes, n, root);
    free(bytes);
    return status;
}

pps_json pps_json_key(const pps_json *object, const char *key) {
    return (pps_json){object, key, 0, json_object_get(object->value, key),
                      object->file};
}

pps_json pps_json_element(const pps_json *array, size_t index) {
    return (pps_json){array, NULL, index, json_array_get(array->value, index),
                      array->file};
}

/* ---- texts ---- */

/* Text that is cut where its room ends. */
typedef struct {
    char text[200];
    size_t n;
} line;

static void append(line *to, const char *s, size_t n) {
    for (size_t i = 0; i < n && to->n + 1 < sizeof to->text; i++) {
        to->text[to->n++] = s[i];
    }
    to->text[to->n] = '\0';
}

/* From the document down; "~" and "/" in keys are "~0" and "~1". */
static void append_pointer(line *to, const pps_json *at) {
    if (!at->up) {
        return;
    }
    append_pointer(to, at->up);
    append(to, "/", 1);
    if (!at->key) {
        char number[24];
        append(to, number, (size_t)snprintf(number, sizeof number, "%zu", at->index));
        return;
    }
    for (const char *c = at->key; *c; c++) {
        append(to,
               *c == '~'   ? "~0"
               : *c == '/' ? "~1"
                           : c,
               *c == '~' || *c == '/' ? 2 : 1);
    }
}

static pps_status fail(const pps_json *at, const char *format, va_list arguments) {
    char what[350];
    line pointer = {"", 0};
    vsnprintf(what, sizeof what, format, arguments);
    append_pointer(&pointer, at);
    return pps_complain(at->file->problem, PPS_ERR_FORMAT, "%s: %s%s%s", at->file->path,
                        pointer.text, pointer.n ? ": " : "", what);
}

pps_status pps_json_fail(const pps_json *at, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    pps_status status = fail(at, format, arguments);
    va_end(arguments);
    return status;
}

/* The value as in the file, if it is short; else what kind it is. */
static void show(const json_t *value, char text[80]) {
    static const char *const KIND[] = {"an object", "an array"};
    bool large = json_is_object(value) || json_is_array(value);
    char *dump = value && !large
                     ? json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6))
                     : NULL;
    if (dump) {
        snprintf(text, 80, strlen(dump) > 60 ? "%.60s..." : "%s", dump);
    } else {
        snprintf(text, 80, "%s", large ? KIND[json_is_array(value)] : "missing");
    }
    free(dump);
}

pps_status pps_json_refuse(const pps_json *at, const char *wanted) {
    char value[80];
    show(at->value, value);
    return pps_json_fail(at, "is %s; it must be %s", value, wanted);
}

/* ---- keys ---- */

/* Levenshtein's distance: the fewest letters to add, drop or change. */
static size_t distance(const char *a, const char *b) {
    enum { LONGEST = 40 };
    size_t row[LONGEST + 1], n = strlen(b) < LONGEST ? strlen(b) : LONGEST;
    for (size_t j = 0; j <= n; j++) {
        row[j] = j;
    }
    for (size_t i = 0; a[i]; i++) {
        size_t corner = row[0];
        row[0] = i + 1;
        for (size_t j = 1; j <= n; j++) {
            size_t change = corner + (a[i] != b[j - 1]);
            size_t other = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            corner = row[j];
            row[j] = change < other ? change : other;
        }
    }
    return row[n];
}

static const char *closest(const char *key, const char *const allowed[]) {
    const char *best = "";
    size_t least = SIZE_MAX;
    for (size_t i = 0; allowed[i]; i++) {
        size_t far = distance(key, allowed[i]);
        best = far < least ? allowed[i] : best;
        least = far < least ? far : least;
    }
    return best;
}

pps_status pps_json_keys(const pps_json *at, const char *const allowed[]) {
    const char *key;
    json_t *value;
    if (!json_is_object(at->value)) {
        return pps_json_refuse(at, "an object");
    }
    json_object_foreach(at->value, key, value) {
        bool known = strcmp(key, "comment") == 0;
        for (size_t i = 0; allowed[i]; i++) {
            known = known || strcmp(key, allowed[i]) == 0;
        }
        if (!known) {
            pps_json wrong = pps_json_key(at, key);
            return pps_json_fail(&wrong,
                                 "there is no such key; the closest allowed is \"%s\"",
                                 closest(key, allowed));
        }
    }
    return PPS_OK;
}

/* ---- values ---- */

static bool in_range(const json_t *value, pps_json_range range) {
    double x = json_number_value(value);
    return json_is_number(value) && isfinite(x) && x <= range.high &&
           (range.open ? x > range.low : x >= range.low);
}

static void describe(pps_json_range range, char text[80]) {
    const char *above = range.open ? ">" : ">=";
    if (isinf(range.low) && isinf(range.high)) {
        snprintf(text, 80, "a number");
    } else if (isinf(range.high)) {
        snprintf(text, 80, "a number %s %g", above, range.low);
    } else if (range.open) {
        snprintf(text, 80, "a number > %g and <= %g", range.low, range.high);
    } else {
        snprintf(text, 80, "a number from %g to %g", range.low, range.high);
    }
}

pps_status pps_json_number(const pps_json *at, pps_json_range range, double *out) {
    if (!in_range(at->value, range)) {
        char wanted[80];
        describe(range, wanted);
        return pps_json_refuse(at, wanted);
    }
    *out = json_number_value(at->value);
    return PPS_OK;
}

/* An array of n numbers, or with `one` also a single number. */
static pps_status list(const pps_json *at, size_t n, pps_json_range range, bool one,
                       double *out) {
    if (!json_is_array(at->value) || json_array_size(at->value) != n) {
        char wanted[80];
        snprintf(wanted, sizeof wanted, "an array of %zu number%s%s", n,
                 n == 1 ? "" : "s", one ? ", or one number" : "");
        if (json_is_array(at->value)) {
            return pps_json_fail(at, "is an array of %zu; it must be %s",
                                 json_array_size(at->value), wanted);
        }
        return pps_json_refuse(at, wanted);
    }
    pps_status status = PPS_OK;
    for (size_t i = 0; !status && i < n; i++) {
        pps_json element = pps_json_element(at, i);
        status = pps_json_number(&element, range, &out[i]);
    }
    return status;
}

pps_status pps_json_numbers(const pps_json *at, size_t n, pps_json_range range,
                            double *out) {
    return list(at, n, range, false, out);
}

pps_status pps_json_spread(const pps_json *at, size_t n, pps_json_range range,
                           double *out) {
    if (!json_is_number(at->value)) {
        return list(at, n, range, true, out);
    }
    pps_status status = pps_json_number(at, range, &out[0]);
    for (size_t i = 1; !status && i < n; i++) {
        out[i] = out[0];
    }
    return status;
}

pps_status pps_json_integer(const pps_json *at, int64_t low, int64_t high,
                            int64_t *out) {
    int64_t value = json_integer_value(at->value);
    if (!json_is_integer(at->value) || value < low || value > high) {
        char wanted[80];
        snprintf(wanted, sizeof wanted, "a whole number from %lld to %lld",
                 (long long)low, (long long)high);
        return pps_json_refuse(at, wanted);
    }
    *out = value;
    return PPS_OK;
}

pps_status pps_json_string(const pps_json *at, const char **out) {
    *out = json_string_value(at->value);
    return *out && **out ? PPS_OK : pps_json_refuse(at, "a string, not empty");
}

pps_status pps_json_word(const pps_json *at, const char *const *words, size_t n,
                         size_t *out) {
    const char *word = json_string_value(at->value);
    line wanted = {"", 0};
    for (size_t i = 0; i < n; i++) {
        if (word && strcmp(word, words[i]) == 0) {
            *out = i;
            return PPS_OK;
        }
        append(&wanted,
               i == 0      ? "\""
               : i + 1 < n ? "\", \""
                           : "\" or \"",
               i == 0      ? 1
               : i + 1 < n ? 4
                           : 6);
        append(&wanted, words[i], strlen(words[i]));
    }
    append(&wanted, "\"", 1);
    return pps_json_refuse(at, wanted.text);
}
