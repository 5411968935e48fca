/* What bark and petals look like from near.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_GROW_TEXTURES_H
#define PPS_TREE_GROW_TEXTURES_H

#include "tree/species.h"

/* Bark with short level dashes (lenticels), as strong as /wood/lenticels; it repeats both
 * ways. rgba is NULL where memory is short. */
pps_texture pps_grow_bark(const pps_species *species, uint64_t seed);

/* A petal that is darker towards its base, as strongly as /leaves/heart. */
pps_texture pps_grow_petal(const pps_species *species);

#endif
