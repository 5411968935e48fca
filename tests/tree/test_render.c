/* Rendering scenes whose radiance is known.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include <ppscat/tree/picture.h>

#include "plants.h"
#include "support/support.h"
#include "tree/bar.h"
#include "tree/srgb.h"

static const double PI = 3.14159265358979323846;

/* The middle pixel of a picture taken from straight above (or below) a point. */
static void look_at(const pps_scene *scene, const pps_irradiance *irradiance, double x,
                    double y, double z, double eye_z, double rgb[3]) {
    pps_camera camera = {{x, y, eye_z}, {x, y, z}, {0, 1, 0}, 10};
    pps_picture *picture;
    assert_int_equal(pps_picture_create(3, 3, &picture), PPS_OK);
    assert_int_equal(pps_render(scene, irradiance, &camera, 2, picture), PPS_OK);
    for (int c = 0; c < 3; c++) {
        rgb[c] = (double)picture->rgb[3 * 4 + c];
    }
    pps_picture_free(picture);
}

static pps_irradiance *no_light(const pps_scene *scene) {
    pps_irradiance *irradiance;
    assert_int_equal(pps_irradiance_create(scene, false, &irradiance), PPS_OK);
    for (size_t i = 0; i < scene->n_leaves * (size_t)scene->n_bands; i++) {
        irradiance->front[i] = irradiance->back[i] = 0;
    }
    return irradiance;
}

/* A level leaf under the sun of irradiance 1: R/pi from above, T/pi from below. */
static void a_leaf_shines_by_its_irradiance_and_optics(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}};
    pps_scene *scene = scene_of(squares(1, at));
    pps_irradiance *light = no_light(scene);
    pps_leaf_optics *optics = &scene->prototype[0].optics;
    double rgb[3];
    optics->reflectance[PPS_FRONT][0] = 0.5;
    optics->transmittance[PPS_FRONT][0] = 0.3;
    optics->reflectance[PPS_BACK][0] = 0.4;
    optics->transmittance[PPS_BACK][0] = 0.2;
    light->front[0] = 1;
    look_at(scene, light, 0.5, 0.5, 1, 3, rgb);
    assert_close(rgb[0], 0.5 / PI, 1e-7, 0);
    assert_close(rgb[2], 0.5 / PI, 1e-7, 0);
    look_at(scene, light, 0.5, 0.5, 1, -3, rgb);
    assert_close(rgb[1], 0.3 / PI, 1e-7, 0);
    light->back[0] = 2;
    look_at(scene, light, 0.5, 0.5, 1, 3, rgb);
    assert_close(rgb[1], (0.5 + 0.2 * 2) / PI, 1e-7, 0);
    look_at(scene, light, 0.5, 0.5, 1, -3, rgb);
    assert_close(rgb[0], (0.4 * 2 + 0.3) / PI, 1e-7, 0);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

/* Wood of colour c under a sun of irradiance 1 at 60 degrees from its normal; a sky of
 * radiance 1 all over adds c. In the shadow of a leaf the sun is gone. */
static void wood_has_the_light_of_sun_and_sky(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, WOOD}, {30, 0, 1, WOOD}, {30, 0, 2, LEAF}};
    pps_scene *scene = scene_of(squares(3, at));
    pps_irradiance *light = no_light(scene);
    double rgb[3];
    pps_material *wood = &scene->prototype[0].mesh->material[WOOD];
    for (int c = 0; c < 3; c++) {
        wood->color[c] = 0.6;
    }
    scene->sun.to[0] = 0;
    scene->sun.to[1] = sqrt(3) / 2;
    scene->sun.to[2] = 0.5;
    look_at(scene, light, 0.5, 0.5, 1, 3, rgb);
    assert_close(rgb[0], 0.6 / PI / 2, 1e-6, 0);
    look_at(scene, light, 30.5, 0.1, 1, 1.9, rgb);
    assert_close(rgb[0], 0.6 / PI / 2, 1e-6, 0);
    scene->sun.to[1] = 0;
    scene->sun.to[2] = 1;
    look_at(scene, light, 30.5, 0.5, 1, 1.9, rgb);
    assert_close(rgb[0], 0, 0, 0);
    scene->sky.zenith[0] = scene->sky.horizon[0] = 1;
    look_at(scene, light, 0.5, 0.5, 1, 3, rgb);
    assert_close(rgb[0], 0.6 / PI + 0.6, 1e-6, 0);
    /* From below it is dark: no sun, and the sky is above. */
    look_at(scene, light, 0.5, 0.5, 1, -3, rgb);
    assert_close(rgb[0], 0, 0, 0);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

static void the_ground_is_lit_or_in_shadow(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, WOOD}};
    pps_scene *scene = scene_of(squares(1, at));
    pps_irradiance *light = no_light(scene);
    double rgb[3];
    scene->ground.present = true;
    scene->ground.reflectance[0] = 0.3;
    look_at(scene, light, 50, 50, 0, 3, rgb);
    assert_close(rgb[0], 0.3 / PI, 1e-6, 0);
    look_at(scene, light, 0.5, 0.5, 0, 0.9, rgb);
    assert_close(rgb[0], 0, 0, 0);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

/* Leaves of a crown that give off a known radiance light a plank inside it: all around and
 * dense, they light it as a sky of their radiance would. */
static void wood_has_the_light_of_leaves(void **state) {
    (void)state;
    enum { SHEETS = 4 };
    square at[SHEETS + 1] = {{0, 0, 1, WOOD}};
    for (int i = 0; i < SHEETS; i++) { /* a roof close above the plank */
        at[i + 1] = (square){(i & 1) - 0.5, (i >> 1) - 0.5, 1.02, LEAF};
    }
    pps_scene *scene = scene_of(squares(SHEETS + 1, at));
    pps_irradiance *light = no_light(scene);
    double rgb[3];
    scene->sun.irradiance[0] = 0;
    scene->prototype[0].mesh->material[WOOD].color[0] = 0.5;
    scene->prototype[0].mesh->material[WOOD].color[1] = 0.5;
    scene->prototype[0].mesh->material[WOOD].color[2] = 0.5;
    for (size_t i = 0; i < scene->n_leaves; i++) {
        light->back[i] = 1;
    }
    look_at(scene, light, 0.5, 0.5, 1, 1.01, rgb); /* the leaves' radiance is .45/pi */
    assert_close(rgb[0], 0.5 * 0.45 / PI, 0.02, 0);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

static void sky_and_bands_are_where_they_belong(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}};
    pps_scene *scene = scene_of(squares(1, at));
    double rgb[3];
    for (int b = 1; b < 3; b++) {
        scene->band[b] = calloc(8, 1);
    }
    scene->n_bands = 3;
    for (int b = 0; b < 3; b++) {
        scene->sky.zenith[b] = b + 1;
        scene->sky.below[b] = 10 * (b + 1);
    }
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    pps_irradiance *light = no_light(scene);
    look_at(scene, light, 9, 9, 9, 1, rgb);
    for (int c = 0; c < 3; c++) {
        assert_close(rgb[c], c + 1, 1e-3, 0);
    }
    look_at(scene, light, 9, 9, -9, 1, rgb);
    for (int c = 0; c < 3; c++) {
        assert_close(rgb[c], 10 * (c + 1), 1e-6, 0);
    }
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

/* The texture's pattern is seen, but the leaf as a whole has the radiance of its optics. */
static void a_texture_keeps_the_mean_radiance(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}};
    pps_mesh *mesh = squares(1, at);
    mesh->uv = calloc(4, sizeof *mesh->uv);
    for (int c = 0; c < 4; c++) {
        mesh->uv[c][0] = (float)mesh->position[c][0];
        mesh->uv[c][1] = (float)mesh->position[c][1];
    }
    mesh->n_textures = 1;
    mesh->texture = calloc(1, sizeof *mesh->texture);
    mesh->texture[0] = (pps_texture){16, 16, calloc(4, 256)};
    for (int i = 0; i < 256; i++) { /* left dark, right bright, and no red */
        memset(&mesh->texture[0].rgba[4 * i], i % 16 < 8 ? 60 : 220, 4);
        mesh->texture[0].rgba[4 * i] = 0;
    }
    mesh->material[LEAF].texture = 0;
    pps_scene *scene = scene_of(mesh);
    pps_irradiance *light = no_light(scene);
    double left[3], right[3];
    light->front[0] = 1;
    look_at(scene, light, 0.25, 0.5, 1, 1.5, left);
    look_at(scene, light, 0.75, 0.5, 1, 1.5, right);
    for (int c = 0; c < 3; c++) { /* one band: grey */
        assert_close((left[c] + right[c]) / 2, 0.45 / PI, 1e-6, 0);
    }
    assert_close(right[0] / left[0], srgb_decode(220 / 255.0) / srgb_decode(60 / 255.0),
                 1e-5, 0);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

/* From all sides the crown is inside the frame, and fills most of it. */
static void the_camera_has_the_whole_scene_in_view(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_TALL, 4, 3000, 1);
    pps_irradiance *light = no_light(scene);
    for (size_t i = 0; i < scene->n_leaves; i++) {
        light->front[i] = light->back[i] = 1;
    }
    enum { W = 90, H = 60 };
    pps_picture *picture;
    assert_int_equal(pps_picture_create(W, H, &picture), PPS_OK);
    static const double elevation[] = {0, 30, 90};
    for (int k = 0; k < 3; k++) {
        pps_camera camera;
        int low = W, high = 0, up = H, down = 0;
        pps_camera_fit(scene, 40 * k, elevation[k], (double)W / H, &camera);
        assert_int_equal(pps_render(scene, light, &camera, 2, picture), PPS_OK);
        for (int i = 0; i < W * H; i++) {
            if (picture->rgb[3 * i] > 0) {
                low = i % W < low ? i % W : low;
                high = i % W > high ? i % W : high;
                up = i / W < up ? i / W : up;
                down = i / W > down ? i / W : down;
            }
        }
        assert_true(low > 0 && high < W - 1 && up > 0 && down < H - 1);
        assert_true(down - up > 0.8 * H);
    }
    pps_picture_free(picture);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

/* x to the right, z up, seen from -y: a leaf at the right is at the right. */
static void pictures_are_not_mirrored(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, WOOD}, {4, 0, 0, WOOD}, {4, 0, 2, LEAF}};
    pps_scene *scene = scene_of(squares(3, at));
    pps_irradiance *light = no_light(scene);
    light->front[0] = light->back[0] = 1;
    pps_camera camera;
    pps_picture *picture;
    assert_int_equal(pps_picture_create(80, 60, &picture), PPS_OK);
    pps_camera_fit(scene, -90, 20, 80 / 60.0, &camera);
    assert_true(camera.eye[1] < -3);
    assert_int_equal(pps_render(scene, light, &camera, 1, picture), PPS_OK);
    double right = 0, top = 0, n = 0;
    for (int i = 0; i < 80 * 60; i++) {
        if (picture->rgb[3 * i] > 0.05F) {
            right += i % 80 > 40;
            top += i / 80 < 30;
            n++;
        }
    }
    assert_true(n > 20);
    assert_close(right / n, 1, 0, 0);
    assert_close(top / n, 1, 0, 0);
    pps_picture_free(picture);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

static void threads_do_not_change_the_picture(void **state) {
    (void)state;
    pps_mesh *mesh;
    pps_scene *scene;
    pps_camera camera;
    pps_picture *picture[2];
    assert_int_equal(pps_species_grow("cherry", 1, &mesh, NULL), PPS_OK);
    assert_int_equal(pps_scene_single(mesh, 0.9, &scene), PPS_OK);
    scene->ground.present = true;
    scene->ground.reflectance[0] = 0.2;
    scene->sky.zenith[0] = 1;
    pps_irradiance *light = no_light(scene);
    pps_camera_fit(scene, 30, 10, 1, &camera);
    int before = omp_get_max_threads();
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i ? 5 : 1);
        assert_int_equal(pps_picture_create(60, 60, &picture[i]), PPS_OK);
        assert_int_equal(pps_render(scene, light, &camera, 2, picture[i]), PPS_OK);
    }
    omp_set_num_threads(before);
    assert_memory_equal(picture[0]->rgb, picture[1]->rgb,
                        60 * 60 * 3 * sizeof *picture[0]->rgb);
    pps_picture_free(picture[0]);
    pps_picture_free(picture[1]);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

static void false_colours_show_the_value(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}, {2, 0, 1, LEAF}, {4, 0, 1, LEAF}};
    pps_scene *scene = scene_of(squares(3, at));
    double value[] = {-5, (double)NAN, 30};
    pps_false_color color = {
        .value = value, .low = 0, .high = 10, .title = "irradiance"};
    pps_camera camera = {{2.5, 0.5, 14}, {2.5, 0.5, 1}, {0, 1, 0}, 30};
    pps_picture *picture;
    assert_int_equal(pps_picture_create(800, 400, &picture), PPS_OK);
    assert_int_equal(pps_render_false(scene, &color, &camera, 1, picture), PPS_OK);
    int key = pps_bar_width(picture), middle = (800 - key) / 2;
    assert_true(key > 40 && key < 200);
    double low[3], high[3];
    pps_bar_color(&color, 0, low);
    pps_bar_color(&color, 10, high);
    assert_close(low[2], srgb_decode(84 / 255.0), 1e-12, 0);
    assert_close(high[0], srgb_decode(253 / 255.0), 1e-12, 0);
    const float *row = &picture->rgb[3 * 800 * 200];
    int seen[4] = {0, 0, 0, 0};
    for (int x = 0; x < 800 - key; x++) {
        seen[0] += fabs((double)row[3 * x] - low[0]) < 1e-6 && x < middle;
        seen[1] += fabs((double)row[3 * x] - 0.35) < 1e-6 && abs(x - middle) < 40;
        seen[2] += fabs((double)row[3 * x] - high[0]) < 1e-6 && x > middle;
        seen[3] += row[3 * x] == 1;
    }
    for (int i = 0; i < 4; i++) {
        assert_true(seen[i] > 10);
    }
    color.low = 10;
    assert_int_equal(pps_render_false(scene, &color, &camera, 1, picture),
                     PPS_ERR_ARGUMENT);
    pps_picture_free(picture);
    pps_scene_free(scene);
}

/* Period 4: copies of the plank are not seen, but their shadows are. */
static void a_scene_that_repeats_is_shown_once_and_lit_amid_all(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, WOOD}};
    pps_scene *scene = scene_of(squares(1, at));
    pps_irradiance *light = no_light(scene);
    double rgb[3];
    scene->prototype[0].mesh->material[WOOD].color[0] = 1;
    scene->prototype[0].mesh->material[WOOD].color[1] = 1;
    scene->prototype[0].mesh->material[WOOD].color[2] = 1;
    scene->ground.present = true;
    scene->ground.reflectance[0] = 0.3;
    scene->period[0] = scene->period[1] = 4;
    look_at(scene, light, 0.5, 0.5, 0, 3, rgb); /* the plank itself */
    assert_close(rgb[0], 1 / PI, 1e-6, 0);
    look_at(scene, light, 12.5, -7.5, 0, 3, rgb); /* the ground under a copy */
    assert_close(rgb[0], 0, 0, 0);
    look_at(scene, light, 14.5, -7.5, 0, 3, rgb); /* between copies */
    assert_close(rgb[0], 0.3 / PI, 1e-6, 0);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}, {3, 0, 1, LEAF}};
    pps_scene *scene = scene_of(squares(1, at)), *other = scene_of(squares(2, at));
    pps_irradiance *light = no_light(scene);
    pps_camera camera;
    pps_picture *picture;
    assert_int_equal(pps_picture_create(8, 8, &picture), PPS_OK);
    pps_camera_fit(scene, 0, 0, 1, &camera);
    assert_int_equal(pps_render(scene, light, &camera, 1, picture), PPS_OK);
    assert_int_equal(pps_render(other, light, &camera, 1, picture), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_render(scene, light, &camera, 0, picture), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_render(scene, light, &camera, 17, picture), PPS_ERR_ARGUMENT);
    memcpy(camera.up, camera.target, sizeof camera.up);
    for (int i = 0; i < 3; i++) {
        camera.up[i] = camera.eye[i] - camera.target[i];
    }
    assert_int_equal(pps_render(scene, light, &camera, 1, picture), PPS_ERR_ARGUMENT);
    pps_picture_free(picture);
    pps_irradiance_free(light);
    pps_scene_free(scene);
    pps_scene_free(other);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_leaf_shines_by_its_irradiance_and_optics),
        cmocka_unit_test(wood_has_the_light_of_sun_and_sky),
        cmocka_unit_test(the_ground_is_lit_or_in_shadow),
        cmocka_unit_test(wood_has_the_light_of_leaves),
        cmocka_unit_test(sky_and_bands_are_where_they_belong),
        cmocka_unit_test(a_texture_keeps_the_mean_radiance),
        cmocka_unit_test(the_camera_has_the_whole_scene_in_view),
        cmocka_unit_test(pictures_are_not_mirrored),
        cmocka_unit_test(threads_do_not_change_the_picture),
        cmocka_unit_test(false_colours_show_the_value),
        cmocka_unit_test(a_scene_that_repeats_is_shown_once_and_lit_amid_all),
        cmocka_unit_test(bad_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
