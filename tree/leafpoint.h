/* Random points on leaves.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_LEAFPOINT_H
#define PPS_TREE_LEAFPOINT_H

#include <ppscat/tree/scene.h>

#include "tree/random.h"

typedef struct {
    size_t instance;
    uint32_t triangle;          /* of the instance's mesh */
    double u, v;                /* where on it: a + u (b - a) + v (c - a) */
    double point[3], normal[3]; /* in the scene; the triangle's normal, unit */
} pps_leaf_point;

/* A point of scene leaf `leaf`, evenly over its surface where it is there (alpha); it
 * depends on (seed, stream, item) alone and uses the events from FIRST_POINT_EVENT on. */
#define FIRST_POINT_EVENT ((uint64_t)1 << 32)
void pps_leaf_point_draw(const pps_scene *scene, size_t leaf, uint64_t seed,
                         pps_random_stream stream, uint64_t item, pps_leaf_point *out);

/* Point k of those spread over a scene leaf: any one of them is a fair draw, the first n
 * leave smaller holes than n draws. It depends on (seed, stream, leaf, k) alone. */
void pps_leaf_point_spread(const pps_scene *scene, size_t leaf, uint64_t seed,
                           pps_random_stream stream, uint64_t k, pps_leaf_point *out);

#endif
