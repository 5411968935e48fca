/* The case grid cut into units.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "plan.h"

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

static size_t parts(size_t n, size_t step) { return (n + step - 1) / step; }

/* The most of n things of `size` rows each that make no more than UNIT_ROWS. */
static size_t step_of(size_t n, uint64_t size) {
    uint64_t most = UNIT_ROWS / size;

    return least(n, most ? (size_t)most : 1);
}

/* How a case is cut where it alone has too many rows: into phi of one mu, mu of one
 * depth, or depths, so that a part is one run of rows. Returns the rows of a case. */
static uint64_t cut_case(sweep_plan *plan) {
    const case_grid *grid = plan->grid;
    bool directions = plan->shape == ROWS_DIRECTIONS;
    size_t n_mu = directions ? grid->mu.n : 1;
    size_t n_phi = directions ? grid->phi.n : 1;
    size_t n_depths = plan->shape == ROWS_CASE ? 1 : grid->max_depths;

    plan->phi_step = step_of(n_phi, 1);
    plan->mu_step = step_of(n_mu, n_phi);
    plan->depth_step = step_of(n_depths, (uint64_t)n_mu * n_phi);
    plan->phi_parts = parts(n_phi, plan->phi_step);
    plan->mu_parts = parts(n_mu, plan->mu_step);
    plan->depth_parts = parts(n_depths, plan->depth_step);
    return (uint64_t)n_depths * n_mu * n_phi;
}

/* No product overflows: grid_init has refused grids of more than 1e15 rows. */
void plan_init(sweep_plan *plan, const case_grid *grid, row_shape shape) {
    uint64_t rows, media;

    *plan = (sweep_plan){.grid = grid,
                         .shape = shape,
                         .n_methods = shape == ROWS_CASE ? 1 : grid->n_methods};
    rows = cut_case(plan);
    plan->mu0_step = least(step_of(grid->mu0.n, rows), UNIT_BEAMS);
    plan->mu0_parts = parts(grid->mu0.n, plan->mu0_step);
    plan->unit_rows =
        (uint64_t)plan->mu0_step * plan->depth_step * plan->mu_step * plan->phi_step;
    media = (uint64_t)plan->n_methods * grid->albedo.n * grid->g.n;
    plan->units_per_medium = (uint64_t)grid->thickness.n * plan->mu0_parts *
                             plan->depth_parts * plan->mu_parts * plan->phi_parts;
    plan->n_units = media * plan->units_per_medium;
    plan->cases = media * grid->thickness.n * grid->mu0.n;
}

/* The last digit of *index in a mixed radix, which it loses. */
static size_t pop(uint64_t *index, size_t radix) {
    size_t digit = (size_t)(*index % radix);

    *index /= radix;
    return digit;
}

/* Part i of a list of n. */
static unit_range range(const double *value, size_t n, size_t step, size_t i) {
    size_t first = least(i * step, n);

    return (unit_range){first, least(step, n - first), value + first};
}

sweep_unit plan_unit(const sweep_plan *plan, uint64_t index) {
    const case_grid *grid = plan->grid;
    uint64_t rest = index;
    size_t i_phi = pop(&rest, plan->phi_parts);
    size_t i_mu = pop(&rest, plan->mu_parts);
    size_t i_depth = pop(&rest, plan->depth_parts);
    size_t i_mu0 = pop(&rest, plan->mu0_parts);
    size_t i_thickness = pop(&rest, grid->thickness.n);
    const depth_list *depth = &grid->depth[i_thickness];
    sweep_unit unit = {.medium = rest,
                       .i_thickness = i_thickness,
                       .thickness = grid->thickness.value[i_thickness],
                       .mu0 =
                           range(grid->mu0.value, grid->mu0.n, plan->mu0_step, i_mu0),
                       .depth = {0, depth->n, depth->tau},
                       .mu = {0, grid->mu.n, grid->mu.value},
                       .phi = {0, grid->phi.n, grid->phi.value}};

    if (plan->shape != ROWS_CASE)
        unit.depth = range(depth->tau, depth->n, plan->depth_step, i_depth);
    if (plan->shape == ROWS_DIRECTIONS) {
        unit.mu = range(grid->mu.value, grid->mu.n, plan->mu_step, i_mu);
        unit.phi = range(grid->phi.value, grid->phi.n, plan->phi_step, i_phi);
    }
    unit.i_g = pop(&rest, grid->g.n);
    unit.i_albedo = pop(&rest, grid->albedo.n);
    unit.i_method = (size_t)rest;
    unit.g = grid->g.value[unit.i_g];
    unit.albedo = grid->albedo.value[unit.i_albedo];
    if (plan->shape != ROWS_CASE)
        unit.method = grid->method[unit.i_method];
    return unit;
}

uint64_t plan_rows(const sweep_plan *plan, const sweep_unit *unit) {
    uint64_t rows = unit->mu0.n;

    if (plan->shape != ROWS_CASE)
        rows *= unit->depth.n;
    if (plan->shape == ROWS_DIRECTIONS)
        rows *= unit->mu.n * unit->phi.n;
    return rows;
}
