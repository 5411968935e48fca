/* JSON as people write it by hand: every value is checked, and what is wrong is named by
 * its JSON pointer (RFC 6901), with the value and what is allowed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_JSON_H
#define PPS_TREE_JSON_H

#include <jansson.h>

#include <ppscat/tree/mesh.h>

typedef struct pps_json_file {
    const char *path;
    pps_problem *problem;
} pps_json_file;

/* A value and the way to it; lives as long as what it came from. value NULL: absent. */
typedef struct pps_json {
    const struct pps_json *up; /* NULL: the document */
    const char *key;           /* NULL: element `index` of an array */
    size_t index;
    json_t *value;
    const pps_json_file *file;
} pps_json;

/* The document of a file; the caller gives root->value back by json_decref. FILE; FORMAT:
 * the problem is FILE:LINE:COLUMN: why. Keys that come twice are refused. */
pps_status pps_json_load(const pps_json_file *file, pps_json *root);

/* The same of n letters, which file->path names in messages. */
pps_status pps_json_parse(const pps_json_file *file, const char *text, size_t n,
                          pps_json *root);

pps_json pps_json_key(const pps_json *object, const char *key);
pps_json pps_json_element(const pps_json *array, size_t index);

/* "FILE: POINTER: what"; FORMAT. */
__attribute__((format(printf, 2, 3))) pps_status pps_json_fail(const pps_json *at,
                                                               const char *format, ...);

/* "FILE: POINTER: is VALUE; it must be WANTED"; FORMAT. */
pps_status pps_json_refuse(const pps_json *at, const char *wanted);

/* Is it an object with no key but these (NULL at the end)? "comment" always is allowed. */
pps_status pps_json_keys(const pps_json *at, const char *const allowed[]);

/* Numbers in [low, high]; `open`: low itself is not allowed. */
typedef struct pps_json_range {
    double low, high;
    bool open;
} pps_json_range;
pps_status pps_json_number(const pps_json *at, pps_json_range range, double *out);

/* An array of n numbers. */
pps_status pps_json_numbers(const pps_json *at, size_t n, pps_json_range range,
                            double *out);

/* The same, or one number that stands for all n. */
pps_status pps_json_spread(const pps_json *at, size_t n, pps_json_range range,
                           double *out);

/* A whole number from low to high. */
pps_status pps_json_integer(const pps_json *at, int64_t low, int64_t high,
                            int64_t *out);

/* A string, not empty; it belongs to the document. */
pps_status pps_json_string(const pps_json *at, const char **out);

/* One of n words; *out is its number. */
pps_status pps_json_word(const pps_json *at, const char *const *words, size_t n,
                         size_t *out);

#endif
