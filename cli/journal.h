/* FILE.part-journal: how far a sweep into a file has come, and what it was asked.
 *
 * A JSON object, replaced as a whole, so that a killed run leaves the one before or the
 * one after. It holds the version and every option that the result depends on; and one or
 * two checkpoints, the latest and the latest that a power failure cannot take back.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_JOURNAL_H
#define PPSCAT_CLI_JOURNAL_H

#include <stdbool.h>
#include <stdint.h>

#include "options.h"
#include "record.h"

/* So many units of the plan are in the first bytes of the file. */
typedef struct {
    uint64_t units, bytes;
    uint64_t tail; /* journal_tail of those bytes */
    record record; /* of those units */
} checkpoint;

enum { JOURNAL_TAIL = 1 << 16 };

/* A fingerprint of the last JOURNAL_TAIL of `bytes` bytes in a file. CLI_FAILED, without a
 * message, where the file is shorter. */
int journal_tail(int fd, uint64_t bytes, uint64_t *tail);

/* Replace the journal at path; `sync`: for good. A failure is reported. */
int journal_write(const char *path, const invocation *call, const checkpoint *latest,
                  const checkpoint *safe, bool sync);

/* Read the journal at path. *n is 0 where there is none. CLI_USAGE, with a line that names
 * what differs, where it is of another run. Free the records of the points. */
int journal_read(const char *path, const invocation *call, checkpoint points[2],
                 int *n);

/* Whether there is a journal, of whatever run; *rows of it, 0 where unknown. */
bool journal_there(const char *path, uint64_t *rows);

#endif
