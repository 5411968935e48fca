/* The tables of subcommands and options, and reading a command line by them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"

#define IN(id) (1u << SUB_##id)

const subcommand_spec subcommand_table[SUB_COUNT] = {
#define SUBCOMMAND(id, name, words, operand, summary, notes)                           \
    {words, operand, summary, notes},
#include "subcommands.def"
#undef SUBCOMMAND
};

const option_spec option_table[OPT_COUNT] = {
#define OPTION(id, name, letter, metavar, fallback, subcommands, help)                 \
    {name, metavar, fallback, help, subcommands, letter},
#include "options.def"
#undef OPTION
};

/* getopt_long returns these for long options, so that they are no letters. */
enum { FIRST_ID = 256 };

static void fill_getopt(struct option *longs, char *shorts) {
    *shorts++ = ':'; /* a missing argument is told from an unknown option */
    for (int i = 0; i < OPT_COUNT; i++) {
        const option_spec *spec = &option_table[i];
        longs[i] =
            (struct option){spec->name, spec->metavar ? required_argument : no_argument,
                            NULL, FIRST_ID + i};
        if (spec->letter)
            *shorts++ = spec->letter;
        if (spec->letter && spec->metavar)
            *shorts++ = ':';
    }
    longs[OPT_COUNT] = (struct option){0};
    *shorts = '\0';
}

/* The option that getopt_long means by its return value; OPT_COUNT for none. */
static int option_by_code(int code) {
    for (int i = 0; i < OPT_COUNT; i++) {
        if (code == FIRST_ID + i || (code && code == option_table[i].letter))
            return i;
    }
    return OPT_COUNT;
}

static int unknown_option(const invocation *call, const char *given) {
    const char *names[OPT_COUNT], *closest;
    char word[64];
    size_t n = 0;

    for (int i = 0; i < OPT_COUNT; i++) {
        if (option_taken_by((option_id)i, call->subcommand))
            names[n++] = option_table[i].name;
    }
    snprintf(word, sizeof word, "%s", given + strspn(given, "-"));
    word[strcspn(word, "=")] = '\0';
    closest = cli_closest(word, n, names);
    return cli_usage(
        "unknown option '%.60s'; %s%s%s'ppscat %s --help' lists the options", given,
        closest ? "did you mean --" : "", closest ? closest : "", closest ? "? " : "",
        subcommand_table[call->subcommand].name);
}

/* What getopt_long could not read. */
static int refuse(const invocation *call, int code, int bad_code, const char *given) {
    int id = option_by_code(bad_code);
    const char letter[] = {'-', (char)bad_code, '\0'};

    if (code == ':' && id < OPT_COUNT)
        return cli_usage("--%s needs a value: %s", option_table[id].name,
                         option_table[id].metavar);
    if (id < OPT_COUNT)
        return cli_usage("--%s takes no value", option_table[id].name);
    return unknown_option(call, bad_code ? letter : given);
}

static int store(invocation *call, int id, const char *text) {
    const option_spec *spec = &option_table[id];

    if (!option_taken_by((option_id)id, call->subcommand))
        return cli_usage(
            "--%s is no option of '%s'; 'ppscat %s --help' lists those it has",
            spec->name, subcommand_table[call->subcommand].name,
            subcommand_table[call->subcommand].name);
    call->text[id] = text ? text : "";
    return CLI_DONE;
}

static int take_operand(invocation *call, int n, char **operand) {
    const subcommand_spec *spec = &subcommand_table[call->subcommand];
    int allowed = spec->operand[0] != '\0';

    if (n > allowed)
        return cli_usage(
            "unexpected argument '%.60s'; '%s' takes %s%s beside its options",
            operand[allowed], spec->name, allowed ? "one " : "none", spec->operand);
    call->operand = n ? operand[0] : NULL;
    return CLI_DONE;
}

/* getopt_long moves operands behind the options: `order` is its own copy. */
static int read_all(invocation *call, char **order) {
    struct option longs[OPT_COUNT + 1];
    char shorts[2 * OPT_COUNT + 2];
    int code, rc;

    fill_getopt(longs, shorts);
    opterr = 0; /* messages are ours: one line, the same style everywhere */
    optind = 1 + subcommand_words(call->subcommand);
    while ((code = getopt_long(call->argc, order, shorts, longs, NULL)) != -1) {
        if (code == '?' || code == ':')
            return refuse(call, code, optopt, order[optind - 1]);
        rc = store(call, option_by_code(code), optarg);
        if (rc != CLI_DONE)
            return rc;
    }
    return take_operand(call, call->argc - optind, order + optind);
}

int options_read(subcommand_id subcommand, int argc, char *const *argv,
                 invocation *out) {
    size_t size = ((size_t)argc + 1) * sizeof *argv;
    char **order = malloc(size);
    int rc;

    *out = (invocation){.subcommand = subcommand, .argc = argc, .argv = argv};
    if (!order)
        return cli_no_memory();
    memcpy(order, argv, size);
    rc = read_all(out, order);
    free(order);
    return rc;
}

const char *option_text(const invocation *call, option_id id) {
    return call->text[id] ? call->text[id] : option_table[id].fallback;
}

bool option_given(const invocation *call, option_id id) {
    return call->text[id] != NULL;
}

bool option_taken_by(option_id id, subcommand_id subcommand) {
    return (option_table[id].subcommands >> subcommand & 1u) != 0;
}

int subcommand_words(subcommand_id id) {
    return strchr(subcommand_table[id].name, ' ') ? 2 : 1;
}

const char *option_next_word(const char **at, int *length) {
    const char *word = *at;

    if (!word || !*word)
        return NULL;
    *length = (int)strcspn(word, "|");
    *at = word + *length + (word[*length] == '|');
    return word;
}
