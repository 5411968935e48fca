/* The sidecar FILE-metadata.json: what a CSV file holds and how it was made.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_METADATA_H
#define PPSCAT_CLI_METADATA_H

#include "options.h"
#include "record.h"

/* Write the sidecar of csv_path, complete or not at all: W3C "CSV on the Web", with the
 * version, the command line, the date and what was used under `notes`. */
int metadata_write(const char *csv_path, const invocation *call, const record *done);

/* The notes alone, as JSON text to be freed; NULL without memory. */
char *metadata_notes(const invocation *call, const record *done);

/* "2024-12-31T23:59:59Z": now. */
enum { DATE_SIZE = 32 };
void metadata_date(char text[DATE_SIZE]);

#endif
