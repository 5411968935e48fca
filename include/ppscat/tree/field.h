/* The light in a crown, cell by cell: what the light models find before leaves are lit.
 *
 * A preview shades from these numbers, a moving sun starts from the last ones.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_FIELD_H
#define PPSCAT_TREE_FIELD_H

#include <ppscat/tree/model.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Arrays over the cells c of the grid; cells without leaves hold zeros. A leaf's face of
 * unit normal n has the irradiance
 *     sun irradiance * max(0, n.to) * sun[c] + sky + diffuse/4 + n.flux/2,
 * sky = sum over directions j above ground of 4 pi/N max(0, n.to_j) radiance_j sky[c, j]. */
typedef struct pps_light_field {
    const pps_light_model *model;
    size_t n_cells;
    int n_bands, n_directions;
    float *diffuse; /* [c * n_bands + b] fluence of the scattered light, W/m^2 */
    float *
        flux; /* [3 * (c * n_bands + b) + axis] its net flux, towards where it is from */
    float *sun;               /* [c] visibility of the sun, as the model takes it */
    float *sky;               /* [c * n_directions + j] the same of the directions */
    float *depth, *thickness; /* [c] along the sun's light, as the model takes them */
    float *g_factor;          /* [c] for the sun; 1 where nothing is compensated */
    int sweeps;               /* `lattice`: of the last solve; else 0 */
    /* Of models that light leaf by leaf, instead of what the cells give; else NULL.
     * [2 * (leaf * n_bands + b) + face]: irradiance of a face by scattered light, and by
     * the sky; [leaf][face]: mean over the leaf of the cosine to the sun where it is
     * seen. */
    const float *leaf_scattered, *leaf_sky;
    const float (*leaf_sun)[2];
    void *state; /* the model's own, kept from solve to solve */
} pps_light_field;

/* Solve the cells. *field NULL: make one. Else it comes from an earlier solve of the same
 * model, leaves, cells and number of bands (sun, sky, ground, optics and options may
 * differ), and what did not move is not computed again. ARGUMENT: it does not fit.
 * UNSUPPORTED: the model has no cells, or lacks a source. On failure a new field is NULL, and an old one
 * may only be freed or solved again. */
PPS_API pps_status pps_light_field_solve(const pps_light_model *model,
                                         const pps_scene *scene, const pps_cells *cells,
                                         const pps_light_options *options,
                                         pps_light_field **field);
/* Let the next solve start from no light; what is made once a scene stays. */
PPS_API void pps_light_field_forget(pps_light_field *field);
PPS_API void pps_light_field_free(pps_light_field *field); /* NULL is fine */

/* Irradiance of every leaf from a field, with the direct light among `sources` (0: all).
 * Where the cells have leaf_sun, the sun's is each leaf's own (not for models by counts).
 * PPS_SUN_INDIRECT and PPS_SKY_INDIRECT add whatever scattered light was solved for. */
PPS_API pps_status pps_light_field_leaves(const pps_light_field *field,
                                          const pps_scene *scene,
                                          const pps_cells *cells, unsigned sources,
                                          pps_irradiance **out);

#ifdef __cplusplus
}
#endif
#endif
