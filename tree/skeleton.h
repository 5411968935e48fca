/* The wood of a plant as a tree of points with radii.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SKELETON_H
#define PPS_TREE_SKELETON_H

#include "tree/species.h"

#define PPS_NO_NODE UINT32_MAX

/* Parents come before their children; a stem's foot has none. */
typedef struct pps_node {
    double at[3], radius;
    uint32_t parent, main_child; /* the child that goes on; PPS_NO_NODE: a tip */
    uint32_t n_children, tips;   /* tips at or beyond it */
} pps_node;

typedef struct pps_skeleton {
    size_t n, room;
    pps_node *node;
} pps_skeleton;

/* Grown for a species and a seed. MEMORY. Free node after use, whatever the status. */
pps_status pps_skeleton_grow(const pps_species *species, uint64_t seed,
                             pps_skeleton *out);

#endif
