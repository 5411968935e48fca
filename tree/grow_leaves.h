/* Leaves on the twigs of a skeleton.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_GROW_LEAVES_H
#define PPS_TREE_GROW_LEAVES_H

#include "tree/builder.h"
#include "tree/skeleton.h"

/* Triangles of one leaf, or of one flower with all its petals. */
size_t pps_leaf_triangles(const pps_species *species);

/* Adds n leaves whose size gives the species' leaf-area index over the hull of what is
 * added. MEMORY; ARGUMENT: no wood is thin enough to bear leaves. */
pps_status pps_leaves_build(const pps_species *species, uint64_t seed,
                            const pps_skeleton *skeleton, size_t n, uint32_t material,
                            pps_builder *b);

#endif
