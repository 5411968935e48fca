/* ppscat-preview: plants and their light, seen.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "preview/bench.h"
#include "preview/snapshot.h"
#include "preview/window.h"

/* One line, whatever the user's text holds. */
static void complain(const char *text) {
    fputs("ppscat-preview: ", stderr);
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        fputc(c < ' ' || c == 127 ? ' ' : c, stderr);
    }
    fputc('\n', stderr);
}

static int run(const preview_options *options, pps_problem *problem) {
    if (options->help) {
        options_help(stdout);
        return EXIT_DONE;
    }
    if (options->version) {
        puts("ppscat-preview " PPS_VERSION_STRING);
        return EXIT_DONE;
    }
    if (options->bench) {
        return bench_run(options, problem);
    }
    if (options->snapshot) {
        return snapshot_run(options, problem);
    }
    return window_run(options, problem);
}

int main(int argc, char **argv) {
    preview_options options;
    pps_problem problem = {""};
    if (!options_read(argc, argv, &options, &problem)) {
        complain(problem.text);
        return EXIT_USAGE;
    }
    int rc = run(&options, &problem);
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (!written && rc == EXIT_DONE) {
        strcpy(problem.text, "cannot write standard output");
        rc = EXIT_FAILED;
    }
    if (rc) {
        complain(problem.text);
    }
    return rc;
}
