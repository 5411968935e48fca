/* Loading the writer of NetCDF when it is asked for.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "netcdf_file.h"

#include <dlfcn.h>
#include <string.h>

#include "cli.h"

/* Found by the RUNPATH of the program, as libppscat is. Stays loaded. */
int netcdf_file_load(netcdf_file_writer **write) {
    void *module = dlopen("ppscat-netcdf.so", RTLD_NOW | RTLD_LOCAL);
    void *symbol = module ? dlsym(module, "netcdf_file_write") : NULL;

    if (!symbol)
        return cli_usage("--format: 'netcdf' cannot be written: %.300s; allowed: csv",
                         dlerror());
    memcpy(write, &symbol, sizeof symbol); /* ISO C has no such cast, POSIX has it */
    return CLI_DONE;
}
