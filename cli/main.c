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
#include <ppscat/ppscat.h>

#include "cli.h"
#include "commands.h"
#include "team.h"
#include "usage.h"

static int (*const commands[SUB_COUNT])(const invocation *) = {
#define SUBCOMMAND(id, name, operand, summary, notes) cmd_##name,
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

static int unknown_subcommand(const char *word) {
    const char *names[SUB_COUNT], *closest;
    char all[256] = "";
    size_t length = 0;

    for (size_t i = 0; i < SUB_COUNT; i++) {
        names[i] = subcommand_table[i].name;
        length += (size_t)snprintf(all + length, sizeof all - length, "%s%s",
                                   i ? ", " : "", names[i]);
    }
    closest = cli_closest(word, SUB_COUNT, names);
    return cli_usage("unknown subcommand '%.60s'; %s%s%sallowed: %s", word,
                     closest ? "did you mean '" : "", closest ? closest : "",
                     closest ? "'? " : "", all);
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
        if (strcmp(word, subcommand_table[i].name) == 0)
            return run_subcommand((subcommand_id)i, argc, argv);
    }
    if (word[0] == '-')
        return cli_usage(
            "unknown option '%.60s' before the subcommand; allowed: --help, "
            "--version",
            word);
    return unknown_subcommand(word);
}

int main(int argc, char **argv) {
    int rc;

    signal(SIGPIPE, SIG_IGN);    /* a closed pipe is a write error with its message */
    openblas_set_num_threads(1); /* the threads are ours */
    rc = team_begin(&argc, &argv);
    if (rc == CLI_DONE)
        rc = dispatch(argc, argv);
    team_end();
    if (fflush(stdout) != 0 && rc != CLI_FAILED)
        return cli_failed("cannot write standard output: %s", strerror(errno));
    return rc;
}
