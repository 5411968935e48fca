/* The parts that a skeleton is grown by.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SKELETON_PARTS_H
#define PPS_TREE_SKELETON_PARTS_H

#include <math.h>

#include "tree/random.h"
#include "tree/skeleton.h"

/* What a random number is for; items count within it. */
typedef enum {
    PPS_GROW_STEM = 1,
    PPS_GROW_FORK,
    PPS_GROW_LIMB,
    PPS_GROW_POINT,
    PPS_GROW_TIER,
    PPS_GROW_LOBE,
    PPS_GROW_WANDER
} pps_grow_use;

static inline pps_uniforms pps_grow_random(uint64_t seed, pps_grow_use use,
                                           uint64_t item, uint64_t event) {
    return pps_random(seed, PPS_RANDOM_SPECIES, (uint64_t)use << 40 | item, event);
}

/* To multiples of 2^-24 m, so that the last digits of one machine's sine or cosine do not
 * grow into another tree on the next. */
static inline void pps_grow_snap(double p[3]) {
    for (int i = 0; i < 3; i++) {
        p[i] = nearbyint(p[i] * 0x1p24) * 0x1p-24;
    }
}

/* Where limbs grow to first (the middles of the tiers, or places in the crown), and where
 * twigs grow to then. */
void pps_grow_limb_point(const pps_species *species, uint64_t seed, uint64_t i,
                         double out[3]);
void pps_grow_twig_point(const pps_species *species, uint64_t seed, uint64_t i,
                         double out[3]);

/* From the steps of growth to wood: main children, smooth ways, radii, few nodes. MEMORY. */
pps_status pps_skeleton_shape(const pps_species *species, pps_skeleton *skeleton);

#endif
