/* The row "radiosity" of the table: light from leaf to leaf, from the lattice's answer on.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "tree/lattice.h"
#include "tree/radiosity.h"

/* Weighted by area: of phi_d in the cells, then of what leaves scatter to each other. */
static const double CELLS_TOLERANCE = 1e-3, LEAVES_TOLERANCE = 5e-4;

typedef struct {
    pps_lattice *lattice;
    pps_radiosity *radiosity;
} both;

static void free_state(void *state) {
    both *b = state;
    if (b) {
        pps_lattice_free(b->lattice);
        pps_radiosity_free(b->radiosity);
        free(b);
    }
}

static void forget(void *state) {
    both *b = state;
    pps_lattice_forget(b->lattice);
    pps_radiosity_forget(b->radiosity);
}

static pps_status create(const pps_lit_scene *lit, both **out) {
    both *b = calloc(1, sizeof *b);
    pps_status status =
        b ? pps_lattice_create(lit->scene, lit->cells, lit->options.kappa,
                               lit->options.threads, &b->lattice)
          : PPS_ERR_MEMORY;
    if (!status) {
        status = pps_radiosity_create(lit->scene, lit->cells, lit->options.threads,
                                      &b->radiosity);
    }
    if (status) {
        free_state(b);
        b = NULL;
    }
    *out = b;
    return status;
}

static pps_status solve(const pps_lit_scene *lit, pps_light_field *field) {
    both *b = field->state;
    pps_status status = PPS_OK;
    if (b && !pps_lattice_fits(b->lattice, lit)) {
        free_state(b);
        b = NULL;
    }
    field->leaf_scattered = field->leaf_sky = NULL;
    field->leaf_sun = NULL;
    if (!b) {
        status = create(lit, &b);
        field->state = b;
    }
    if (!status) {
        status = pps_lattice_solve(b->lattice, lit, CELLS_TOLERANCE, field);
    }
    if (!status) {
        status = pps_radiosity_solve(b->radiosity, lit, pps_lattice_ground(b->lattice),
                                     LEAVES_TOLERANCE, field);
    }
    return status;
}

static const struct pps_light_model_ops ops = {
    .solve = solve, .forget = forget, .free_state = free_state};

const pps_light_model pps_light_radiosity = {
    .name = "radiosity",
    .summary = "leaf by leaf along rays between leaves, from the lattice's answer on",
    .source = "docs/theory.md section 9",
    .sources = PPS_ALL_LIGHT,
    .ops = &ops,
};
