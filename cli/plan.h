/* The case grid cut into units: what is handed to a method at once.
 *
 * A unit is one (method, albedo, g, thickness) with as many mu0 as fit, or a part of the
 * depths and directions of one mu0 that has too many. Units follow the order of the rows,
 * and depend on the grid alone: whoever computes which of them, in whatever order, gets
 * the same bits. A method that solves many mu0 together sees the same ones together.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_PLAN_H
#define PPSCAT_CLI_PLAN_H

#include <stdint.h>

#include "grid.h"

/* What a case has rows for. */
typedef enum {
    ROWS_CASE,      /* itself, once a method: all methods are computed together */
    ROWS_DEPTHS,    /* every depth */
    ROWS_DIRECTIONS /* every depth, mu and phi */
} row_shape;

/* A range of a list: n values from number `first` on. */
typedef struct {
    size_t first, n;
    const double *value;
} unit_range;

typedef struct {
    const pps_method *method; /* NULL: all */
    size_t i_method, i_albedo, i_g, i_thickness;
    double albedo, g, thickness;
    unit_range mu0, depth, mu, phi; /* some of depth, mu, phi for ROWS_CASE are all */
    uint64_t medium;                /* the same number, the same method, albedo and g */
} sweep_unit;

typedef struct {
    const case_grid *grid;
    row_shape shape;
    size_t n_methods; /* of the outermost loop: 1 where all are together */
    size_t mu0_step, depth_step, mu_step, phi_step;
    size_t mu0_parts, depth_parts, mu_parts, phi_parts;
    uint64_t units_per_medium, n_units;
    uint64_t unit_rows; /* of a full unit */
    uint64_t cases;     /* of the whole grid */
} sweep_plan;

enum {
    UNIT_ROWS = 1 << 14, /* rows of a unit: its numbers stay in the cache */
    UNIT_BEAMS = 64 /* mu0 of a unit: what a killed run may lose of a slow method */
};

/* The grid must outlive the plan. */
void plan_init(sweep_plan *plan, const case_grid *grid, row_shape shape);

sweep_unit plan_unit(const sweep_plan *plan, uint64_t index);

/* Rows of a unit; of one method for ROWS_CASE. */
uint64_t plan_rows(const sweep_plan *plan, const sweep_unit *unit);

#endif
