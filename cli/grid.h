/* The case grid: every value that the options ask for, read and checked.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_GRID_H
#define PPSCAT_CLI_GRID_H

#include <ppscat/ppscat.h>

#include "list.h"
#include "options.h"

/* The depths in a slab of one thickness. */
typedef struct {
    size_t n;
    double *tau;
    double *share; /* tau / thickness where it was asked for so, or is 0; else NAN */
} depth_list;

/* A case is a method, albedo, g, thickness and mu0; its output is at every depth,
 * mu and phi. The order of rows is that of the members, the last running fastest. */
typedef struct {
    size_t n_methods;
    const pps_method **method;
    number_list albedo, g, thickness, mu0;
    depth_list *depth; /* one for each thickness */
    size_t max_depths; /* the longest of them */
    number_list mu, phi;
    double *mu_weight, *phi_weight; /* GRID_ERROR: of directions in a mean, sum 1 */
    double beam;
    pps_options options;
    int threads;
    bool progress;
} case_grid;

/* Which defaults hold where --mu, --phi and --depth are not given. */
typedef enum {
    GRID_FIELD, /* as in the table of options */
    GRID_FLUX,  /* the same; directions are read, but make no rows */
    GRID_ERROR  /* a quadrature of the sphere, eleven depths */
} grid_kind;

/* The grid of a command line. CLI_USAGE, with one line that names the option, the value
 * and what is allowed, when an option is wrong. Free with grid_free in every case. */
int grid_init(case_grid *grid, const invocation *call, grid_kind kind);

void grid_free(case_grid *grid);

#endif
