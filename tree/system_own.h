/* What the two ways through the rendering system share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SYSTEM_OWN_H
#define PPS_TREE_SYSTEM_OWN_H

#include <ppscat/tree/system.h>

#include "tree/casters.h"
#include "tree/opacity_look.h"
#include "tree/slab_light.h"

enum { SYSTEM_SKY, SYSTEM_SUN, SYSTEM_DIRECTIONS_MAX = 64 };

/* The sun at a point: as counts of surfaces before and behind, and as light that comes and
 * goes on where surfaces are opaque. */
typedef pps_opacity_look pps_sun_look;

typedef struct pps_system_own {
    pps_system system;
    pps_system_options options;
    pps_casters casters;
    pps_shade sun_shade;
    bool done[PPS_SYSTEM_STEPS];
    int threads;
    pps_opacity_map **sun_map; /* [pose] */
    bool counts;               /* light is e^-depth */
    pps_slab_closure slab;     /* of models that count */
    void *way;                 /* the state of the way taken */
} pps_system_own;

/* A way: its steps, by number - 1. Steps 1 and 2 find pub.n_cells, cell_of and what they
 * like; step 5 finds the sun's maps done. */
typedef struct pps_system_steps {
    pps_status (*create)(pps_system_own *own);
    void (*free)(pps_system_own *own);
    pps_status (*construct_cells)(pps_system_own *own);
    pps_status (*map_directions)(pps_system_own *own);
    pps_status (*find_g)(pps_system_own *own);
    pps_status (*light_sky)(pps_system_own *own);
    pps_status (*light_sun)(pps_system_own *own);
} pps_system_steps;

extern const pps_system_steps pps_system_grid, pps_system_instances;

/* Maps of all poses towards a light, map[pose], and who may stand in it. */
typedef struct {
    double to[3];
    pps_opacity_map *const *map;
    const pps_shade *shade;
} pps_lit_way;

/* How that light comes to a point of instance i: on a leaf of this normal, or (NULL)
 * between leaves. */
pps_opacity_look pps_system_look(const pps_system_own *own, const pps_lit_way *light,
                                 size_t i, const double point[3], const double *normal);

/* The same for the sun. */
pps_sun_look pps_system_look_at_sun(const pps_system_own *own, size_t i,
                                    const double point[3], const double *normal);

/* Make the maps of all poses towards a direction, [pose], each in the place of an older
 * one or of NULL. */
pps_status pps_system_map_poses(const pps_system_own *own, const double to[3],
                                int texels, pps_opacity_map **map);

#endif
