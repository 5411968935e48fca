/* Reading the text of one option, by one table of what each number may be.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "values.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"
#include "csv.h"
#include "system.h"

/* What a number may be. */
typedef struct {
    option_id id;
    unsigned allow; /* of list_read */
    double lo, hi;
    bool lo_open, hi_open; /* that end is not allowed itself */
    double never;          /* a value between that is not allowed; NAN: none */
    const char *allowed;
} number_rule;

static const number_rule rules[] = {
    {OPT_ALBEDO, 0, 0, 1, false, false, NAN, "numbers from 0 to 1"},
    {OPT_G, 0, -1, 1, true, true, NAN, "numbers between -1 and 1, ends excluded"},
    {OPT_THICKNESS, LIST_INF, 0, INFINITY, true, false, NAN, "numbers above 0, or inf"},
    {OPT_MU0, 0, 0, 1, true, false, NAN, "numbers above 0, up to 1"},
    {OPT_THETA0, 0, 0, 90, false, true, NAN, "degrees from 0 up to but not 90"},
    {OPT_DEPTH, LIST_SHARE, 0, INFINITY, false, false, NAN,
     "depths from 0 to the thickness, or shares from 0% to 100%"},
    {OPT_MU, 0, -1, 1, false, false, 0, "numbers from -1 to 1, never 0"},
    {OPT_THETA, 0, 0, 180, false, false, 90, "degrees from 0 to 180, never 90"},
    {OPT_PHI, 0, -INFINITY, INFINITY, false, false, NAN, "degrees"},
    {OPT_BEAM, 0, 0, INFINITY, false, false, NAN, "one number, 0 or more"},
    {OPT_SKY, 0, 0, INFINITY, false, false, NAN, "one number, 0 or more"},
    {OPT_GROUND, 0, 0, 1, false, false, NAN, "one number from 0 to 1"},
    {OPT_LEAF_AREA_INDEX, 0, 0, 1e6, true, false, NAN, "one number above 0"},
    {OPT_EXPOSURE, 0, 0, INFINITY, true, true, NAN, "one number above 0"},
    {OPT_TOL, 0, 0, 1, true, true, NAN, "one number between 0 and 1, ends excluded"},
};

static const number_rule *rule_of(option_id id) {
    const number_rule *rule = rules;

    while (rule->id != id)
        rule++;
    return rule;
}

static bool allowed(const number_rule *rule, double x) {
    return x >= rule->lo && x <= rule->hi && !(rule->lo_open && x == rule->lo) &&
           !(rule->hi_open && x == rule->hi) && x != rule->never;
}

/* `what` is wrong with the option's value. */
int value_refuse(option_id id, const char *what) {
    return cli_usage("--%s: %s; allowed: %s", option_table[id].name, what,
                     rule_of(id)->allowed);
}

static int refuse_number(option_id id, double x, const char *unit) {
    char what[80], number[CSV_NUMBER_SIZE];

    csv_format(x, number);
    snprintf(what, sizeof what, "'%s%s' is out of range", number, unit);
    return value_refuse(id, what);
}

static int check_list(option_id id, const number_list *list) {
    for (size_t i = 0; i < list->n; i++) {
        double x = list->value[i];
        if (!allowed(rule_of(id), x) || (list->share[i] && x > 100))
            return refuse_number(id, x, list->share[i] ? "%" : "");
    }
    return CLI_DONE;
}

int value_list(option_id id, const char *text, number_list *out) {
    char why[160];
    int rc = list_read(text, rule_of(id)->allow, out, why, sizeof why);

    if (rc == CLI_USAGE)
        return value_refuse(id, why);
    return rc == CLI_DONE ? check_list(id, out) : rc;
}

int value_number(const invocation *call, option_id id, double *out) {
    const char *text = option_text(call, id);
    char what[80];

    snprintf(what, sizeof what, "'%.40s' is no number", text);
    if (!list_read_number(text, out))
        return value_refuse(id, what);
    return allowed(rule_of(id), *out) ? CLI_DONE : refuse_number(id, *out, "");
}

/* Which of the words in the option's metavar was given: 0, 1, .. */
int value_choice(const invocation *call, option_id id, int *out) {
    const char *text = option_text(call, id), *at = option_table[id].metavar, *word;
    int length;

    for (*out = 0; (word = option_next_word(&at, &length)); ++*out) {
        if ((size_t)length == strlen(text) && strncmp(word, text, (size_t)length) == 0)
            return CLI_DONE;
    }
    return cli_usage("--%s: unknown value '%.60s'; allowed: %s", option_table[id].name,
                     text, option_table[id].metavar);
}

bool value_whole(const char *text, long lo, long hi, int *out) {
    char *end;
    long x;

    errno = 0;
    x = strtol(text, &end, 10);
    *out = (int)x;
    return *text >= '0' && *text <= '9' && *end == '\0' && !errno && x >= lo && x <= hi;
}

int value_count(const invocation *call, option_id id, uint64_t lo, uint64_t hi,
                uint64_t *out) {
    const char *text = option_text(call, id);
    char *end;
    unsigned long long count;

    errno = 0;
    count = strtoull(text, &end, 10);
    *out = count;
    if (*text < '0' || *text > '9' || *end || errno || count < lo || count > hi)
        return cli_usage(
            "--%s: '%.60s' is not possible; allowed: whole numbers from %" PRIu64
            " to %" PRIu64,
            option_table[id].name, text, lo, hi);
    return CLI_DONE;
}

int value_pair(const invocation *call, option_id id, double out[2]) {
    const char *text = option_text(call, id), *comma = strchr(text, ',');
    char first[40];

    if (comma && comma - text < (long)sizeof first) {
        snprintf(first, sizeof first, "%.*s", (int)(comma - text), text);
        if (list_read_number(first, &out[0]) && list_read_number(comma + 1, &out[1]))
            return CLI_DONE;
    }
    return cli_usage("--%s: '%.60s' is not possible; allowed: two numbers, %s",
                     option_table[id].name, text, option_table[id].metavar);
}

enum { MAX_THREADS = 4096 };

int value_threads(const invocation *call, int *out) {
    const char *text = call->text[OPT_JOBS];

    *out = system_cores();
    if (text && !value_whole(text, 1, MAX_THREADS, out))
        return cli_usage(
            "--jobs: '%.60s' is not possible; allowed: whole numbers from 1 to %d",
            text, MAX_THREADS);
    return CLI_DONE;
}

int value_progress(const invocation *call, bool *out) {
    int choice = 0, rc = value_choice(call, OPT_PROGRESS, &choice);

    *out = choice == 0 ? isatty(STDERR_FILENO) : choice == 1;
    return rc;
}
