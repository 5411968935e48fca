/* The row "lattice" of the table: discrete ordinates on the crown's own cells.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/lattice.h"

/* Of phi_d, weighted by extinction; the cells are known worse. */
static const double TOLERANCE = 1e-3;

static pps_status solve(const pps_lit_scene *lit, pps_light_field *field) {
    if (field->state && !pps_lattice_fits(field->state, lit)) {
        pps_lattice_free(field->state);
        field->state = NULL;
    }
    if (!field->state) {
        pps_lattice *lattice;
        pps_status status = pps_lattice_create(
            lit->scene, lit->cells, lit->options.kappa, lit->options.threads, &lattice);
        if (status) {
            return status;
        }
        field->state = lattice;
    }
    return pps_lattice_solve(field->state, lit, TOLERANCE, field);
}

static void forget(void *state) { pps_lattice_forget(state); }

static void free_state(void *state) { pps_lattice_free(state); }

static const struct pps_light_model_ops ops = {
    .solve = solve, .forget = forget, .free_state = free_state};

const pps_light_model pps_light_lattice = {
    .name = "lattice",
    .summary = "discrete ordinates on the crown's own cells, with the ground's light",
    .source = "docs/theory.md section 9",
    .sources = PPS_ALL_LIGHT,
    .ops = &ops,
};
