/* Small plants and scenes that the tests of the tree library are about.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "plants.h"

#include <math.h>
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

pps_scene *three_bands(bool periodic, bool ground) {
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 3, 500, 4);
    pps_mesh *mesh = scene->prototype[0].mesh;
    for (size_t i = 0; i < 40; i++) { /* some of the leaves become wood */
        mesh->leaf_of[mesh->n_triangles - 1 - i] = PPS_NO_LEAF;
    }
    mesh->n_leaves -= 20;
    scene->instance = realloc(scene->instance, 2 * sizeof *scene->instance);
    scene->n_instances = 2;
    scene->instance[1] = (pps_instance){0, {0.9, 0.4, 0.3}, 50, 0.7};
    scene->n_bands = 3;
    pps_leaf_optics *o = &scene->prototype[0].optics;
    const double r[3] = {0.1, 0.5, 0.3}, t[3] = {0.05, 0.1, 0.6};
    for (int b = 0; b < 3; b++) {
        o->reflectance[0][b] = o->reflectance[1][b] = r[b];
        o->transmittance[0][b] = o->transmittance[1][b] = t[b];
        scene->sun.irradiance[b] = 1 + b;
        scene->sky.zenith[b] = 0.3 - 0.1 * b;
        scene->sky.horizon[b] = 0.1 * b;
        scene->sky.below[b] = 0.2;
        scene->ground.reflectance[b] = 0.2 + 0.1 * b;
    }
    const double to[3] = {1 / sqrt(1.89), 0.5 / sqrt(1.89), 0.8 / sqrt(1.89)};
    memcpy(scene->sun.to, to, sizeof to);
    scene->ground.present = ground;
    scene->ground.height = -1.2;
    scene->period[0] = scene->period[1] = periodic ? 2.3 : 0;
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    return scene;
}

void set_albedos(pps_scene *scene, int n, const double *albedo) {
    scene->n_bands = n;
    for (int b = 0; b < n; b++) {
        pps_leaf_optics *o = &scene->prototype[0].optics;
        scene->sun.irradiance[b] = 1;
        for (int face = 0; face < 2; face++) {
            o->reflectance[face][b] = o->transmittance[face][b] = albedo[b] / 2;
        }
    }
}
