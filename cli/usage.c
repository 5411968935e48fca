/* The texts of --help.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "usage.h"

#include <stdio.h>
#include <string.h>

#include "columns.h"

enum { LINE = 79, OPTION_INDENT = 30, COLUMN_INDENT = 26, SUMMARY_INDENT = 26 };

/* Print words from column `at` on, broken before LINE and indented. Returns the column
 * reached. */
static int wrap(FILE *file, int at, int indent, const char *text) {
    bool first = true;

    while (*text) {
        int length = (int)strcspn(text, " ");
        if (!first && at + 1 + length > LINE) {
            fprintf(file, "\n%*s", indent, "");
            at = indent;
        } else if (!first) {
            fputc(' ', file);
            at++;
        }
        fprintf(file, "%.*s", length, text);
        at += length;
        text += length;
        text += *text == ' ';
        first = false;
    }
    return at;
}

/* Pad to a column, on a new line where it is passed already. */
static void pad(FILE *file, int at, int target) {
    if (at + 2 > target) {
        fputc('\n', file);
        at = 0;
    }
    fprintf(file, "%*s", target - at, "");
}

static void paragraph(FILE *file, const char *text) {
    wrap(file, 0, 0, text);
    fputs("\n", file);
}

static void print_option(FILE *file, const option_spec *spec) {
    char fallback[80] = "";
    const char *text = spec->fallback;
    int at;

    if (spec->letter)
        at = fprintf(file, "  -%c, --%s", spec->letter, spec->name);
    else
        at = fprintf(file, "      --%s", spec->name);
    if (spec->metavar)
        at += fprintf(file, " %s", spec->metavar);
    pad(file, at, OPTION_INDENT);
    at = wrap(file, OPTION_INDENT, OPTION_INDENT, spec->help);
    if (text) {
        int paren = text[0] == '(';
        snprintf(fallback, sizeof fallback, "[%.*s]", (int)strlen(text) - 2 * paren,
                 text + paren);
        if (at + 1 + (int)strlen(fallback) > LINE)
            fprintf(file, "\n%*s", OPTION_INDENT - 1, "");
        fprintf(file, " %s", fallback);
    }
    fputc('\n', file);
}

static void print_columns(FILE *file, subcommand_id id) {
    if (columns_of(id)->name)
        fputs("\nColumns:\n", file);
    for (const column *c = columns_of(id); c->name; c++) {
        bool unit = c->unit && strcmp(c->unit, "1") != 0;
        int at = fprintf(file, "  %s", c->name);
        if (unit)
            at += fprintf(file, ", %s", c->unit);
        pad(file, at, COLUMN_INDENT);
        wrap(file, COLUMN_INDENT, COLUMN_INDENT, c->description);
        fputc('\n', file);
    }
}

void usage_subcommand(FILE *file, subcommand_id id) {
    const subcommand_spec *spec = &subcommand_table[id];

    fprintf(file, "Usage: ppscat %s%s%s [OPTION]...\n", spec->name,
            spec->operand[0] ? " " : "", spec->operand);
    if (columns_of(id)->name)
        fprintf(file, "Print %s, as CSV.\n\n", spec->summary);
    else
        fprintf(file, "Make %s.\n\n", spec->summary);
    paragraph(file, spec->notes);
    fputs("\nOptions, with [defaults]:\n", file);
    for (int i = 0; i < OPT_COUNT; i++) {
        if (option_taken_by((option_id)i, id))
            print_option(file, &option_table[i]);
    }
    if (option_taken_by(OPT_METHOD, id)) {
        fputs("\n", file);
        paragraph(
            file,
            "A LIST has items separated by commas: numbers, lo:hi:n (n evenly spaced "
            "numbers, both ends in) or lo:hi:nlog (the same logarithmically). The "
            "rows are the product of all lists.");
    }
    print_columns(file, id);
}

void usage_program(FILE *file) {
    fputs("Usage: ppscat SUBCOMMAND [OPTION]...\n"
          "Scattering in plane-parallel media, exactly and in closed form.\n\n"
          "Subcommands:\n",
          file);
    for (int i = 0; i < SUB_COUNT; i++) {
        const subcommand_spec *spec = &subcommand_table[i];
        int at = fprintf(file, "  %s%s%s", spec->name, spec->operand[0] ? " " : "",
                         spec->operand);
        pad(file, at, SUMMARY_INDENT);
        wrap(file, SUMMARY_INDENT, SUMMARY_INDENT, spec->summary);
        fputc('\n', file);
    }
    fputs("\n'ppscat SUBCOMMAND --help' lists the options and columns of one.\n"
          "Exit status: 0 done, 3 done but some rows refused (empty), 2 bad usage or\n"
          "input, 1 anything else.\n",
          file);
}
