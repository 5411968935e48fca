/* Growing and drawing when memory runs out: allocation n fails, for every n.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <jansson.h>

#include <ppscat/tree/picture.h>

#include "plants.h"
#include "support/allocation.h"
#include "support/support.h"

static int restore_allocation(void **state) {
    (void)state;
    allocations_left = -1;
    return 0;
}

/* A cherry so small that it grows in milliseconds. */
static void write_small_species(char *path) {
    int fd = mkstemps(path, 5);
    assert_true(fd >= 0);
    close(fd);
    json_t *root = json_load_file(CHERRY_JSON, 0, NULL);
    json_object_set_new(root, "triangles", json_integer(3000));
    json_object_set_new(json_object_get(root, "crown"), "points", json_integer(40));
    json_object_set_new(json_object_get(root, "crown"), "limbs", json_integer(5));
    assert_int_equal(json_dump_file(root, path, 0), 0);
    json_decref(root);
}

static void growing_says_when_memory_runs_out(void **state) {
    (void)state;
    char path[] = "/tmp/ppscat_species_XXXXXX.json";
    write_small_species(path);
    pps_status status = PPS_ERR_MEMORY;
    long n = 0;
    for (; status != PPS_OK; n++) {
        pps_mesh *mesh = NULL;
        allocations_left = n;
        status = pps_species_grow(path, 1, &mesh, NULL);
        allocations_left = -1;
        assert_true(status == PPS_OK || status == PPS_ERR_MEMORY);
        assert_true((mesh != NULL) == (status == PPS_OK));
        if (mesh) {
            assert_close((double)mesh->n_triangles, 3000, 0, 3);
        }
        pps_mesh_free(mesh);
    }
    assert_true(n > 30);
    remove(path);
}

static void drawing_says_when_memory_runs_out(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}, {0, 0, 2, WOOD}};
    pps_mesh *mesh = squares(2, at);
    mesh->uv = calloc(mesh->n_vertices, sizeof *mesh->uv);
    mesh->n_textures = 1;
    mesh->texture = calloc(1, sizeof *mesh->texture);
    mesh->texture[0] = (pps_texture){2, 2, calloc(4, 4)};
    mesh->material[LEAF].texture = 0;
    pps_scene *scene = scene_of(mesh);
    pps_irradiance *light;
    pps_camera camera;
    assert_int_equal(pps_irradiance_create(scene, false, &light), PPS_OK);
    light->front[0] = light->back[0] = 1;
    scene->period[0] = scene->period[1] = 3;
    pps_camera_fit(scene, 0, 30, 1, &camera);
    pps_status status = PPS_ERR_MEMORY;
    char path[64];
    snprintf(path, sizeof path, "/tmp/ppscat_memory_%ld.png", (long)getpid());
    long n = 0;
    for (; status != PPS_OK; n++) {
        pps_picture *picture = NULL;
        allocations_left = n;
        status = pps_picture_create(8, 8, &picture);
        status = status ? status : pps_render(scene, light, &camera, 1, picture);
        status = status ? status : pps_picture_write(picture, 0, path, NULL);
        allocations_left = -1;
        assert_true(status == PPS_OK || status == PPS_ERR_MEMORY);
        pps_picture_free(picture);
    }
    assert_true(n > 10);
    remove(path);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(growing_says_when_memory_runs_out,
                                  restore_allocation),
        cmocka_unit_test_teardown(drawing_says_when_memory_runs_out,
                                  restore_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
