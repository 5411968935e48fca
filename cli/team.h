/* Other processes that help with a sweep: the ranks of mpirun, where the program is built
 * for it (team_mpi.c), else none (team_alone.c).
 *
 * Rank 0 reads, writes and speaks; it hands tiles of its queue to the others.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TEAM_H
#define PPSCAT_CLI_TEAM_H

#include "queue.h"

/* Call first and last in main. CLI_USAGE under an mpirun that this build cannot serve. */
int team_begin(int *argc, char ***argv);
void team_end(void);

int team_rank(void);
int team_size(void);

/* Rank 0, again and again while it sweeps: hand out tiles to ranks that ask, take them
 * back. Returns the cases that have come back. */
size_t team_serve(queue *q);

/* Rank 0, after the sweep or instead of it: tell the others that there is no more. */
void team_dismiss(void);

/* The others: compute tiles until dismissed. rc is that of getting ready. */
int team_help(int rc, int (*compute)(void *context, sweep_tile *t), void *context);

#endif
