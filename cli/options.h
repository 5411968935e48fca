/* The subcommands and their options as tables, and reading a command line by them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_OPTIONS_H
#define PPSCAT_CLI_OPTIONS_H

#include <stdbool.h>

typedef enum {
#define SUBCOMMAND(id, name, words, operand, summary, notes) SUB_##id,
#include "subcommands.def"
#undef SUBCOMMAND
    SUB_COUNT
} subcommand_id;

typedef enum {
#define OPTION(id, name, letter, metavar, fallback, subcommands, help) OPT_##id,
#include "options.def"
#undef OPTION
    OPT_COUNT
} option_id;

typedef struct {
    const char *name, *operand, *summary, *notes;
} subcommand_spec;

typedef struct {
    const char *name, *metavar, *fallback, *help;
    unsigned subcommands; /* bit 1 << subcommand_id */
    char letter;          /* 0 where there is none */
} option_spec;

extern const subcommand_spec subcommand_table[SUB_COUNT];
extern const option_spec option_table[OPT_COUNT];

/* A command line taken apart; the texts belong to argv. */
typedef struct invocation {
    subcommand_id subcommand;
    int argc; /* the whole command line, for the record */
    char *const *argv;
    const char *text[OPT_COUNT]; /* as given, "" for a flag; NULL where not given */
    const char *operand;         /* NULL where not given */
} invocation;

/* The words that name it: "flux" has 1, "tree grow" 2. */
int subcommand_words(subcommand_id id);

/* Read the options of a subcommand, what follows its words; texts are not judged here. */
int options_read(subcommand_id subcommand, int argc, char *const *argv,
                 invocation *out);

/* What was given, else the default. */
const char *option_text(const invocation *call, option_id id);

bool option_given(const invocation *call, option_id id);

bool option_taken_by(option_id id, subcommand_id subcommand);

/* The next of the words between bars in a metavar, *length letters; NULL at the end.
 * Start with *at = metavar. */
const char *option_next_word(const char **at, int *length);

#endif
