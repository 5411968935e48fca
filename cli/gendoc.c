/* Build-time: the man page and the shell completion, from the program's own tables.
 *
 *     ppscat-gendoc man VERSION > ppscat.1
 *     ppscat-gendoc bash        > ppscat
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "options.h"

/* Text for roff: no line begins with a control character, minus signs stay what they
 * are. */
static void roff(const char *text) {
    if (*text == '.' || *text == '\'')
        fputs("\\&", stdout);
    for (; *text; text++) {
        if (*text == '-')
            fputs("\\-", stdout);
        else if (*text == '\\')
            fputs("\\e", stdout);
        else
            putchar(*text);
    }
}

static void man_option(const option_spec *spec) {
    fputs(".TP\n.B ", stdout);
    if (spec->letter)
        printf("\\-%c, ", spec->letter);
    fputs("\\-\\-", stdout);
    roff(spec->name);
    if (spec->metavar)
        printf(" \\fI%s\\fR", spec->metavar);
    putchar('\n');
    roff(spec->help);
    if (spec->fallback) {
        const char *text = spec->fallback;
        size_t paren = text[0] == '(';
        char plain[80];
        snprintf(plain, sizeof plain, "%.*s", (int)(strlen(text) - 2 * paren),
                 text + paren);
        fputs(".\nDefault: ", stdout);
        roff(plain);
    }
    fputs(".\n", stdout);
}

/* "field, flux, error" */
static void man_takers(option_id id) {
    const char *comma = "";

    fputs("Subcommands: ", stdout);
    for (int i = 0; i < SUB_COUNT; i++) {
        if (option_taken_by(id, (subcommand_id)i)) {
            printf("%s%s", comma, subcommand_table[i].name);
            comma = ", ";
        }
    }
    fputs(".\n", stdout);
}

static void man_subcommand(subcommand_id id) {
    const subcommand_spec *spec = &subcommand_table[id];

    printf(".TP\n.B %s%s%s\n", spec->name, spec->operand[0] ? " " : "", spec->operand);
    fputs(columns_of(id)->name ? "Print " : "Make ", stdout);
    roff(spec->summary);
    fputs(".\n", stdout);
    roff(spec->notes);
    fputs("\n.RS\n", stdout);
    for (const column *c = columns_of(id); c->name; c++) {
        fputs(".TP\n.I ", stdout);
        roff(c->name);
        putchar('\n');
        roff(c->description);
        if (c->unit && strcmp(c->unit, "1") != 0)
            printf(" (%s)", c->unit);
        fputs(".\n", stdout);
    }
    fputs(".RE\n", stdout);
}

static void man_page(const char *version) {
    printf(".TH PPSCAT 1 \"\" \"ppscat %s\" \"User Commands\"\n", version);
    fputs(
        ".SH NAME\n"
        "ppscat \\- scattering in plane-parallel media, exactly and in closed form\n"
        ".SH SYNOPSIS\n.B ppscat\n.I SUBCOMMAND\n.RI [ OPTION ]...\n"
        ".SH DESCRIPTION\n"
        "Directional fields and fluxes of a homogeneous plane-parallel medium with a\n"
        "Henyey-Greenstein phase function, lit by a beam. Results are CSV on standard\n"
        "output, everything else goes to standard error.\n"
        ".SH SUBCOMMANDS\nColumns are listed under each.\n",
        stdout);
    for (int i = 0; i < SUB_COUNT; i++)
        man_subcommand((subcommand_id)i);
    fputs(".SH OPTIONS\n"
          "A LIST has items separated by commas: numbers, lo:hi:n (n evenly spaced\n"
          "numbers, both ends in) or lo:hi:nlog (the same logarithmically). The rows "
          "are\n"
          "the product of all lists, the last column running fastest.\n",
          stdout);
    for (int i = 0; i < OPT_COUNT; i++) {
        man_option(&option_table[i]);
        man_takers((option_id)i);
    }
    fputs(
        ".SH \"EXIT STATUS\"\n"
        ".TP\n.B 0\nDone.\n"
        ".TP\n.B 3\nDone, but some rows were refused: their values are empty, the "
        "reason\n"
        "is on standard error.\n"
        ".TP\n.B 2\nBad usage or bad input: one line names the option, the value and "
        "what\n"
        "is allowed.\n"
        ".TP\n.B 1\nAnything else: no memory, a full disk, a closed pipe.\n"
        ".TP\n.BR 130 \", \" 143 \", \" 129\n"
        "Stopped by SIGINT (Ctrl\\-C), SIGTERM or SIGHUP, within a second; ppscat ends "
        "by\n"
        "the signal itself, which a shell shows as 128 and its number. A sweep into a\n"
        "file (\\-o) keeps what is done, and the last line on standard error is the\n"
        "command that goes on: the same with \\-\\-resume. After a full disk (1), a "
        "lost\n"
        "rank of MPI (1) or a kill (137) that command goes on as well.\n"
        ".SH FILES\n"
        ".TP\n.IR FILE.part \", \" FILE.part\\-values \", \" FILE.part\\-journal\n"
        "What a sweep into FILE has done so far; gone when FILE is complete. To begin\n"
        "anew, delete them.\n"
        ".TP\n.I FILE\\-metadata.json\n"
        "What the columns of FILE are (W3C CSV on the Web), the version, the command\n"
        "line, the date, and the streams, orders and nodes that were used.\n"
        ".SH EXAMPLE\n.nf\n"
        "ppscat field \\-\\-method exact,spp \\-\\-albedo 0.9 \\-\\-theta0 30 \\-o "
        "field.csv\n"
        ".fi\n",
        stdout);
}

/* The words between bars that are values, not placeholders such as N. */
static void bash_words(const option_spec *spec) {
    const char *at = spec->metavar, *word;
    int length;

    printf("    --%s) COMPREPLY=($(compgen -W '", spec->name);
    while ((word = option_next_word(&at, &length))) {
        if (islower((unsigned char)word[0]))
            printf("%.*s ", length, word);
    }
    fputs("' -- \"$word\")); return ;;\n", stdout);
}

static void bash_options(subcommand_id id) {
    const char *name = subcommand_table[id].name;

    printf("    '%s%s'*) words='", name, strchr(name, ' ') ? "" : " ");
    for (int i = 0; i < OPT_COUNT; i++) {
        if (!option_taken_by((option_id)i, id))
            continue;
        if (option_table[i].letter)
            printf("-%c ", option_table[i].letter);
        printf("--%s ", option_table[i].name);
    }
    fputs("' ;;\n", stdout);
}

/* After the first word of "tree grow": the words that may follow. */
static void bash_second_words(void) {
    for (int i = 0; i < SUB_COUNT; i++) {
        const char *name = subcommand_table[i].name, *space = strchr(name, ' ');
        const char *before = i > 0 ? subcommand_table[i - 1].name : "";
        if (!space)
            continue;
        if (strncmp(name, before, (size_t)(space - name) + 1) != 0)
            printf("    '%.*s '*) words='", (int)(space - name), name);
        printf("%s ", space + 1);
        const char *after = i + 1 < SUB_COUNT ? subcommand_table[i + 1].name : "";
        if (strncmp(name, after, (size_t)(space - name) + 1) != 0)
            fputs("' ;;\n", stdout);
    }
}

static void bash_completion(void) {
    fputs(
        "# bash completion for ppscat, generated from its table of options.\n"
        "_ppscat()\n{\n"
        "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
        "    local words='",
        stdout);
    for (int i = 0; i < SUB_COUNT; i++) {
        const char *name = subcommand_table[i].name;
        const char *before = i > 0 ? subcommand_table[i - 1].name : "";
        size_t length = strcspn(name, " ");
        if (strncmp(name, before, length) != 0 || before[length] != ' ')
            printf("%.*s ", (int)length, name);
    }
    fputs("--help --version'\n    COMPREPLY=()\n    case $before in\n", stdout);
    for (int i = 0; i < OPT_COUNT; i++) {
        if (option_table[i].metavar && strchr(option_table[i].metavar, '|'))
            bash_words(&option_table[i]);
    }
    fputs("    -o|--output) COMPREPLY=($(compgen -f -- \"$word\")); return ;;\n"
          "    --method) COMPREPLY=($(compgen -W \"$(ppscat methods 2>/dev/null |\n"
          "        tail -n +2 | cut -d, -f1)\" -- \"$word\")); return ;;\n"
          "    esac\n    [[ $COMP_CWORD -gt 1 ]] && case \"${COMP_WORDS[1]} "
          "${COMP_WORDS[2]}\" "
          "in\n",
          stdout);
    for (int i = 0; i < SUB_COUNT; i++)
        bash_options((subcommand_id)i);
    bash_second_words();
    fputs("    *) words='' ;;\n    esac\n"
          "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
          "}\ncomplete -F _ppscat ppscat\n",
          stdout);
}

int main(int argc, char **argv) {
    if (argc == 3 && strcmp(argv[1], "man") == 0) {
        man_page(argv[2]);
    } else if (argc == 2 && strcmp(argv[1], "bash") == 0) {
        bash_completion();
    } else {
        fputs("usage: ppscat-gendoc man VERSION | bash\n", stderr);
        return EXIT_FAILURE;
    }
    return fflush(stdout) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
