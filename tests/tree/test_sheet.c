/* Sheets of panels, and what a picture of a lit crown must show.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>
#include <ppscat/tree/model.h>
#include <ppscat/tree/picture.h>

#include "support/support.h"

/* ---- sheets ---- */

static pps_picture *plain(int width, int height, float grey) {
    pps_picture *picture;
    assert_int_equal(pps_picture_create(width, height, &picture), PPS_OK);
    for (int i = 0; i < 3 * width * height; i++) {
        picture->rgb[i] = grey;
    }
    return picture;
}

/* How many pixels of a rectangle have that grey. */
static int count(const pps_picture *picture, int x0, int y0, int width, int height,
                 float grey) {
    int n = 0;
    for (int y = y0; y < y0 + height; y++) {
        for (int x = x0; x < x0 + width; x++) {
            n += picture->rgb[3 * (y * picture->width + x)] == grey;
        }
    }
    return n;
}

/* Lines of 14 pixels above each row and below all, 4 pixels between panels. */
static void panels_are_in_rows_under_their_captions(void **state) {
    (void)state;
    enum { W = 60, H = 40, LINE = 14, GAP = 4 };
    pps_picture *panel[] = {plain(W, H, 0.25F), plain(W, H, 0.5F), NULL}, *out;
    const char *caption[] = {"one", "two", "none"};
    pps_sheet sheet = {.columns = 2, .n = 3, .panel = panel, .caption = caption};
    assert_int_equal(pps_sheet_draw(&sheet, &out), PPS_OK);
    assert_int_equal(out->width, 2 * W + GAP);
    assert_int_equal(out->height, 2 * (LINE + H));
    assert_int_equal(count(out, 0, LINE, W, H, 0.25F), W * H);
    assert_int_equal(count(out, W + GAP, LINE, W, H, 0.5F), W * H);
    assert_int_equal(count(out, 0, 2 * LINE + H, W, H, 1), W * H); /* blank */
    assert_int_equal(count(out, W, 0, GAP, 2 * (LINE + H), 1), GAP * 2 * (LINE + H));
    assert_true(count(out, 0, 0, W, LINE, 0) > 10); /* letters */
    assert_true(count(out, W + GAP, 0, W, LINE, 0) > 10);
    assert_true(count(out, 0, LINE + H, W, LINE, 0) > 10);
    pps_picture_free(out);
    sheet.footer = "a line that is far too long for a sheet as small as this one";
    assert_int_equal(pps_sheet_draw(&sheet, &out), PPS_OK);
    assert_int_equal(out->height, 2 * (LINE + H) + LINE);
    assert_true(count(out, 0, 2 * (LINE + H), out->width, LINE, 0) > 50);
    pps_picture_free(out);
    pps_picture_free(panel[0]);
    pps_picture_free(panel[1]);
}

static void a_key_stands_at_the_right(void **state) {
    (void)state;
    pps_picture *panel[] = {plain(200, 100, 0.5F)}, *out;
    const char *caption[] = {"x"};
    pps_false_color key = {.low = 0, .high = 1, .title = "depth"};
    pps_sheet sheet = {
        .columns = 1, .n = 1, .panel = panel, .caption = caption, .key = &key};
    assert_int_equal(pps_sheet_draw(&sheet, &out), PPS_OK);
    assert_true(out->width > 200);
    assert_int_equal(count(out, 0, 28, 200, 100, 0.5F), 200 * 100);
    assert_true(count(out, 200, 0, out->width - 200, out->height, 1) <
                (out->width - 200) * out->height); /* colours and ticks */
    pps_picture_free(out);
    pps_picture_free(panel[0]);
}

/* White is made of the brightest percent of all pixels together; then all are as bright,
 * one to another, as they were. */
static void pictures_are_exposed_alike(void **state) {
    (void)state;
    pps_picture *panel[] = {plain(20, 10, 0.25F), NULL, plain(20, 10, 0.5F)};
    double exposure;
    assert_int_equal(pps_picture_exposure(3, panel, &exposure), PPS_OK);
    assert_close(exposure, 2, 1e-7, 0);
    for (int i = 0; i < 4; i++) {
        panel[0]->rgb[3 * i + 1] = 4; /* 4 of 400 pixels */
    }
    assert_int_equal(pps_picture_exposure(3, panel, &exposure), PPS_OK);
    assert_close(exposure, 0.25, 1e-7, 0);
    pps_picture_expose(panel[0], exposure);
    pps_picture_expose(panel[2], exposure);
    assert_close((double)panel[2]->rgb[7] / (double)panel[0]->rgb[30], 2, 1e-6, 0);
    assert_close((double)panel[0]->rgb[1], 1, 1e-6, 0);
    pps_picture_free(panel[0]);
    pps_picture_free(panel[2]);
    assert_int_equal(pps_picture_exposure(0, NULL, &exposure), PPS_OK);
    assert_close(exposure, 1, 0, 0);
}

static void sheets_that_make_no_sense_are_refused(void **state) {
    (void)state;
    pps_picture *panel[] = {plain(20, 10, 0), plain(20, 11, 0)}, *none[] = {NULL}, *out;
    const char *caption[] = {"", ""};
    pps_sheet bad[] = {{.columns = 2, .n = 2, .panel = panel, .caption = caption},
                       {.columns = 0, .n = 1, .panel = panel, .caption = caption},
                       {.columns = 1, .n = 1, .panel = none, .caption = caption},
                       {.columns = 1, .n = 0, .panel = panel, .caption = caption}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(pps_sheet_draw(&bad[i], &out), PPS_ERR_ARGUMENT);
        assert_null(out);
    }
    pps_picture_free(panel[0]);
    pps_picture_free(panel[1]);
}

/* ---- pictures of a crown ---- */

enum { SIZE = 96 };

static const unsigned all = PPS_SUN | PPS_SUN_INDIRECT;

/* A ball of leaves, the sun low in the east (+x) of irradiance 1. */
static pps_scene *make_ball(void) {
    pps_crown crown = {PPS_CROWN_UNIFORM, 4, 2000, 11};
    pps_mesh *mesh;
    pps_scene *scene;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    assert_int_equal(pps_scene_single(mesh, 0.6, &scene), PPS_OK);
    scene->sun.to[0] = cos(0.3);
    scene->sun.to[2] = sin(0.3);
    return scene;
}

/* Seen from the south: east is at the right. */
static pps_picture *draw(const pps_scene *scene, const pps_irradiance *light,
                         double azimuth) {
    pps_camera camera;
    pps_picture *picture;
    pps_camera_fit(scene, azimuth, 0, 1, &camera);
    assert_int_equal(pps_picture_create(SIZE, SIZE, &picture), PPS_OK);
    assert_int_equal(pps_render(scene, light, &camera, 2, picture), PPS_OK);
    return picture;
}

/* The mean over columns from x0 on, background and all. */
static double brightness(const pps_picture *picture, int x0, int width) {
    double sum = 0;
    for (int y = 0; y < picture->height; y++) {
        for (int x = x0; x < x0 + width; x++) {
            sum += (double)picture->rgb[3 * (y * picture->width + x)];
        }
    }
    return sum / (width * picture->height);
}

static pps_irradiance *model_light(const pps_scene *scene, const char *name,
                                   const pps_cells *cells) {
    pps_light_options options = {.sources = all};
    pps_irradiance *light;
    assert_int_equal(
        pps_light_model_run(pps_light_model_find(name), scene, cells, &options, &light),
        PPS_OK);
    return light;
}

static pps_irradiance *true_light(const pps_scene *scene) {
    pps_trace_options options = {.rays = 400000, .sources = all};
    pps_irradiance *light;
    assert_int_equal(pps_trace_light(scene, &options, &light, NULL), PPS_OK);
    return light;
}

/* By every model and by Monte Carlo: the half towards the sun is the brighter one, at the
 * right when seen from the south and at the left from the north; and the picture by
 * `lattice` is as bright as that by Monte Carlo, where direct light alone is darker. */
static void the_side_towards_the_sun_is_the_bright_one(void **state) {
    (void)state;
    static const char *const names[] = {
        "lattice", "self-consistent", "spp-printed", "ss", "leaf", "leaf-lattice"};
    enum { N = sizeof names / sizeof *names };
    pps_scene *scene = make_ball();
    pps_cells *cells;
    double mean[N + 1];
    assert_int_equal(pps_cells_create(scene, NULL, &cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(cells, scene, NULL), PPS_OK);
    for (int i = 0; i <= N; i++) {
        pps_irradiance *light =
            i < N ? model_light(scene, names[i], cells) : true_light(scene);
        pps_picture *south = draw(scene, light, -90), *north = draw(scene, light, 90),
                    *lit = draw(scene, light, 0), *back = draw(scene, light, 180);
        assert_true(brightness(south, SIZE / 2, SIZE / 2) >
                    1.3 * brightness(south, 0, SIZE / 2));
        assert_true(brightness(north, 0, SIZE / 2) >
                    1.3 * brightness(north, SIZE / 2, SIZE / 2));
        assert_true(brightness(lit, 0, SIZE) > 1.3 * brightness(back, 0, SIZE));
        mean[i] = brightness(south, 0, SIZE);
        pps_picture_free(south);
        pps_picture_free(north);
        pps_picture_free(lit);
        pps_picture_free(back);
        pps_irradiance_free(light);
    }
    print_message("brightness over Monte Carlo's: lattice %.3f, ss %.3f\n",
                  mean[0] / mean[N], mean[3] / mean[N]);
    assert_close(mean[0], mean[N], 0.05, 0);
    assert_true(mean[3] < 0.8 * mean[N]);
    pps_cells_free(cells);
    pps_scene_free(scene);
}

/* What is split adds up: red and green together are the picture that is not split. */
static void reflected_and_transmitted_light_is_all_light(void **state) {
    (void)state;
    pps_scene *scene = make_ball();
    for (int face = 0; face < 2; face++) {
        scene->prototype[0].optics.reflectance[face][0] = face ? 0.1 : 0.4;
        scene->prototype[0].optics.transmittance[face][0] = face ? 0.2 : 0.3;
    }
    pps_irradiance *light = model_light(scene, "leaf", NULL);
    pps_picture *whole = draw(scene, light, -90), *split;
    pps_camera camera;
    pps_camera_fit(scene, -90, 0, 1, &camera);
    assert_int_equal(pps_picture_create(SIZE, SIZE, &split), PPS_OK);
    assert_int_equal(pps_render_split(scene, light, &camera, 2, split), PPS_OK);
    int red = 0, green = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *p = &split->rgb[3 * i];
        assert_close((double)(p[0] + p[1]), (double)whole->rgb[3 * i], 1e-5, 1e-7);
        assert_true(p[2] == 0);
        red += p[0] > 2 * p[1];
        green += p[1] > 2 * p[0];
    }
    assert_true(red > 100 && green > 100);
    pps_picture_free(split);
    pps_picture_free(whole);
    pps_irradiance_free(light);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panels_are_in_rows_under_their_captions),
        cmocka_unit_test(a_key_stands_at_the_right),
        cmocka_unit_test(pictures_are_exposed_alike),
        cmocka_unit_test(sheets_that_make_no_sense_are_refused),
        cmocka_unit_test(the_side_towards_the_sun_is_the_bright_one),
        cmocka_unit_test(reflected_and_transmitted_light_is_all_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
