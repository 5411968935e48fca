/* The rendering system: light that follows a moving sun, in the six steps of the paper.
 *
 *   1 pps_system_construct_cells    cells, their leaves and areas
 *   2 pps_system_map_directions     deep opacity maps towards the sampling directions
 *   3 pps_system_find_g             depths and G-factors of cells
 *   4 pps_system_light_sky          light of the sky, when the sky or the ground changed
 *   5 pps_system_light_sun          maps and light of the sun, when the sun moved
 *   6 pps_system_shade              irradiance of leaves, when anything did
 *
 * Steps 1 to 3 are done once for a scene. Each step needs those before it, but 5 does not
 * need 4; a step that is done again leaves what others found. Shaders may take the place
 * of step 6: they read the same numbers.
 *
 * Two ways lead through the steps. PPS_SYSTEM_GRID: cells of one grid over the scene, and
 * any light model of the table that has cells; plants of any size and turn.
 * PPS_SYSTEM_INSTANCES, the paper's own: a coarse grid in every plant, depths summed over
 * its neighbours' maps (SPP Eq. 31), SPP with the G-factor; plants turned by multiples of
 * 72 degrees, the symmetry of the directions.
 *
 * Reference: SPP section 5.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_SYSTEM_H
#define PPSCAT_TREE_SYSTEM_H

#include <ppscat/tree/field.h>
#include <ppscat/tree/opacity.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PPS_SYSTEM_STEPS = 6 };

typedef enum { PPS_SYSTEM_GRID, PPS_SYSTEM_INSTANCES } pps_system_way;

typedef struct pps_system_options {
    pps_system_way way;
    const pps_light_model *model; /* of GRID: NULL is the table's first */
    pps_light_options light; /* compensation (of INSTANCES: NONE is plain SPP), kappa */
    bool kappa_printed;      /* INSTANCES: Eq. 20 as printed */
    bool by_point; /* models by counts: scattered light of the sun by the depths at the
                      very point (SPP section 5.3), not by those of its cell */
    int across;    /* cells across the longest side of a plant's leaves; 0: 16 for GRID,
                       10 for INSTANCES */
    int texels;    /* of the maps towards the directions; 0: 64 for INSTANCES, 256 for
                       GRID */
    int sun_texels; /* of the sun's maps; 0: 256 */
    int samples;    /* GRID: points a leaf that find its cells; 0: 1 */
    bool by_rays; /* GRID: depths towards the directions by rays from the samples: slow,
                       and better by a hundredth */
    int threads;  /* 0: all cores */
} pps_system_options;

/* A plant as the sun sees it: a prototype, and the yaw of those that stand so. */
typedef struct pps_pose {
    int prototype;
    double yaw;           /* degrees */
    pps_opacity_map *map; /* towards the sun, in the prototype's own space */
} pps_pose;

/* Cells c are those of the grid, or of all instances one after another. Light of cells as
 * in pps_light_field, apart for sky [0] and sun [1]. */
typedef struct pps_system {
    const pps_scene *scene;
    pps_directions directions;
    double seconds[PPS_SYSTEM_STEPS]; /* of each step's last run */
    bool by_count; /* the sun comes to leaves as e^-count; else they are opaque to it */
    size_t n_cells;
    double cell;              /* side of the smallest cell, metres */
    uint32_t *cell_of;        /* [scene leaf] */
    size_t n_poses, *pose_of; /* [instance] */
    pps_pose *pose;
    const float *diffuse[2], *flux[2]; /* [c * n_bands + b], [3 * (...) + axis] */
    const float *sky;                  /* [c * n_directions + j] share of its light */
    const float *sun; /* [c] share of the sun's light, of the cell as a whole */
    const float *g;   /* [c] G-factor of the sun's scattered light */
    /* By points: the slab's closure, its scattered light times kappa; 0: by cells. */
    double slab_m, slab_kappa;
    /* Instances that may stand in the sun of instance i: caster[list[k]] for k from
     * first[i] to first[i + 1] - 1. A caster is an instance and where it stands. */
    size_t n_casters;
    const size_t *shade_first;
    const uint32_t *shade_list;
} pps_system;

/* Check and make room. The scene must be indexed, outlive the system, and keep its
 * instances and meshes; sun, sky, ground and optics may change between steps (new optics
 * need 4 and 5 again). MEMORY; ARGUMENT: no leaves, or bad options; UNSUPPORTED: the model
 * has no cells, or INSTANCES with other turns or a scene that repeats. */
PPS_API pps_status pps_system_create(const pps_scene *scene,
                                     const pps_system_options *options,
                                     pps_system **out);
PPS_API void pps_system_free(pps_system *system); /* NULL is fine */

PPS_API pps_status pps_system_construct_cells(pps_system *system);
PPS_API pps_status pps_system_map_directions(pps_system *system);
PPS_API pps_status pps_system_find_g(pps_system *system);
PPS_API pps_status pps_system_light_sky(pps_system *system);
PPS_API pps_status pps_system_light_sun(pps_system *system);

/* Both faces of every leaf. The sun comes by its maps: opaque leaves, or e^-depth in
 * models that count; sources: PPS_SUN and PPS_SKY are direct light, the others scattered
 * (0: all). ARGUMENT: a step is missing. */
PPS_API pps_status pps_system_shade(pps_system *system, unsigned sources,
                                    pps_irradiance **out);

/* The same at one point on leaf i of the scene, where the leaf's unit normal is `normal`:
 * [band], both faces. What a shader finds for a pixel. ARGUMENT: as above, or i. */
PPS_API pps_status pps_system_shade_point(const pps_system *system, unsigned sources,
                                          size_t i, const double point[3],
                                          const double normal[3], double *front,
                                          double *back);

/* A caster's instance, and the offset in metres of the period that it stands in. */
PPS_API size_t pps_system_caster(const pps_system *system, size_t k, double offset[2]);

#ifdef __cplusplus
}
#endif
#endif
