/* The subcommands: each takes its command line and returns the exit code.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_COMMANDS_H
#define PPSCAT_CLI_COMMANDS_H

#include "options.h"

#define SUBCOMMAND(id, name, words, operand, summary, notes)                           \
    int cmd_##name(const invocation *call);
#include "subcommands.def"
#undef SUBCOMMAND

#endif
