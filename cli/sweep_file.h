/* A sweep into its file: FILE.part and its journal, --resume, the formats, the end.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_SWEEP_FILE_H
#define PPSCAT_CLI_SWEEP_FILE_H

#include "sweep.h"

/* Sweep, and leave the rows where -o says, in the format of --format. The task's `render`
 * is chosen here. Returns the exit code of the program. */
int sweep_file(const invocation *call, sweep_task *task);

#endif
