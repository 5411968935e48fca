/* No NetCDF in this build.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "netcdf_file.h"

#include "cli.h"

const bool netcdf_file_there = false;

int netcdf_file_write(const char *path, const invocation *call, const sweep_task *task,
                      const sweep_plan *plan, const store *values, const record *done) {
    (void)call;
    (void)task;
    (void)plan;
    (void)values;
    (void)done;
    return cli_failed("cannot write %.200s: no NetCDF in this build", path);
}
