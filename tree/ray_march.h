/* The slab's light as a source along a real path through the crown (SPP A.1 in a tree).
 *
 * From depth d of thickness w a path leaves with cosine mu to the light and meets the
 * crown's surface after the optical length h. On it the slab's depth is d - s mu, held
 * at the slab's faces. Integrals of e^(-s) times the source over 0 < s < h, all closed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_RAY_MARCH_H
#define PPS_TREE_RAY_MARCH_H

#include "tree/slab_light.h"

/* Of the direct light e^(-z), and of the slab's scattered light. */
typedef struct pps_marched {
    double direct, scattered;
} pps_marched;

pps_marched pps_ray_march(const pps_slab_light *light, double d, double mu, double h);

#endif
