/* Reading lists of numbers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "list.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"

enum { ITEM_SIZE = 128 };

/* A finite decimal number at the start of text; strtod alone would also take nan,
 * infinity, hexadecimal and leading spaces. */
static bool take_number(const char *text, const char **end, double *x) {
    char *stop;
    size_t length = strspn(text, "+-.0123456789eE");

    if (length == 0)
        return false;
    errno = 0;
    *x = strtod(text, &stop) + 0.0; /* -0 becomes 0 */
    *end = stop;
    if (stop == text || stop > text + length)
        return false;
    return errno != ERANGE || (isfinite(*x) && *x != 0);
}

bool list_read_number(const char *text, double *out) {
    const char *end;

    return take_number(text, &end, out) && *end == '\0';
}

static int reserve(number_list *list, size_t more) {
    double *value = realloc(list->value, (list->n + more) * sizeof *value);
    bool *share;

    if (!value)
        return CLI_FAILED;
    list->value = value;
    share = realloc(list->share, (list->n + more) * sizeof *share);
    if (!share)
        return CLI_FAILED;
    list->share = share;
    return CLI_DONE;
}

static void append(number_list *list, double x, bool share) {
    list->value[list->n] = x;
    list->share[list->n] = share;
    list->n++;
}

/* Number i of n evenly spaced ones; this form keeps 0:1:11 at 0.1, 0.2, .. */
static double even(double lo, double hi, size_t i, size_t n) {
    double below = (double)i, above = (double)(n - 1 - i), all = (double)(n - 1);

    if (fmax(fabs(lo), fabs(hi)) < 1e300)
        return (lo * above + hi * below) / all;
    return lo * (above / all) + hi * (below / all);
}

/* The colons and the count of a range; false unless it is spelt right. */
static bool take_range(const char *item, double *lo, double *hi, size_t *n,
                       bool *logs) {
    const char *at, *digits;
    char *end;
    long count;

    if (!take_number(item, &at, lo) || *at != ':' || !take_number(at + 1, &at, hi) ||
        *at != ':')
        return false;
    digits = at + 1;
    errno = 0;
    count = strtol(digits, &end, 10);
    if (end == digits || *digits < '0' || *digits > '9' || errno)
        return false;
    *logs = strcmp(end, "log") == 0;
    *n = (size_t)count;
    return *logs || *end == '\0';
}

static int read_range(const char *item, number_list *list, char *why, size_t size) {
    double lo, hi;
    size_t n;
    bool logs;

    if (!take_range(item, &lo, &hi, &n, &logs)) {
        snprintf(why, size, "'%.60s' is no range lo:hi:n or lo:hi:nlog", item);
        return CLI_USAGE;
    }
    if (n < 1 || n > LIST_MAX || (n == 1 && lo != hi)) {
        snprintf(why, size, "'%.60s' must have a count of 2 to %d, or 1 where lo = hi",
                 item, LIST_MAX);
        return CLI_USAGE;
    }
    if (logs && !(lo > 0 && hi > 0)) {
        snprintf(why, size, "'%.60s' must have both ends above 0", item);
        return CLI_USAGE;
    }
    if (reserve(list, n) != CLI_DONE)
        return CLI_FAILED;
    append(list, lo, false);
    for (size_t i = 1; i + 1 < n; i++) {
        double x =
            logs ? pow(10, even(log10(lo), log10(hi), i, n)) : even(lo, hi, i, n);
        append(list, x, false);
    }
    if (n > 1)
        append(list, hi, false);
    return CLI_DONE;
}

static int read_item(const char *item, unsigned allow, number_list *list, char *why,
                     size_t size) {
    const char *end;
    double x = INFINITY;
    bool inf = (allow & LIST_INF) && strcmp(item, "inf") == 0, share = false;

    if (*item == '\0') {
        snprintf(why, size, "'' is an empty item");
        return CLI_USAGE;
    }
    if (strchr(item, ':'))
        return read_range(item, list, why, size);
    if (!inf) {
        bool number = take_number(item, &end, &x);
        share = number && (allow & LIST_SHARE) && strcmp(end, "%") == 0;
        if (!number || (*end && !share)) {
            snprintf(why, size, "'%.60s' is no number", item);
            return CLI_USAGE;
        }
    }
    if (reserve(list, 1) != CLI_DONE)
        return CLI_FAILED;
    append(list, x, share);
    return CLI_DONE;
}

int list_read(const char *text, unsigned allow, number_list *out, char *why,
              size_t size) {
    char item[ITEM_SIZE];
    int rc = CLI_DONE;

    *out = (number_list){0};
    do {
        size_t length = strcspn(text, ",");
        if (length >= sizeof item || out->n >= LIST_MAX) {
            snprintf(why, size, "'%.60s' is too long", text);
            rc = CLI_USAGE;
            break;
        }
        memcpy(item, text, length);
        item[length] = '\0';
        rc = read_item(item, allow, out, why, size);
        text += length;
    } while (rc == CLI_DONE && *text++ == ',');
    if (rc == CLI_FAILED)
        cli_no_memory();
    if (rc != CLI_DONE)
        list_free(out);
    return rc;
}

void list_free(number_list *list) {
    free(list->value);
    free(list->share);
    *list = (number_list){0};
}
