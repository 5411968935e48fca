/* Telling a person what went wrong.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_PROBLEM_H
#define PPS_TREE_PROBLEM_H

#include <ppscat/tree/mesh.h>

/* Fill `problem` (NULL is fine) with one line, cut where it is too long; returns status,
 * so that failing is one statement. */
__attribute__((format(printf, 3, 4))) pps_status
pps_complain(pps_problem *problem, pps_status status, const char *format, ...);

#endif
