/* Small plants and scenes that the tests of the tree library are about.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TESTS_TREE_PLANTS_H
#define PPS_TESTS_TREE_PLANTS_H

#include <ppscat/tree/grow.h>
#include <ppscat/tree/scene.h>

enum { LEAF, WOOD }; /* materials */

/* A square of side 1, level, with its least corner here and its front up. */
typedef struct {
    double x, y, z;
    uint32_t material;
} square;

/* A finished mesh of squares; squares that touch along an edge are one leaf. */
pps_mesh *squares(size_t n, const square *at);

/* Give a mesh of squares a texture whose half x > 0.5 is cut out, and finish it again. */
void cut_right_half(pps_mesh *mesh);

/* A scene of one mesh, or of one crown: sun overhead, albedo 0.9. */
pps_scene *scene_of(pps_mesh *mesh);
pps_scene *crown_scene(pps_crown_shape shape, double leaf_area_index, uint32_t n_leaves,
                       uint64_t seed);

/* Give a scene of one prototype n bands of these albedos, half reflected and half
 * transmitted on both faces, under a sun of 1. */
void set_albedos(pps_scene *scene, int n, const double *albedo);

/* A layer that repeats with period 1, filled evenly to height 1 with n small squares of
 * random orientation, `leaf_area_index` of them over each other. */
pps_scene *layer_scene(double leaf_area_index, uint32_t n, uint64_t seed);

/* Two clumped crowns, one turned and smaller, some of it wood, lit by sun and sky in three
 * bands that differ in all their optics; over a ground or not. */
pps_scene *three_bands(bool periodic, bool ground);

#endif
