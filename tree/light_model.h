/* What stands behind a row of the table of light models.
 *
 * A model is one file: it defines its functions, and tree/models.def lists it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_LIGHT_MODEL_H
#define PPS_TREE_LIGHT_MODEL_H

#include <ppscat/tree/field.h>

#include "tree/slab_light.h"

/* A light to solve for; checked, options and sources with their defaults. */
typedef struct pps_lit_scene {
    const pps_scene *scene;
    const pps_cells *cells; /* NULL for models without cells */
    pps_light_options options;
} pps_lit_scene;

struct pps_light_model_ops {
    /* Depths and direct light from mean counts, as the paper; else from visibilities. */
    bool counts;
    pps_slab_closure slab; /* of those that count: how a place in the slab is lit */
    /* Fill diffuse, flux and g_factor of the field; the rest is there. NULL: the model
     * does not use cells and has `leaves`. */
    pps_status (*solve)(const pps_lit_scene *lit, pps_light_field *field);
    void (*forget)(void *state);     /* the last answer; NULL: none is kept */
    void (*free_state)(void *state); /* NULL: none */
    pps_status (*leaves)(const pps_lit_scene *lit, pps_irradiance *out);
};

/* The options with their defaults, or why not. */
pps_status pps_light_options_check(const pps_light_model *model,
                                   const pps_light_options *given,
                                   pps_light_options *options);

/* One distant light of the closed forms: the sun, or one of the directions of the sky. */
typedef struct pps_distant {
    int direction; /* -1: the sun */
    double to[3], irradiance[PPS_BANDS_MAX];
} pps_distant;

/* The lights that scatter under `sources`: at most 1 + directions. Returns how many. */
int pps_distant_lights(const pps_lit_scene *lit, pps_distant *lights);

/* Radiance of direction j's part of the sky, 0 below a ground. */
double pps_sky_part(const pps_scene *scene, const pps_cells *cells, int j, int band);

/* Depth from the light and on along it, to the surface, in cell c. */
void pps_cell_depths(const pps_cells *cells, bool counts, size_t c, int direction,
                     double *depth, double *behind);

/* Optical depth towards direction j from the leaves of cell c. */
double pps_cell_path(const pps_cells *cells, bool counts, size_t c, int j);

/* Mean share of light that leaves of a cell scatter, [c * n_bands + b], by area. */
pps_status pps_cell_albedos(const pps_scene *scene, const pps_cells *cells,
                            float **albedo);

#endif
