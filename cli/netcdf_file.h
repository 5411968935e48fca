/* The results of a sweep as NetCDF, one axis a parameter (netcdf_file.c; netcdf_absent.c
 * where the build found no libnetcdf).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_NETCDF_FILE_H
#define PPSCAT_CLI_NETCDF_FILE_H

#include "options.h"
#include "store.h"
#include "sweep.h"

extern const bool netcdf_file_there;

/* Make the file at path from the values of the whole sweep, in the order of its units.
 * A failure is reported. */
int netcdf_file_write(const char *path, const invocation *call, const sweep_task *task,
                      const sweep_plan *plan, const store *values, const record *done);

#endif
