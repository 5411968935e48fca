/* Small plants and scenes that the tests of the tree library are about.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "plants.h"

#include <stdlib.h>
#include <string.h>

#include "support/support.h"

pps_mesh *squares(size_t n, const square *at) {
    pps_mesh *mesh = calloc(1, sizeof *mesh);
    mesh->n_vertices = 4 * n;
    mesh->n_triangles = 2 * n;
    mesh->n_materials = 2;
    mesh->position = calloc(4 * n, sizeof *mesh->position);
    mesh->triangle = calloc(2 * n, sizeof *mesh->triangle);
    mesh->material_of = calloc(2 * n, sizeof *mesh->material_of);
    mesh->material = calloc(2, sizeof *mesh->material);
    for (int i = 0; i < 2; i++) {
        mesh->material[i].name = calloc(8, 1);
        mesh->material[i].leaf = i == LEAF;
        mesh->material[i].texture = -1;
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t c = 0; c < 4; c++) {
            double *p = mesh->position[4 * i + c];
            p[0] = at[i].x + (c == 1 || c == 2);
            p[1] = at[i].y + (c >= 2);
            p[2] = at[i].z;
        }
        uint32_t two[2][3] = {{4 * i, 4 * i + 1, 4 * i + 2},
                              {4 * i, 4 * i + 2, 4 * i + 3}};
        memcpy(mesh->triangle[2 * i], two, sizeof two);
        mesh->material_of[2 * i] = mesh->material_of[2 * i + 1] = at[i].material;
    }
    assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
    return mesh;
}

void cut_right_half(pps_mesh *mesh) {
    mesh->uv = calloc(mesh->n_vertices, sizeof *mesh->uv);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        mesh->uv[v][0] = (v % 4 == 1 || v % 4 == 2) ? 0.9999F : 0;
        mesh->uv[v][1] = v % 4 >= 2 ? 0.9999F : 0;
    }
    mesh->n_textures = 1;
    mesh->texture = calloc(1, sizeof *mesh->texture);
    mesh->texture[0] = (pps_texture){64, 64, calloc(4, 64 * 64)};
    for (int i = 0; i < 64 * 64; i++) {
        mesh->texture[0].rgba[4 * i + 3] = i % 64 < 32 ? 255 : 0;
    }
    mesh->material[LEAF].texture = 0;
    mesh->material[LEAF].alpha_min = 0.5;
    assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
}

pps_scene *scene_of(pps_mesh *mesh) {
    pps_scene *scene;
    assert_int_equal(pps_scene_single(mesh, 0.9, &scene), PPS_OK);
    return scene;
}

pps_scene *crown_scene(pps_crown_shape shape, double leaf_area_index, uint32_t n_leaves,
                       uint64_t seed) {
    pps_crown crown = {shape, leaf_area_index, n_leaves, seed};
    pps_mesh *mesh;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    return scene_of(mesh);
}

pps_scene *layer_scene(double leaf_area_index, uint32_t n, uint64_t seed) {
    pps_crown crown = {PPS_CROWN_UNIFORM, leaf_area_index / 3.14159265358979323846, n,
                       seed}; /* of area leaf_area_index, whatever its shape */
    pps_mesh *mesh;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    uint64_t state = seed + 1;
    for (uint32_t i = 0; i < n; i++) { /* move each leaf to a place of its own */
        for (int k = 0; k < 3; k++) {
            double by = support_random(&state) - mesh->leaf[i].center[k];
            uint32_t first = mesh->triangle[2 * i][0];
            for (uint32_t corner = 0; corner < 4; corner++) {
                mesh->position[first + corner][k] += by;
            }
        }
    }
    assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
    pps_scene *scene = scene_of(mesh);
    scene->period[0] = scene->period[1] = 1;
    return scene;
}
