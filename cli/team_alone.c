/* No other processes help.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "team.h"

#include <stdlib.h>

#include "cli.h"

int team_begin(int *argc, char ***argv) {
    const char *size = getenv("OMPI_COMM_WORLD_SIZE");

    (void)argc;
    (void)argv;
    if (size && atoi(size) > 1)
        return cli_usage(
            "mpirun -n '%.20s': this ppscat is built without MPI; allowed: "
            "1, or a build with -DPPSCAT_MPI=ON",
            size);
    return CLI_DONE;
}

void team_end(void) {}

int team_rank(void) { return 0; }

int team_size(void) { return 1; }

size_t team_serve(queue *q) {
    (void)q;
    return 0;
}

void team_dismiss(void) {}

int team_help(int rc, int (*compute)(void *context, sweep_tile *t), void *context) {
    (void)compute;
    (void)context;
    return rc;
}
