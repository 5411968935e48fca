/* Loading the writer of NetCDF when it is asked for.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "netcdf_file.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"

/* From the folder of the program: built beside it, installed among the libraries. */
static const char *const folders[] = {".", PPSCAT_LIBDIR_FROM_BINDIR};

static void *load(void) {
    char program[PATH_MAX], path[PATH_MAX + 256];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    void *module = NULL;

    program[length > 0 ? length : 0] = '\0';
    if (strrchr(program, '/'))
        *strrchr(program, '/') = '\0';
    for (size_t i = 0; !module && i < sizeof folders / sizeof folders[0]; i++) {
        snprintf(path, sizeof path, "%s/%s/ppscat-netcdf.so", program, folders[i]);
        module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    }
    return module; /* stays loaded */
}

int netcdf_file_load(netcdf_file_writer **write) {
    void *module = load();
    void *symbol = module ? dlsym(module, "netcdf_file_write") : NULL;

    if (!symbol)
        return cli_usage(
            "--format: 'netcdf' needs ppscat-netcdf.so, which is built where "
            "libnetcdf is there (%.300s); allowed: csv",
            dlerror());
    memcpy(write, &symbol, sizeof symbol); /* ISO C has no such cast, POSIX has it */
    return CLI_DONE;
}
