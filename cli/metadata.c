/* The sidecar of a CSV file, by the W3C recommendation "Metadata Vocabulary for Tabular
 * Data". What the vocabulary has no word for goes under its property `notes`.
 *
 * Jansson's json_pack gives NULL when a part is NULL, so one check at the end finds
 * every failed allocation.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "metadata.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <jansson.h>

#include "cli.h"
#include "columns.h"

/* A file name or argument need not be UTF-8, JSON must be. */
static json_t *json_text(const char *text) {
    json_t *json = json_string(text);
    size_t size = strlen(text) + 1;
    char *plain = json ? NULL : malloc(size);

    if (plain) {
        memcpy(plain, text, size);
        for (char *c = plain; *c; c++) {
            if ((unsigned char)*c >= 0x80)
                *c = '?';
        }
        json = json_string(plain);
        free(plain);
    }
    return json;
}

static json_t *json_columns(const column *columns) {
    json_t *array = json_array();

    for (; columns->name; columns++) {
        /* clang-format off */
        json_t *entry = json_pack("{s:s, s:s, s:s, s:s}",
                                  "name", columns->name,
                                  "titles", columns->name,
                                  "datatype", columns->datatype,
                                  "dc:description", columns->description);
        /* clang-format on */
        if (columns->unit)
            json_object_set_new(entry, "schema:unitText", json_string(columns->unit));
        json_array_append_new(array, entry);
    }
    return array;
}

static json_t *json_command(const invocation *call) {
    json_t *array = json_array();

    for (int i = 0; i < call->argc; i++)
        json_array_append_new(array, json_text(i ? call->argv[i] : "ppscat"));
    return array;
}

static const char *nodes_name(pps_nodes nodes) {
    static const char *const names[] = {
        [PPS_NODES_AUTO] = "auto",
        [PPS_NODES_GAUSS] = "gauss",
        [PPS_NODES_MAPPED] = "mapped",
        [PPS_NODES_GRADED] = "graded",
    };

    return names[nodes];
}

/* Append a word that the array does not hold yet. */
static void add_word(json_t *words, const char *word) {
    for (size_t i = 0; i < json_array_size(words); i++) {
        if (strcmp(json_string_value(json_array_get(words, i)), word) == 0)
            return;
    }
    json_array_append_new(words, json_string(word));
}

static json_t *json_range(int lo, int hi) {
    return json_pack("{s:i, s:i}", "min", lo, "max", hi);
}

/* clang-format off */
static json_t *json_count(const used_count *count) {
    return json_pack("{s:s, s:i, s:s, s:b, s:I}",
                     "method", count->method->name,
                     "streams", count->streams,
                     "nodes", nodes_name(count->nodes),
                     "delta_m", (int)count->delta_m,
                     "outputs", (json_int_t)count->outputs);
}

/* Streams, orders, nodes and scaling over all outputs of the run. */
static json_t *json_used(const record *done) {
    json_t *counts = json_array(), *nodes = json_array(), *scaled = json_array();
    json_t *worst = done->estimated ? json_real(done->worst_error) : NULL;
    int lo = done->used[0].streams, hi = lo;

    for (size_t i = 0; i < done->n_used; i++) {
        const used_count *count = &done->used[i];
        lo = count->streams < lo ? count->streams : lo;
        hi = count->streams > hi ? count->streams : hi;
        add_word(nodes, nodes_name(count->nodes));
        add_word(scaled, count->delta_m ? "on" : "off");
        json_array_append_new(counts, json_count(count));
    }
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}",
                     "streams", json_range(lo, hi),
                     "orders", json_range(done->min_orders, done->max_orders),
                     "nodes", nodes,
                     "delta_m", scaled,
                     "worst_error_estimate", worst ? worst : json_null(),
                     "counts", counts);
}

static json_t *json_notes(const invocation *call, const char *date,
                          const record *done) {
    return json_pack("{s:s, s:s, s:s, s:o, s:s, s:I, s:I, s:o}",
                     "program", "ppscat",
                     "version", pps_version(),
                     "subcommand", subcommand_table[call->subcommand].name,
                     "command", json_command(call),
                     "date", date,
                     "rows", (json_int_t)done->rows,
                     "refused_rows", (json_int_t)done->refused_rows,
                     "used", done->n_used ? json_used(done) : json_null());
}

static json_t *json_sidecar(const char *csv_path, const invocation *call,
                            const char *date, json_t *notes) {
    const char *slash = strrchr(csv_path, '/');
    json_t *columns = json_columns(columns_of(call->subcommand));
    char creator[64];

    snprintf(creator, sizeof creator, "ppscat %s", pps_version());
    return json_pack("{s:s, s:o, s:s, s:s, s:{s:o}, s:[o]}",
                     "@context", "http://www.w3.org/ns/csvw",
                     "url", json_text(slash ? slash + 1 : csv_path),
                     "dc:creator", creator,
                     "dc:date", date,
                     "tableSchema", "columns", columns,
                     "notes", notes);
}
/* clang-format on */

void metadata_date(char text[DATE_SIZE]) {
    time_t now = time(NULL);
    struct tm utc;

    text[0] = '\0';
    if (gmtime_r(&now, &utc))
        strftime(text, DATE_SIZE, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

/* Write to `part`, then give it its name. */
static int write_json(const json_t *json, const char *part, const char *path) {
    FILE *file = fopen(part, "w");
    bool good;

    if (!file)
        return cli_failed("cannot write '%.200s': %s", part, strerror(errno));
    good = json_dumpf(json, file, JSON_INDENT(2) | JSON_PRESERVE_ORDER) == 0;
    good = fputc('\n', file) != EOF && good;
    good = fclose(file) == 0 && good;
    if (good && rename(part, path) == 0)
        return CLI_DONE;
    cli_failed("cannot write '%.200s': %s", path, strerror(errno));
    unlink(part);
    return CLI_FAILED;
}

char *metadata_notes(const invocation *call, const record *done) {
    char date[DATE_SIZE];
    json_t *json;
    char *text;

    metadata_date(date);
    json = json_notes(call, date, done);
    text = json ? json_dumps(json, JSON_COMPACT | JSON_PRESERVE_ORDER) : NULL;
    json_decref(json);
    return text;
}

int metadata_write(const char *csv_path, const invocation *call, const record *done) {
    size_t size = strlen(csv_path) + sizeof "-metadata.json.part";
    char *path = malloc(size), *part = malloc(size);
    char date[DATE_SIZE];
    json_t *json;
    int rc;

    metadata_date(date);
    json = json_sidecar(csv_path, call, date, json_notes(call, date, done));
    if (path && part && json) {
        snprintf(path, size, "%s-metadata.json", csv_path);
        snprintf(part, size, "%s-metadata.json.part", csv_path);
        rc = write_json(json, part, path);
    } else {
        rc = cli_no_memory();
    }
    json_decref(json);
    free(part);
    free(path);
    return rc;
}
