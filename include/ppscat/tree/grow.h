/* Plants from numbers: statistical crowns and grown trees. The same seed gives the same
 * plant everywhere (positions to 1e-6).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_GROW_H
#define PPSCAT_TREE_GROW_H

#include <ppscat/tree/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Square leaves of random orientation in a crown of radius 1 about the origin, no wood. */
typedef enum {
    PPS_CROWN_UNIFORM, /* evenly in a ball */
    PPS_CROWN_CLUMPED, /* in 220 Gaussian clumps in a ball */
    PPS_CROWN_TALL,    /* evenly in an ellipsoid twice as high as wide */
    PPS_CROWN_HOLLOW   /* evenly in a shell, the inner half of the radius empty */
} pps_crown_shape;

typedef struct pps_crown {
    pps_crown_shape shape;
    double
        leaf_area_index; /* > 0: one-sided leaf area over the crown's projected area */
    uint32_t n_leaves;   /* 0: 9000 */
    uint64_t seed;
} pps_crown;

PPS_API pps_status pps_crown_grow(const pps_crown *crown, pps_mesh **out);

/* A plant with its foot at the origin, of a species: "cherry" or "maple", or a JSON file
 * (docs/species.md) when `name` has a '/' or ends in ".json". Triangles and leaf-area index
 * are those of the species, whatever the seed. Materials are "leaf" and "wood". ARGUMENT:
 * no species of that name; FILE; FORMAT: the problem names the line or the JSON pointer. */
PPS_API pps_status pps_species_grow(const char *name, uint64_t seed, pps_mesh **out,
                                    pps_problem *problem);

/* What a species' leaves reflect and transmit: bands red, green and blue of both faces. */
PPS_API pps_status pps_species_optics(const char *name, pps_leaf_optics *out,
                                      pps_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
