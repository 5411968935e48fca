/* The values of a unit as bytes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "rows.h"

#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "number.h"

/* A number with the comma behind it. */
typedef struct {
    size_t n;
    char text[NUMBER_SIZE];
} field;

static field format_field(double x) {
    field f;

    f.n = number_format(x, f.text);
    f.text[f.n++] = ',';
    return f;
}

static void format_all(const unit_range *range, field *out) {
    for (size_t i = 0; i < range->n; i++)
        out[i] = format_field(range->value[i]);
}

static char *put(char *at, const char *text, size_t n) {
    memcpy(at, text, n);
    return at + n;
}

static char *put_field(char *at, const field *f) { return put(at, f->text, f->n); }

size_t rows_medium(const sweep_unit *unit, const pps_method *method,
                   char text[MEDIUM_TEXT_SIZE]) {
    const double value[] = {unit->albedo, unit->g, unit->thickness};
    char *at = put(text, method->name, strlen(method->name));

    *at++ = ',';
    for (size_t i = 0; i < 3; i++) {
        at += number_format(value[i], at);
        *at++ = ',';
    }
    return (size_t)(at - text);
}

/* The values of a row and its end. */
static char *put_values(char *at, const double *values, size_t n) {
    for (size_t i = 0; i < n; i++) {
        at += number_format(values[i], at);
        *at++ = i + 1 < n ? ',' : '\n';
    }
    return at;
}

/* What the rows of a unit share, as text. */
typedef struct {
    char medium[MEDIUM_TEXT_SIZE];
    size_t n_medium;
    bool directions;
    const field *depth, *mu, *phi;
} shared_text;

/* All rows of one depth of a case, whose text up to there is `begin`. */
static char *put_depth(char *at, const sweep_unit *unit, const shared_text *shared,
                       const char *begin, size_t n_begin, size_t n_values,
                       const double *values) {
    if (!shared->directions)
        return put_values(put(at, begin, n_begin), values, n_values);
    for (size_t j = 0; j < unit->mu.n; j++) {
        for (size_t i = 0; i < unit->phi.n; i++, values += n_values) {
            at = put(at, begin, n_begin);
            at = put_field(at, &shared->mu[j]);
            at = put_field(at, &shared->phi[i]);
            at = put_values(at, values, n_values);
        }
    }
    return at;
}

static int put_rows(const sweep_unit *unit, const shared_text *shared, size_t n_values,
                    const double *values, buffer *out) {
    size_t rows = shared->directions ? unit->mu.n * unit->phi.n : 1;
    size_t longest = MEDIUM_TEXT_SIZE + (n_values + 4) * NUMBER_SIZE;

    for (size_t b = 0; b < unit->mu0.n; b++) {
        char begin[MEDIUM_TEXT_SIZE + 2 * NUMBER_SIZE];
        char *mu0 = put(begin, shared->medium, shared->n_medium);
        size_t n_mu0 = number_format(unit->mu0.value[b], mu0);
        mu0[n_mu0++] = ',';
        for (size_t k = 0; k < unit->depth.n; k++, values += rows * n_values) {
            char *end = put_field(mu0 + n_mu0, &shared->depth[k]);
            if (buffer_reserve(out, rows * longest) != CLI_DONE)
                return CLI_FAILED;
            end = put_depth(out->data + out->n, unit, shared, begin,
                            (size_t)(end - begin), n_values, values);
            out->n = (size_t)(end - out->data);
        }
    }
    return CLI_DONE;
}

int rows_csv(const sweep_station *own, const sweep_unit *unit, const double *values,
             sweep_tile *t) {
    shared_text shared = {.directions = own->plan->shape == ROWS_DIRECTIONS};
    size_t n = unit->depth.n, n_mu = 0, n_phi = 0;
    field *fields;
    int rc;

    if (shared.directions) {
        n_mu = unit->mu.n;
        n_phi = unit->phi.n;
    }
    fields = malloc((n + n_mu + n_phi + 1) * sizeof *fields);
    if (!fields)
        return cli_no_memory();
    format_all(&unit->depth, fields);
    if (shared.directions) {
        format_all(&unit->mu, fields + n);
        format_all(&unit->phi, fields + n + n_mu);
    }
    shared.depth = fields;
    shared.mu = fields + n;
    shared.phi = fields + n + n_mu;
    shared.n_medium = rows_medium(unit, unit->method, shared.medium);
    rc = put_rows(unit, &shared, own->task->n_values, values, &t->bytes);
    free(fields);
    return rc;
}

int rows_values(const sweep_station *own, const sweep_unit *unit, const double *values,
                sweep_tile *t) {
    uint64_t rows = plan_rows(own->plan, unit);

    return buffer_append(&t->bytes, values,
                         (size_t)rows * own->task->n_values * sizeof *values);
}
