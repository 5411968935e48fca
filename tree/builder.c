/* Meshes that grow: room doubles when it is full.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/builder.h"

#include <stdlib.h>
#include <string.h>

/* Room for `n` items of `size` bytes where there was some for `*room`, or failed. */
static void *more(pps_builder *b, void *items, size_t n, size_t size) {
    void *grown = b->failed ? NULL : realloc(items, n * size);
    b->failed = b->failed || !grown;
    return grown ? grown : items;
}

uint32_t pps_build_vertex(pps_builder *b, const double at[3], double u, double v) {
    pps_mesh *mesh = b->mesh;
    if (mesh->n_vertices == b->room_vertices) {
        size_t room = 2 * b->room_vertices + 1024;
        mesh->position = more(b, mesh->position, room, sizeof *mesh->position);
        mesh->uv = more(b, mesh->uv, room, sizeof *mesh->uv);
        b->room_vertices = b->failed ? b->room_vertices : room;
    }
    if (b->failed) {
        return 0;
    }
    memcpy(mesh->position[mesh->n_vertices], at, sizeof *mesh->position);
    mesh->uv[mesh->n_vertices][0] = (float)u;
    mesh->uv[mesh->n_vertices][1] = (float)v;
    return (uint32_t)mesh->n_vertices++;
}

void pps_build_triangle(pps_builder *b, uint32_t i, uint32_t j, uint32_t k,
                        uint32_t material) {
    pps_mesh *mesh = b->mesh;
    if (mesh->n_triangles == b->room_triangles) {
        size_t room = 2 * b->room_triangles + 1024;
        mesh->triangle = more(b, mesh->triangle, room, sizeof *mesh->triangle);
        mesh->material_of = more(b, mesh->material_of, room, sizeof *mesh->material_of);
        b->room_triangles = b->failed ? b->room_triangles : room;
    }
    if (!b->failed) {
        uint32_t corners[3] = {i, j, k};
        memcpy(mesh->triangle[mesh->n_triangles], corners, sizeof corners);
        mesh->material_of[mesh->n_triangles++] = material;
    }
}
