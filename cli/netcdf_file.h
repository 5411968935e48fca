/* The results of a sweep as NetCDF, one axis a parameter.
 *
 * The writer is a module, ppscat-netcdf.so (netcdf_file.c), loaded when it is asked for:
 * libnetcdf and all that comes with it would make every start of the program three times
 * as long.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_NETCDF_FILE_H
#define PPSCAT_CLI_NETCDF_FILE_H

#include "options.h"
#include "store.h"
#include "sweep.h"

/* Make the file at path from the values of the whole sweep, in the order of its units.
 * A failure is reported. */
typedef int netcdf_file_writer(const char *path, const invocation *call,
                               const sweep_task *task, const sweep_plan *plan,
                               const store *values, const record *done);

/* In the module. */
netcdf_file_writer netcdf_file_write;

/* Load the module; CLI_USAGE where there is none. */
int netcdf_file_load(netcdf_file_writer **write);

#endif
