/* FILE.part-journal.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "journal.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <jansson.h>

#include "cli.h"
#include "store.h"

static const char format[] = "ppscat journal 1";

/* Options that say where and how fast, not what. */
static bool matters(option_id id) {
    switch (id) {
    case OPT_OUTPUT:
    case OPT_RESUME:
    case OPT_JOBS:
    case OPT_PROGRESS:
    case OPT_EXPLAIN:
    case OPT_DEFLATE:
    case OPT_HELP:
    case OPT_VERSION:
        return false;
    default:
        return true;
    }
}

int journal_tail(int fd, uint64_t bytes, uint64_t *tail) {
    size_t n = bytes < JOURNAL_TAIL ? (size_t)bytes : JOURNAL_TAIL;
    unsigned char *data = malloc(n + 1);
    uint64_t hash = UINT64_C(14695981039346656037); /* FNV-1a */
    size_t got = 0;

    while (data && got < n) {
        ssize_t more = pread(fd, data + got, n - got, (off_t)(bytes - n + got));
        if (more <= 0 && !(more < 0 && errno == EINTR))
            break;
        got += more > 0 ? (size_t)more : 0;
    }
    for (size_t i = 0; i < got; i++)
        hash = (hash ^ data[i]) * UINT64_C(1099511628211);
    free(data);
    *tail = hash;
    return got == n ? CLI_DONE : CLI_FAILED;
}

/* ---- writing ---- */

static json_t *json_options(const invocation *call) {
    json_t *object = json_object();

    for (int i = 0; i < OPT_COUNT; i++) {
        option_id id = (option_id)i;
        const char *text = option_text(call, id);
        if (option_taken_by(id, call->subcommand) && matters(id) && text)
            json_object_set_new(object, option_table[i].name, json_string(text));
    }
    return object;
}

static json_t *json_point(const checkpoint *c) {
    char *text = record_write(&c->record);
    char tail[20];
    json_t *json = NULL;

    snprintf(tail, sizeof tail, "%016" PRIx64, c->tail);
    if (text)
        json = json_pack("{s:I, s:I, s:s, s:I, s:s}", "units", (json_int_t)c->units,
                         "bytes", (json_int_t)c->bytes, "tail", tail, "rows",
                         (json_int_t)c->record.rows, "record", text);
    free(text);
    return json;
}

static json_t *json_journal(const invocation *call, const checkpoint *latest,
                            const checkpoint *safe) {
    json_t *points = json_array();

    json_array_append_new(points, json_point(latest));
    if (safe->bytes && safe->bytes != latest->bytes)
        json_array_append_new(points, json_point(safe));
    return json_pack("{s:s, s:s, s:s, s:o, s:o}", "format", format, "version",
                     pps_version(), "subcommand",
                     subcommand_table[call->subcommand].name, "options",
                     json_options(call), "checkpoints", points);
}

static bool dump(const json_t *json, const char *path, bool sync) {
    FILE *file = fopen(path, "w");
    bool good;

    if (!file)
        return false;
    good = json_dumpf(json, file, JSON_INDENT(1) | JSON_PRESERVE_ORDER) == 0;
    good = fputc('\n', file) != EOF && good;
    good = fflush(file) == 0 && good;
    if (sync)
        good = fdatasync(fileno(file)) == 0 && good;
    return fclose(file) == 0 && good;
}

int journal_write(const char *path, const invocation *call, const checkpoint *latest,
                  const checkpoint *safe, bool sync) {
    json_t *json = json_journal(call, latest, safe);
    size_t size = strlen(path) + sizeof ".new";
    char *fresh = malloc(size);
    int rc = CLI_DONE;

    if (!json || !fresh) {
        rc = cli_no_memory();
    } else {
        snprintf(fresh, size, "%s.new", path);
        if (!dump(json, fresh, sync) || rename(fresh, path) != 0) {
            rc = cli_failed("cannot write %.200s: %s", path, strerror(errno));
            unlink(fresh);
        }
    }
    free(fresh);
    json_decref(json);
    return rc;
}

/* ---- reading ---- */

static int read_point(const json_t *json, checkpoint *c) {
    json_int_t units, bytes, rows;
    const char *tail, *text;

    if (json_unpack((json_t *)json, "{s:I, s:I, s:s, s:I, s:s}", "units", &units,
                    "bytes", &bytes, "tail", &tail, "rows", &rows, "record", &text))
        return CLI_FAILED;
    *c = (checkpoint){.units = (uint64_t)units,
                      .bytes = (uint64_t)bytes,
                      .tail = strtoull(tail, NULL, 16)};
    return units < 0 || bytes < 0 ? CLI_FAILED : record_read(&c->record, text);
}

static const char *text_at(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));

    return text ? text : "";
}

/* Say in what the run of the journal differs from this one. */
static int compare(const char *path, const json_t *journal, const invocation *call) {
    const char *name = subcommand_table[call->subcommand].name;
    json_t *options = json_object_get(journal, "options");

    if (strcmp(text_at(journal, "version"), pps_version()) != 0)
        return cli_usage("--resume: '%.200s' is of ppscat %.20s, this is %s; allowed: "
                         "the same version, or remove the file to begin anew",
                         path, text_at(journal, "version"), pps_version());
    if (strcmp(text_at(journal, "subcommand"), name) != 0)
        return cli_usage("--resume: '%.200s' is of '%.20s', not of '%s'", path,
                         text_at(journal, "subcommand"), name);
    for (int i = 0; i < OPT_COUNT; i++) {
        option_id id = (option_id)i;
        const char *now = option_text(call, id), *then;
        if (!option_taken_by(id, call->subcommand) || !matters(id))
            continue;
        then = json_string_value(json_object_get(options, option_table[i].name));
        if (strcmp(now ? now : "", then ? then : "") != 0)
            return cli_usage("--resume: '%.200s' is of a run with --%s '%.60s', not "
                             "'%.60s'; allowed: the same options",
                             path, option_table[i].name, then ? then : "",
                             now ? now : "");
    }
    return CLI_DONE;
}

static json_t *load(const char *path) {
    json_t *json = json_load_file(path, JSON_ALLOW_NUL, NULL);

    if (json && strcmp(text_at(json, "format"), format) != 0) {
        json_decref(json);
        json = NULL;
    }
    return json;
}

int journal_read(const char *path, const invocation *call, checkpoint points[2],
                 int *n) {
    json_t *json, *array;
    int rc;

    *n = 0;
    if (access(path, F_OK) != 0)
        return CLI_DONE;
    json = load(path);
    if (!json)
        return cli_usage("--resume: '%.200s' is no journal of ppscat; remove it to "
                         "begin anew",
                         path);
    rc = compare(path, json, call);
    array = json_object_get(json, "checkpoints");
    for (size_t i = 0; rc == CLI_DONE && i < json_array_size(array) && i < 2; i++) {
        if (read_point(json_array_get(array, i), &points[*n]) == CLI_DONE)
            ++*n;
        else
            record_free(&points[*n].record);
    }
    json_decref(json);
    return rc;
}

bool journal_there(const char *path, uint64_t *rows) {
    json_t *json, *first;

    *rows = 0;
    if (access(path, F_OK) != 0)
        return false;
    json = load(path);
    first = json_array_get(json_object_get(json, "checkpoints"), 0);
    if (first)
        *rows = (uint64_t)json_integer_value(json_object_get(first, "rows"));
    json_decref(json);
    return true;
}
