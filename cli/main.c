/* ppscat: plane-parallel scattering from the command line. Which subcommand, and what
 * holds for the whole process.
 *
 * The locale stays "C", so numbers have a point whatever the user's language.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include <cblas.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <ppscat/ppscat.h>

#include "cli.h"
#include "commands.h"
#include "team.h"
#include "usage.h"

static int (*const commands[SUB_COUNT])(const invocation *) = {
#define SUBCOMMAND(id, name, words, operand, summary, notes) cmd_##name,
#include "subcommands.def"
#undef SUBCOMMAND
};

static int print_version(void) {
    printf("ppscat %s\n"
           "License GPLv3+: GNU GPL version 3 or later "
           "<https://gnu.org/licenses/gpl.html>\n"
           "This is free software: you are free to change and redistribute it.\n"
           "There is NO WARRANTY, to the extent permitted by law.\n",
           pps_version());
    return CLI_DONE;
}

/* Those whose name begins with `family`, "" for all: "tree grow, tree render". */
static void list_names(const char *family, char *all, size_t size) {
    size_t length = 0;

    all[0] = '\0';
    for (size_t i = 0; i < SUB_COUNT; i++) {
        const char *name = subcommand_table[i].name;
        if (strncmp(name, family, strlen(family)) == 0)
            length += (size_t)snprintf(all + length, size - length, "%s%s",
                                       length ? ", " : "", name);
    }
}

static int unknown_subcommand(const char *word, const char *next) {
    const char *names[SUB_COUNT], *closest;
    char all[256], family[64];

    snprintf(family, sizeof family, "%.60s ", word);
    list_names(family, all, sizeof all);
    if (all[0])
        return cli_usage("'%.60s%s%.60s' is no subcommand; allowed: %s", word,
                         *next ? " " : "", next, all);
    for (size_t i = 0; i < SUB_COUNT; i++)
        names[i] = subcommand_table[i].name;
    list_names("", all, sizeof all);
    closest = cli_closest(word, SUB_COUNT, names);
    return cli_usage("unknown subcommand '%.60s'; %s%s%sallowed: %s", word,
                     closest ? "did you mean '" : "", closest ? closest : "",
                     closest ? "'? " : "", all);
}

/* Whether the command line begins with the one or two words of a subcommand. */
static bool names_subcommand(const char *name, int argc, char **argv) {
    size_t length = strcspn(name, " ");

    if (strncmp(name, argv[1], length) != 0 || argv[1][length] != '\0')
        return false;
    return name[length] == '\0' ||
           (argc > 2 && strcmp(name + length + 1, argv[2]) == 0);
}

static int run_subcommand(subcommand_id id, int argc, char **argv) {
    invocation call;
    int rc;

    if (team_rank() > 0 && !option_taken_by(OPT_RESUME, id))
        return CLI_DONE; /* no sweep: nothing to help with */
    rc = options_read(id, argc, argv, &call);
    if (team_rank() > 0 &&
        (option_given(&call, OPT_VERSION) || option_given(&call, OPT_HELP)))
        return CLI_DONE;
    if (rc != CLI_DONE)
        return rc;
    if (option_given(&call, OPT_VERSION))
        return print_version();
    if (!option_given(&call, OPT_HELP))
        return commands[id](&call);
    usage_subcommand(stdout, id);
    return CLI_DONE;
}

static int dispatch(int argc, char **argv) {
    const char *word = argc > 1 ? argv[1] : "";

    if (team_rank() > 0 && (argc < 2 || word[0] == '-'))
        return CLI_DONE; /* rank 0 speaks */
    if (argc < 2) {
        usage_program(stderr);
        return CLI_USAGE;
    }
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        usage_program(stdout);
        return CLI_DONE;
    }
    if (strcmp(word, "--version") == 0)
        return print_version();
    for (size_t i = 0; i < SUB_COUNT; i++) {
        if (names_subcommand(subcommand_table[i].name, argc, argv))
            return run_subcommand((subcommand_id)i, argc, argv);
    }
    if (word[0] == '-')
        return cli_usage(
            "unknown option '%.60s' before the subcommand; allowed: --help, "
            "--version",
            word);
    return unknown_subcommand(word, argc > 2 ? argv[2] : "");
}

int main(int argc, char **argv) {
    int rc;

    signal(SIGPIPE, SIG_IGN);    /* a closed pipe is a write error with its message */
    openblas_set_num_threads(1); /* the threads are ours */
#ifdef M_TRIM_THRESHOLD /* else free() hands pages back, to be faulted in again */
    mallopt(M_TRIM_THRESHOLD, 1 << 28);
    mallopt(M_MMAP_THRESHOLD, 1 << 25); /* the largest that glibc takes */
#endif
    rc = team_begin(&argc, &argv);
    if (rc == CLI_DONE)
        rc = dispatch(argc, argv);
    team_end();
    if (fflush(stdout) != 0 && rc != CLI_FAILED)
        return cli_failed("cannot write standard output: %s", strerror(errno));
    return rc;
}
