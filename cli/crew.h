/* The same work on several threads.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_CREW_H
#define PPSCAT_CLI_CREW_H

/* Run work(context) on n threads, the caller's among them; return when all have ended.
 * Where a thread cannot be started, fewer do it. */
void crew_run(int n, void *(*work)(void *context), void *context);

#endif
