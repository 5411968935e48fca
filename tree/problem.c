/* Telling a person what went wrong.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/problem.h"

#include <stdarg.h>
#include <stdio.h>

/* One line, whatever names and files hold. */
static void print(pps_problem *problem, const char *format, va_list arguments) {
    vsnprintf(problem->text, sizeof problem->text, format, arguments);
    for (char *c = problem->text; *c; c++) {
        if ((unsigned char)*c < ' ') {
            *c = ' ';
        }
    }
}

pps_status pps_complain(pps_problem *problem, pps_status status, const char *format,
                        ...) {
    if (problem) {
        va_list arguments;
        va_start(arguments, format);
        print(problem, format, arguments);
        va_end(arguments);
    }
    return status;
}
