/* Vertices and triangles added one by one to a mesh.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_BUILDER_H
#define PPS_TREE_BUILDER_H

#include <ppscat/tree/mesh.h>

/* When memory runs out `failed` is set and nothing more is added: look once at the end. */
typedef struct pps_builder {
    pps_mesh *mesh;
    size_t room_vertices, room_triangles;
    bool failed;
} pps_builder;

/* Number of the vertex; 0 when failed. */
uint32_t pps_build_vertex(pps_builder *b, const double at[3], double u, double v);
void pps_build_triangle(pps_builder *b, uint32_t i, uint32_t j, uint32_t k,
                        uint32_t material);

#endif
