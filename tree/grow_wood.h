/* The wood's surface about a skeleton.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_GROW_WOOD_H
#define PPS_TREE_GROW_WOOD_H

#include "tree/builder.h"
#include "tree/skeleton.h"

void pps_wood_build(const pps_species *species, uint64_t seed,
                    const pps_skeleton *skeleton, uint32_t material, pps_builder *b);

#endif
