/* Pictures: the sRGB curve, exposure, and PNGs that libpng reads back.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <png.h>

#include <ppscat/tree/picture.h>

#include "support/support.h"
#include "tree/font.h"
#include "tree/srgb.h"

static char path[64];

static int name_file(void **state) {
    (void)state;
    snprintf(path, sizeof path, "/tmp/ppscat_picture_%ld.png", (long)getpid());
    return 0;
}

static int remove_file(void **state) {
    (void)state;
    remove(path);
    return 0;
}

static uint8_t *read_png(int *width, int *height) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, path));
    assert_int_equal(image.format, PNG_FORMAT_RGB);
    uint8_t *byte = malloc(PNG_IMAGE_SIZE(image));
    assert_true(png_image_finish_read(&image, NULL, byte, 0, NULL));
    *width = (int)image.width;
    *height = (int)image.height;
    return byte;
}

static void bytes_survive_the_srgb_curve_both_ways(void **state) {
    (void)state;
    for (int i = 0; i < 256; i++) {
        assert_int_equal(srgb_byte(srgb_decode(i / 255.0)), i);
    }
    /* Values of IEC 61966-2-1: middle grey, half the light, the join of line and power. */
    assert_close(srgb_encode(0.18), 0.461356, 1e-6, 0);
    assert_close(srgb_encode(0.5), 0.735357, 1e-6, 0);
    assert_close(srgb_encode(1), 1, 1e-15, 0);
    assert_close(srgb_encode(0.0031308), srgb_encode(0.0031308 + 1e-12), 1e-6, 0);
    assert_int_equal(srgb_byte(2), 255);
    assert_int_equal(srgb_byte(-1), 0);
    assert_int_equal(srgb_byte((double)NAN), 0);
}

static void a_picture_reads_back_as_it_was(void **state) {
    (void)state;
    pps_picture *picture;
    assert_int_equal(pps_picture_create(7, 3, &picture), PPS_OK);
    for (int i = 0; i < 7 * 3 * 3; i++) {
        picture->rgb[i] = (float)i / 62;
    }
    assert_int_equal(pps_picture_write(picture, 1, path, NULL), PPS_OK);
    int width, height;
    uint8_t *byte = read_png(&width, &height);
    assert_int_equal(width, 7);
    assert_int_equal(height, 3);
    for (int i = 0; i < 7 * 3 * 3; i++) {
        assert_close(srgb_decode(byte[i] / 255.0), i / 62.0, 0.01, 0.0002);
    }
    assert_int_equal(byte[31], 188); /* half the light */
    free(byte);
    pps_picture_free(picture);
}

static void exposure_multiplies_light(void **state) {
    (void)state;
    pps_picture *picture;
    int width, height;
    assert_int_equal(pps_picture_create(10, 20, &picture), PPS_OK);
    for (int i = 0; i < 200 * 3; i++) {
        picture->rgb[i] = 0.1F;
    }
    /* Two of 200 pixels, the brightest percent, become white. */
    picture->rgb[3 * 17] = 0.4F;
    picture->rgb[3 * 99 + 1] = 8;
    assert_int_equal(pps_picture_write(picture, 0, path, NULL), PPS_OK);
    uint8_t *byte = read_png(&width, &height);
    assert_int_equal(byte[3 * 17], 255);
    assert_int_equal(byte[3 * 99 + 1], 255);
    assert_int_equal(byte[0], srgb_byte(0.1 / 0.4));
    free(byte);
    assert_int_equal(pps_picture_write(picture, 5, path, NULL), PPS_OK);
    byte = read_png(&width, &height);
    assert_int_equal(byte[0], 188);
    free(byte);
    assert_int_equal(pps_picture_write(picture, -1, path, NULL), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_picture_write(picture, (double)NAN, path, NULL),
                     PPS_ERR_ARGUMENT);
    pps_picture_free(picture);
}

static void a_black_picture_can_be_written(void **state) {
    (void)state;
    pps_picture *picture;
    int width, height;
    assert_int_equal(pps_picture_create(2, 2, &picture), PPS_OK);
    assert_int_equal(pps_picture_write(picture, 0, path, NULL), PPS_OK);
    uint8_t *byte = read_png(&width, &height);
    for (int i = 0; i < 12; i++) {
        assert_int_equal(byte[i], 0);
    }
    free(byte);
    pps_picture_free(picture);
}

static void what_cannot_be_written_is_said(void **state) {
    (void)state;
    pps_picture *picture;
    pps_problem problem = {""};
    assert_int_equal(pps_picture_create(2, 2, &picture), PPS_OK);
    assert_int_equal(pps_picture_write(picture, 1, "/nowhere/at/all.png", &problem),
                     PPS_ERR_FILE);
    assert_non_null(strstr(problem.text, "cannot write /nowhere/at/all.png"));
    assert_int_equal(pps_picture_write(picture, 1, "/tmp", &problem), PPS_ERR_FILE);
    assert_int_equal(access("/tmp.part", F_OK), -1);
    pps_picture_free(picture);
    assert_int_equal(pps_picture_create(0, 2, &picture), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_picture_create(2, 1 << 20, &picture), PPS_ERR_ARGUMENT);
    assert_null(picture);
    pps_picture_free(NULL);
}

/* A letter I of 3 x 7 dots, twice as large, clipped where the picture ends. */
static void letters_are_dots(void **state) {
    (void)state;
    pps_picture *picture;
    assert_int_equal(pps_picture_create(24, 20, &picture), PPS_OK);
    for (int i = 0; i < 24 * 20 * 3; i++) {
        picture->rgb[i] = 1;
    }
    assert_int_equal(pps_font_width("II", 2), 24);
    pps_font_write(picture, 0, 1, 2, "I");
    int dark = 0;
    for (int i = 0; i < 24 * 20; i++) {
        dark += picture->rgb[3 * i] == 0;
    }
    assert_int_equal(dark, 4 * (3 + 3 + 5));
    assert_true(picture->rgb[3 * (24 * 1 + 2)] == 0); /* the upper bar's left end */
    assert_true(picture->rgb[3 * (24 * 1 + 1)] == 1);
    pps_font_write(picture, 20, 15, 2, "#\x80");
    pps_font_write(picture, -5, -5, 2, "#");
    pps_picture_free(picture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_survive_the_srgb_curve_both_ways),
        cmocka_unit_test(a_picture_reads_back_as_it_was),
        cmocka_unit_test(exposure_multiplies_light),
        cmocka_unit_test(a_black_picture_can_be_written),
        cmocka_unit_test(what_cannot_be_written_is_said),
        cmocka_unit_test(letters_are_dots),
    };
    return cmocka_run_group_tests(tests, name_file, remove_file);
}
