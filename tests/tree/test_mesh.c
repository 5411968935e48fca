/* Meshes, crowns and scenes: what is a leaf, and how much of it there is.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>
#include <ppscat/tree/scene.h>

#include "plants.h"
#include "support/support.h"

static const double PI = 3.14159265358979323846;

static void triangles_that_share_an_edge_are_one_leaf(void **state) {
    (void)state;
    /* Wood between; two squares side by side; one that touches them in a corner. */
    square at[] = {{0, 0, 0, 0}, {5, 5, 0, 1}, {1, 0, 0, 0}, {2, 1, 0, 0}};
    pps_mesh *mesh = squares(4, at);
    assert_int_equal(mesh->n_leaves, 2);
    assert_int_equal(mesh->leaf[0].n_triangles, 4);
    assert_close(mesh->leaf[0].area, 2, 1e-15, 0);
    assert_close(mesh->leaf[0].center[0], 1, 1e-15, 0);
    assert_close(mesh->leaf[0].normal[2], 1, 1e-15, 0);
    assert_close(mesh->leaf[1].center[0], 2.5, 1e-15, 0);
    assert_int_equal(mesh->leaf_of[6], PPS_NO_LEAF);
    assert_int_equal(mesh->leaf_of[7], PPS_NO_LEAF);
    assert_int_equal(mesh->material_of[7], 1);
    pps_mesh_free(mesh);
}

/* Two cards that cross in a common line, each cut along it. */
static void crossed_cards_are_two_leaves(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
    pps_mesh *mesh = squares(4, at);
    for (int k = 2; k < 4; k++) { /* stand these two up on the line x = 1 */
        for (int c = 0; c < 4; c++) {
            double *p = mesh->position[4 * k + c];
            p[2] = k == 2 ? 1 - p[0] : -p[0];
            p[0] = 1;
        }
    }
    assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
    assert_int_equal(mesh->n_leaves, 2);
    for (int i = 0; i < 2; i++) {
        assert_close(mesh->leaf[i].area, 2, 1e-15, 0);
        assert_close(fabs(mesh->leaf[i].normal[i ? 0 : 2]), 1, 1e-15, 0);
        assert_close(mesh->leaf[i].center[0], 1, 1e-15, 0);
    }
    pps_mesh_free(mesh);
}

static void foliage_in_one_piece_falls_into_triangles(void **state) {
    (void)state;
    enum { N = PPS_LEAF_TRIANGLES / 2 };
    square at[N + 1];
    for (int i = 0; i <= N; i++) {
        at[i] = (square){i, 0, 0, 0};
    }
    pps_mesh *mesh = squares(N, at);
    assert_int_equal(mesh->n_leaves, 1);
    pps_mesh_free(mesh);
    mesh = squares(N + 1, at);
    assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
    assert_int_equal(mesh->n_leaves, 2 * (N + 1));
    pps_mesh_free(mesh);
}

static void bad_indices_are_refused(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, 0}};
    pps_mesh *mesh = squares(1, at);
    mesh->triangle[1][2] = 4;
    assert_int_equal(pps_mesh_finish(mesh), PPS_ERR_ARGUMENT);
    mesh->triangle[1][2] = 3;
    mesh->material_of[0] = 2;
    assert_int_equal(pps_mesh_finish(mesh), PPS_ERR_ARGUMENT);
    mesh->material_of[0] = 0;
    mesh->n_triangles = 0;
    assert_int_equal(pps_mesh_finish(mesh), PPS_ERR_ARGUMENT);
    pps_mesh_free(mesh);
}

/* A texture whose right half is clear: half of every square is there. */
static void alpha_counts_in_the_leaf_area(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, LEAF}};
    pps_mesh *mesh = squares(1, at);
    cut_right_half(mesh);
    assert_close(mesh->leaf[0].area, 0.5, 0.02, 0);
    pps_mesh_free(mesh);
}

static void leaf_area_index_is_area_over_the_hull(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, 0}, {0, 0, 1, 0}, {1, 1, 2, 0}};
    pps_mesh *mesh = squares(3, at);
    pps_mesh_size size;
    pps_mesh_measure(mesh, &size);
    assert_close(size.leaf_area, 3, 1e-15, 0);
    assert_close(size.leaf_area_index, 1, 1e-15, 0); /* the hull has area 3 */
    assert_close(size.radius, 1, 1e-15, 0);
    assert_close(size.center[2], 1, 1e-15, 0);
    pps_mesh_free(mesh);
}

/* The hull is that of the vertices, so a little wider than the ball of the centres. */
static void crowns_have_the_leaf_area_asked_for(void **state) {
    (void)state;
    for (int shape = 0; shape <= PPS_CROWN_HOLLOW; shape++) {
        pps_crown crown = {(pps_crown_shape)shape, 4, 2000, 7};
        pps_mesh *mesh;
        pps_mesh_size size;
        assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
        pps_mesh_measure(mesh, &size);
        assert_int_equal(mesh->n_leaves, 2000);
        assert_close(size.leaf_area, 4 * PI, 1e-12, 0);
        assert_close(size.leaf_area_index, 4, 0.1, 0);
        assert_close(size.high[2] - size.low[2], shape == PPS_CROWN_TALL ? 4 : 2, 0.1,
                     0);
        for (size_t i = 0; shape == PPS_CROWN_HOLLOW && i < mesh->n_leaves; i++) {
            const double *p = mesh->leaf[i].center;
            assert_true(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] > 0.25 - 1e-12);
        }
        pps_mesh_free(mesh);
    }
}

static void random_leaves_face_all_ways(void **state) {
    (void)state;
    pps_crown crown = {PPS_CROWN_UNIFORM, 1, 20000, 3};
    pps_mesh *mesh;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    double first[3] = {0}, second[3] = {0};
    for (size_t i = 0; i < mesh->n_leaves; i++) {
        for (int k = 0; k < 3; k++) {
            first[k] += mesh->leaf[i].normal[k] / 20000;
            second[k] += mesh->leaf[i].normal[k] * mesh->leaf[i].normal[k] / 20000;
        }
    }
    for (int k = 0; k < 3; k++) { /* four standard errors of the mean */
        assert_close(first[k], 0, 0, 4 * sqrt(1 / 3.0 / 20000));
        assert_close(second[k], 1 / 3.0, 0, 4 * sqrt(4 / 45.0 / 20000));
    }
    pps_mesh_free(mesh);
}

static void a_seed_is_a_crown(void **state) {
    (void)state;
    pps_crown crown = {PPS_CROWN_CLUMPED, 1.2, 100, 1};
    pps_mesh *a, *b;
    assert_int_equal(pps_crown_grow(&crown, &a), PPS_OK);
    assert_int_equal(pps_crown_grow(&crown, &b), PPS_OK);
    assert_memory_equal(a->position, b->position, a->n_vertices * sizeof *a->position);
    pps_mesh_free(b);
    crown.seed = 2;
    assert_int_equal(pps_crown_grow(&crown, &b), PPS_OK);
    assert_memory_not_equal(a->position, b->position,
                            a->n_vertices * sizeof *a->position);
    pps_mesh_free(a);
    pps_mesh_free(b);
    crown.leaf_area_index = 0;
    assert_int_equal(pps_crown_grow(&crown, &a), PPS_ERR_ARGUMENT);
    assert_null(a);
}

static void leaves_of_instances_are_placed_turned_and_scaled(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, 0}, {5, 5, 0, 0}};
    pps_mesh *mesh = squares(2, at);
    pps_scene *scene;
    assert_int_equal(pps_scene_single(mesh, 0.9, &scene), PPS_OK);
    scene->instance = realloc(scene->instance, 2 * sizeof *scene->instance);
    scene->n_instances = 2;
    scene->instance[1] = (pps_instance){0, {10, 0, 1}, 90, 2};
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    assert_int_equal(scene->n_leaves, 4);
    pps_scene_leaf leaf;
    pps_scene_leaf_at(scene, 2, &leaf);
    assert_int_equal(leaf.instance, 1);
    assert_int_equal(leaf.leaf, 0);
    assert_close(leaf.center[0], 9, 1e-15, 0);
    assert_close(leaf.center[1], 1, 1e-15, 0);
    assert_close(leaf.center[2], 1, 1e-15, 0);
    assert_close(leaf.area, 4, 1e-15, 0);
    pps_scene_leaf_at(scene, 1, &leaf);
    assert_close(leaf.center[0], 5.5, 1e-15, 0);

    pps_box all, leaves;
    pps_scene_box(scene, &all, &leaves);
    assert_close(all.low[0], -2, 1e-15, 0);
    assert_close(all.high[1], 12, 1e-15, 0);

    scene->instance[1].scale = 0;
    assert_int_equal(pps_scene_index(scene), PPS_ERR_ARGUMENT);
    scene->instance[1].scale = 1;
    scene->prototype[0].optics.reflectance[0][0] = 0.6;
    assert_int_equal(pps_scene_index(scene), PPS_ERR_ARGUMENT);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_that_share_an_edge_are_one_leaf),
        cmocka_unit_test(crossed_cards_are_two_leaves),
        cmocka_unit_test(foliage_in_one_piece_falls_into_triangles),
        cmocka_unit_test(bad_indices_are_refused),
        cmocka_unit_test(alpha_counts_in_the_leaf_area),
        cmocka_unit_test(leaf_area_index_is_area_over_the_hull),
        cmocka_unit_test(crowns_have_the_leaf_area_asked_for),
        cmocka_unit_test(random_leaves_face_all_ways),
        cmocka_unit_test(a_seed_is_a_crown),
        cmocka_unit_test(leaves_of_instances_are_placed_turned_and_scaled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
