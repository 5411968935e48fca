/* Where bytes go: a file that grows at its end, or a stream.
 *
 * Functions that return int report a failure on standard error and return CLI_FAILED.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_STORE_H
#define PPSCAT_CLI_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    int fd;
    const char *name; /* for messages */
    uint64_t bytes;   /* written and complete */
} store;

/* What a path given by -o is. CLI_USAGE where it cannot be written; *regular tells a file,
 * or the place of one, from what is written in place (/dev/null, a pipe). */
int store_look(const char *path, bool *regular);

/* Write to something that is no regular file, or to standard output for NULL. */
int store_stream(store *s, const char *path);

/* Keep so many bytes of a file, or make it, and go on behind them. CLI_USAGE where it
 * cannot be opened. The name must outlive the store. */
int store_file(store *s, const char *name, uint64_t keep);

/* A file without a name, in $TMPDIR or /tmp. */
int store_temporary(store *s);

/* CLI_FAILED without a message when a signal came while the stream was blocked. */
int store_write(store *s, const void *data, size_t n);

int store_read(const store *s, uint64_t at, void *data, size_t n);

/* Forget what a failed write left behind the last complete one. */
void store_trim(store *s);

/* Wait until all of it would survive a power failure. */
int store_sync(const store *s);

/* A failure to close is a failure to write. */
int store_close(store *s);

/* Give a file its final name, for good. */
int store_rename(const char *from, const char *to);

#endif
