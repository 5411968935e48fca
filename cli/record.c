/* What a run did: rows, refusals and why, and what the methods used.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "record.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "cli.h"

static bool same_setting(const used_count *a, const used_count *b) {
    return a->method == b->method && a->streams == b->streams && a->nodes == b->nodes &&
           a->delta_m == b->delta_m;
}

static int count_used(record *r, const used_count *more) {
    used_count *grown;

    for (size_t i = 0; i < r->n_used; i++) {
        if (same_setting(&r->used[i], more)) {
            r->used[i].outputs += more->outputs;
            return CLI_DONE;
        }
    }
    grown = realloc(r->used, (r->n_used + 1) * sizeof *grown);
    if (!grown)
        return cli_no_memory();
    r->used = grown;
    grown[r->n_used++] = *more;
    return CLI_DONE;
}

/* Before the counts, which tell whether there was anything before. */
static void widen(record *r, int lo, int hi, double error, bool estimated) {
    if (r->n_used == 0 || lo < r->min_orders)
        r->min_orders = lo;
    if (r->n_used == 0 || hi > r->max_orders)
        r->max_orders = hi;
    if (estimated)
        r->worst_error = fmax(r->worst_error, error);
    r->estimated |= estimated;
}

int record_used(record *r, const pps_method *method, const pps_info *info) {
    used_count count = {info->used ? info->used : method, info->streams, info->nodes,
                        info->delta_m, 1};

    if (info->streams == 0)
        return CLI_DONE;
    widen(r, info->orders, info->orders, info->error_estimate,
          !isnan(info->error_estimate));
    return count_used(r, &count);
}

int record_refused(record *r, const pps_method *method, const char *reason,
                   uint64_t rows) {
    refused_count *grown;
    char *copy;

    r->refused_rows += rows;
    for (size_t i = 0; i < r->n_refused; i++) {
        if (r->refused[i].method == method &&
            strcmp(r->refused[i].reason, reason) == 0) {
            r->refused[i].rows += rows;
            return CLI_DONE;
        }
    }
    copy = strdup(reason);
    grown = realloc(r->refused, (r->n_refused + 1) * sizeof *grown);
    if (grown)
        r->refused = grown;
    if (!grown || !copy) {
        free(copy);
        return cli_no_memory();
    }
    grown[r->n_refused++] = (refused_count){method, copy, rows};
    return CLI_DONE;
}

int record_add(record *r, const record *more) {
    int rc = CLI_DONE;

    r->rows += more->rows;
    if (more->n_used)
        widen(r, more->min_orders, more->max_orders, more->worst_error,
              more->estimated);
    for (size_t i = 0; i < more->n_used && rc == CLI_DONE; i++)
        rc = count_used(r, &more->used[i]);
    for (size_t i = 0; i < more->n_refused && rc == CLI_DONE; i++)
        rc = record_refused(r, more->refused[i].method, more->refused[i].reason,
                            more->refused[i].rows);
    return rc;
}

void record_report(const record *r) {
    for (size_t i = 0; i < r->n_refused; i++) {
        const refused_count *one = &r->refused[i];
        const char *plural = one->rows == 1 ? "" : "s";
        if (one->method)
            cli_note("method '%s' refused %" PRIu64 " row%s: %s", one->method->name,
                     one->rows, plural, one->reason);
        else
            cli_note("%" PRIu64 " row%s refused: %s", one->rows, plural, one->reason);
    }
}

void record_free(record *r) {
    for (size_t i = 0; i < r->n_refused; i++)
        free(r->refused[i].reason);
    free(r->refused);
    free(r->used);
    *r = (record){0};
}

/* ---- as text ---- */

char *record_write(const record *r) {
    json_t *used = json_array(), *refused = json_array(), *all;
    char *text;

    for (size_t i = 0; i < r->n_used; i++) {
        const used_count *u = &r->used[i];
        json_array_append_new(used, json_pack("[s,i,i,b,I]", u->method->name,
                                              u->streams, (int)u->nodes,
                                              (int)u->delta_m, (json_int_t)u->outputs));
    }
    for (size_t i = 0; i < r->n_refused; i++) {
        const refused_count *f = &r->refused[i];
        json_array_append_new(refused, json_pack("[s,s,I]", f->method->name, f->reason,
                                                 (json_int_t)f->rows));
    }
    all = json_pack("[I,o,o,i,i,f,b]", (json_int_t)r->rows, used, refused,
                    r->min_orders, r->max_orders, r->worst_error, (int)r->estimated);
    text = all ? json_dumps(all, JSON_COMPACT) : NULL;
    json_decref(all);
    return text;
}

static int read_used(record *r, json_t *entry) {
    const char *name;
    int streams, nodes, delta_m;
    json_int_t outputs;
    used_count count;

    if (json_unpack(entry, "[s,i,i,b,I!]", &name, &streams, &nodes, &delta_m, &outputs))
        return CLI_FAILED;
    count = (used_count){pps_method_find(name), streams, (pps_nodes)nodes, delta_m,
                         (uint64_t)outputs};
    if (!count.method || nodes < 0 || nodes > PPS_NODES_GRADED)
        return CLI_FAILED;
    return count_used(r, &count);
}

static int read_refused(record *r, json_t *entry) {
    const char *name, *reason;
    json_int_t rows;

    if (json_unpack(entry, "[s,s,I!]", &name, &reason, &rows) || !pps_method_find(name))
        return CLI_FAILED;
    return record_refused(r, pps_method_find(name), reason, (uint64_t)rows);
}

int record_read(record *r, const char *text) {
    json_t *all = json_loads(text, 0, NULL), *used, *refused, *entry;
    json_int_t rows;
    size_t i;
    int estimated, rc = CLI_FAILED;

    *r = (record){0};
    if (all &&
        json_unpack(all, "[I,o,o,i,i,F,b!]", &rows, &used, &refused, &r->min_orders,
                    &r->max_orders, &r->worst_error, &estimated) == 0) {
        rc = CLI_DONE;
        r->rows = (uint64_t)rows;
        r->estimated = estimated;
        json_array_foreach(used, i, entry) rc = rc ? rc : read_used(r, entry);
        json_array_foreach(refused, i, entry) rc = rc ? rc : read_refused(r, entry);
    }
    json_decref(all);
    return rc;
}
