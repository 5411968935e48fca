/* Which methods and settings a chart has: streams, photons, tolerances.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_SETTINGS_H
#define PPSCAT_CLI_SETTINGS_H

#include <ppscat/ppscat.h>

enum { SETTING_SIZE = 48 };

/* A method as it is asked to work. */
typedef struct {
    const pps_method *method;
    pps_options options;
    char text[SETTING_SIZE]; /* "streams=16", "photons=1000", "tol=0.01" or "-" */
} setting;

/* How many settings a method has; one, "-", for those without any. */
size_t settings_count(const pps_method *method);

/* Setting i of a method, with everything else as in `base`. */
setting settings_at(const pps_method *method, size_t i, const pps_options *base);

enum { METHOD_NAMES_SIZE = 1024 };

/* All methods, as the text of --method. */
void every_method(char names[METHOD_NAMES_SIZE]);

#endif
