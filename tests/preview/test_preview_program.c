/* ppscat-preview from outside: snapshots without a display, times, and what it refuses.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "cli/program.h"

/* The oak of data/scenes, small. */
#define OAK "'" PPS_DATA_DIR "/scenes/single-tree.json'"
#define SMALL "--size 96x80 --samples 1 "

typedef struct {
    unsigned width, height;
    unsigned char *rgb;
} image;

static image read_png(const char *path) {
    png_image png = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&png, path));
    png.format = PNG_FORMAT_RGB;
    unsigned char *rgb = malloc(PNG_IMAGE_SIZE(png));
    assert_true(png_image_finish_read(&png, NULL, rgb, 0, NULL));
    return (image){png.width, png.height, rgb};
}

static double mean(const image *at, unsigned channel) {
    double sum = 0;
    for (size_t i = channel; i < 3 * (size_t)at->width * at->height; i += 3) {
        sum += at->rgb[i];
    }
    return sum / (at->width * at->height);
}

static image snapshot(const char *arguments) {
    char line[512];
    snprintf(line, sizeof line, "-u DISPLAY \"$P\" --snapshot a.png " SMALL "%s " OAK,
             arguments);
    char command[600];
    snprintf(command, sizeof command, "env %s", line);
    result r = program_shell(command);
    if (r.status) {
        fail_msg("%s: %s", arguments, r.err);
    }
    assert_string_equal(r.out, "");
    assert_string_equal(r.err, "");
    result_free(&r);
    image at = read_png("a.png");
    assert_int_equal(at.width, 96);
    assert_int_equal(at.height, 80);
    return at;
}

static void a_snapshot_needs_no_display(void **state) {
    (void)state;
    image at = snapshot("");
    assert_true(mean(&at, 1) > 30 && mean(&at, 1) < 220); /* neither black nor white */
    free(at.rgb);
}

static void options_change_the_picture(void **state) {
    (void)state;
    static const char *const other[] = {"--model ss",
                                        "--model spp --compensate derived",
                                        "--model sppg",
                                        "--model leaf",
                                        "--model mc --rays 50000",
                                        "--sun 90,30",
                                        "--view 30,40",
                                        "--exposure 0.5",
                                        "--component sun",
                                        "--show scattered"};
    enum { BYTES = 3 * 96 * 80 };
    image plain = snapshot("");
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        image at = snapshot(other[i]);
        assert_memory_not_equal(plain.rgb, at.rgb, BYTES);
        free(at.rgb);
    }
    image again = snapshot("-j 1");
    assert_memory_equal(plain.rgb, again.rgb, BYTES);
    image dark = snapshot("--exposure 0.5");
    assert_true(mean(&dark, 1) < 0.85 * mean(&plain, 1));
    free(plain.rgb);
    free(again.rgb);
    free(dark.rgb);
}

static void times_are_csv(void **state) {
    (void)state;
    result r = program_run("--bench --model ss " SMALL OAK);
    assert_int_equal(r.status, 0);
    assert_int_equal(strncmp(r.out, "step,seconds\n1 cells,", 21), 0);
    assert_int_equal(count_lines(r.out), 8);
    assert_non_null(strstr(r.err, "1 instances, 6806 triangles"));
    result_free(&r);
}

static void bad_usage_is_refused_in_one_line(void **state) {
    (void)state;
    static const struct {
        const char *arguments, *says;
        int status;
    } row[] = {
        {"--model fog " OAK, "--model: 'fog' is not possible; allowed: lattice, ", 2},
        {"--size 5x5 " OAK, "--size: '5x5' is not possible; allowed: WIDTHxHEIGHT", 2},
        {"--sun 10 " OAK, "--sun: '10' is not possible; allowed: an azimuth", 2},
        {"--sun 10,-5 " OAK, "--sun: '10,-5' is not possible", 2},
        {"--view nan,0 " OAK, "--view: 'nan,0' is not possible", 2},
        {"--exposure 0 " OAK, "--exposure: '0' is not possible", 2},
        {"--samples 9 " OAK, "--samples: '9' is not possible; allowed: whole numbers",
         2},
        {"--component sun,fog " OAK, "--component: 'sun,fog' is not possible", 2},
        {"--compensate derived " OAK, "--compensate: the model lattice takes no G", 2},
        {"--snapshot a.jpg " OAK,
         "--snapshot: 'a.jpg' is not possible; allowed: FILE.png", 2},
        {"--snapshot a.png --bench " OAK, "--bench and --snapshot", 2},
        {"--fog " OAK, "--fog: no such option", 2},
        {"--size", "--size: it needs a value", 2},
        {"--snapshot a.png a.json b.json", "'b.json': one scene at a time", 2},
        {"--snapshot a.png missing.json", "missing.json", 2},
        {"--snapshot a.png broken.json", "broken.json", 2},
        {"--snapshot no/such/a.png " SMALL OAK, "no/such/a.png", 1},
    };
    FILE *broken = fopen("broken.json", "w");
    assert_non_null(broken);
    fputs("{\"prototypes\": 3}\n", broken);
    assert_int_equal(fclose(broken), 0);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        result r = program_run(row[i].arguments);
        if (r.status != row[i].status || !strstr(r.err, row[i].says) ||
            count_lines(r.err) != 1) {
            fail_msg("%s: exit %d, %s", row[i].arguments, r.status, r.err);
        }
        assert_int_equal(strncmp(r.err, "ppscat-preview: ", 16), 0);
        result_free(&r);
    }
}

static void without_display_or_driver_it_says_so(void **state) {
    (void)state;
    result r = program_shell("env -u DISPLAY -u WAYLAND_DISPLAY \"$P\" " OAK);
    assert_int_equal(r.status, 1);
    assert_non_null(strstr(r.err, "no window: "));
    assert_non_null(strstr(r.err, "--snapshot"));
    assert_int_equal(count_lines(r.err), 1);
    result_free(&r);
    r = program_shell("env MESA_GL_VERSION_OVERRIDE=2.1 \"$P\" --snapshot a.png " OAK);
    assert_int_equal(r.status, 1);
    assert_non_null(strstr(r.err, "OpenGL"));
    result_free(&r);
    r = program_shell("env __EGL_VENDOR_LIBRARY_FILENAMES=/dev/null \"$P\" "
                      "--snapshot a.png " OAK);
    assert_int_equal(r.status, 1);
    assert_non_null(strstr(r.err, "no EGL display"));
    result_free(&r);
}

static void help_lists_every_option(void **state) {
    (void)state;
    static const char *const option[] = {
        "--snapshot", "--bench", "--model", "--compensate", "--component",
        "--sun",      "--view",  "--size",  "--show",       "--exposure",
        "--samples",  "--rays",  "--jobs",  "--help",       "--version"};
    result r = program_run("--help");
    assert_int_equal(r.status, 0);
    for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
        assert_non_null(strstr(r.out, option[i]));
    }
    result_free(&r);
    r = program_run("--version");
    assert_int_equal(r.status, 0);
    assert_int_equal(strncmp(r.out, "ppscat-preview ", 15), 0);
    result_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_snapshot_needs_no_display),
        cmocka_unit_test(options_change_the_picture),
        cmocka_unit_test(times_are_csv),
        cmocka_unit_test(bad_usage_is_refused_in_one_line),
        cmocka_unit_test(without_display_or_driver_it_says_so),
        cmocka_unit_test(help_lists_every_option),
    };
    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
