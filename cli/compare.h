/* Methods against `exact`: what `error` and `table` print.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_COMPARE_H
#define PPSCAT_CLI_COMPARE_H

#include "sweep.h"

/* One method on one case, for a beam of unit irradiance. NAN is a value that has no
 * meaning: relative to nothing, transmittance of a half-space, fluxes of a method that
 * gives none. */
typedef struct {
    const pps_method *refused_by; /* the method or the reference, where it refused */
    const char *refusal;          /* static text: why; NULL when compared */
    double mean_square; /* of the radiance difference, over depths, directions */
    double rms_rel;     /* mean over depths of rms difference / mean exact radiance */
    double max_abs;     /* largest radiance difference */
    double reflectance_error, transmittance_error; /* relative, without sign */
    double seconds;                                /* to solve and evaluate radiances */
} comparison;

/* Compare every method of a GRID_ERROR grid with `exact`, the reference of the task, on
 * the cases of a unit: c[b * n_methods + i] of mu0 b and method i. What was used goes
 * into the record of t. CLI_FAILED without memory, or where sweep_go_on says no. */
int compare_unit(const sweep_station *own, const sweep_unit *unit, comparison *c,
                 sweep_tile *t);

/* Compare on all cases. result has room for all of them, in the order of rows: method,
 * albedo, g, thickness, mu0. */
int compare_run(const case_grid *grid, record *used, comparison *result);

/* How many results there are. */
size_t compare_count(const case_grid *grid);

/* Add the differences of two fields over n_depths and the directions of a GRID_ERROR grid
 * to the first three members of c, which are 0 before. */
void compare_fields(const case_grid *grid, size_t n_depths, const double *got,
                    const double *want, comparison *c);

/* x / whole; 0 / 0 is no error at all, x / 0 has no meaning: NAN. */
double compare_relative(double x, double whole);

#endif
