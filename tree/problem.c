/* Telling a person what went wrong.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/problem.h"

#include <stdarg.h>
#include <stdio.h>

pps_status pps_complain(pps_problem *problem, pps_status status, const char *format,
                        ...) {
    if (problem) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(problem->text, sizeof problem->text, format, arguments);
        va_end(arguments);
        for (char *c = problem->text; *c; c++) {
            if ((unsigned char)*c < ' ') {
                *c = ' '; /* what comes from files may hold line ends */
            }
        }
    }
    return status;
}
