/* ppscat-preview from outside: snapshots without a display, times, and what it refuses.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

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
                                        "--show scattered",
                                        "--split ss",
                                        "--albedo 0.9",
                                        "--albedo 0.9,0.1,0.1",
                                        "--zoom 3",
                                        "--relief 1",
                                        "--detail 50",
                                        "--model spp --scattered cell"};
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

/* The left half of a split picture is the model's, the right half the other's. */
static void a_split_picture_has_a_half_of_each(void **state) {
    (void)state;
    image left = snapshot("--model ss"), right = snapshot("--model mc --rays 50000"),
          both = snapshot("--model ss --split mc --rays 50000");
    for (size_t i = 0; i < (size_t)both.width * both.height; i++) {
        const image *from = i % both.width < both.width / 2 ? &left : &right;
        assert_memory_equal(both.rgb + 3 * i, from->rgb + 3 * i, 3);
    }
    free(left.rgb);
    free(right.rgb);
    free(both.rgb);
}

static void times_are_csv(void **state) {
    (void)state;
    static const char header[] = "step,work,ms,cpu_ms,per_second,instances,triangles,"
                                 "cells,width,height,samples,renderer\n1,cells,";
    result r = program_run("--bench --model ss " SMALL OAK);
    assert_int_equal(r.status, 0);
    assert_int_equal(strncmp(r.out, header, sizeof header - 1), 0);
    assert_int_equal(count_lines(r.out), 14);
    for (int step = 1; step <= 6; step++) {
        char row[16];
        snprintf(row, sizeof row, "\n%d,", step);
        assert_non_null(strstr(r.out, row));
    }
    assert_non_null(strstr(r.out, ",1,6806,"));
    assert_string_equal(r.err, "");
    result_free(&r);
}

/* Milliseconds of processors in all programs that were run. */
static double processor_ms(void) {
    struct rusage used;
    getrusage(RUSAGE_CHILDREN, &used);
    return 1e3 * (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-3 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/* Not once for every place of the sun: the program takes little more than one tracing. */
static void monte_carlo_is_timed_once(void **state) {
    (void)state;
    double start = processor_ms(), ms, cpu_ms;
    result r = program_run("--bench --model mc --rays 1000000 " SMALL OAK);
    double all = processor_ms() - start;
    assert_int_equal(r.status, 0);
    assert_int_equal(count_lines(r.out), 14);
    const char *sun = strstr(r.out, "\n5,sun,");
    assert_non_null(sun);
    assert_int_equal(sscanf(sun, "\n5,sun,%lf,%lf", &ms, &cpu_ms), 2);
    print_message("%.0f ms of Monte Carlo, %.0f in all\n", cpu_ms, all);
    assert_true(ms > 0 && cpu_ms > 100 && all < 3 * cpu_ms);
    result_free(&r);
}

/* A box of four cards, each as wide as the box. */
static void leaves_larger_than_cells_are_told(void **state) {
    (void)state;
    FILE *file = fopen("cards.obj", "w");
    assert_non_null(file);
    for (int i = 0; i < 4; i++) {
        fprintf(file, "v 0 %d 0\nv 1 %d 0\nv 1 %d 1\nv 0 %d 1\n", i, i, i, i);
    }
    fputs("usemtl leaf\nf 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\nf 13 14 15 16\n", file);
    assert_int_equal(fclose(file), 0);
    result r = program_run("--snapshot a.png --model ss " SMALL "cards.obj");
    assert_int_equal(r.status, 0);
    assert_int_equal(count_lines(r.err), 1);
    assert_non_null(strstr(r.err, "leaves of 1 m are larger than the cells of 0.19 m"));
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
        {"--snapshot no/such/a.png " SMALL OAK,
         "--snapshot: cannot write 'no/such/a.png': No such file", 2},
        {"--split fog " OAK, "--split: 'fog' is not possible; allowed: lattice, ", 2},
        {"--size ' 64x64' " OAK, "--size: ' 64x64' is not possible", 2},
        {"--size 64x64x " OAK, "--size: '64x64x' is not possible", 2},
        {"--snapshot folder.png " OAK,
         "--snapshot: cannot write 'folder.png': Is a directory", 2},
        {"--snapshot a.png " SMALL "--view 0,-20 " OAK,
         "--view: from an elevation of -20 the ground hides all", 2},
        {"--snapshot a.png --model sppg leaf-trees-4", "the model sppg takes scenes",
         2},
        {"--snapshot a.png --split sppg leaf-trees-4", "the model sppg takes scenes",
         2},
        {"--component sky-indirect --model leaf " OAK,
         "--component: the model leaf knows none of this light", 2},
        {"--apart --model ss " OAK, "--apart: it is for the model leaf; this is ss", 2},
        {"--split ss --bench " OAK, "--bench and --split", 2},
        {"--albedo 1.5 " OAK, "--albedo: '1.5' is not possible; allowed: numbers", 2},
        {"--albedo 0.5,, " OAK, "--albedo: '0.5,,' is not possible", 2},
        {"--latitude 91 " OAK, "--latitude: '91' is not possible; allowed: a number",
         2},
        {"--zoom 0.5 " OAK, "--zoom: '0.5' is not possible; allowed: a number from", 2},
        {"--detail x " OAK, "--detail: 'x' is not possible", 2},
        {"--relief 2 " OAK, "--relief: '2' is not possible", 2},
        {"--scattered leaf " OAK, "--scattered: 'leaf' is not possible; allowed: pixel",
         2},
    };
    assert_int_equal(mkdir("folder.png", 0777), 0);
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
        "--snapshot", "--bench",     "--model",   "--compensate", "--component",
        "--split",    "--scattered", "--albedo",  "--latitude",   "--zoom",
        "--detail",   "--relief",    "--sun",     "--view",       "--size",
        "--show",     "--exposure",  "--samples", "--rays",       "--jobs",
        "--apart",    "--help",      "--version"};
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
    r = program_shell("\"$P\" --help > /dev/full");
    assert_int_equal(r.status, 1);
    assert_string_equal(r.err, "ppscat-preview: cannot write standard output\n");
    result_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_snapshot_needs_no_display),
        cmocka_unit_test(options_change_the_picture),
        cmocka_unit_test(a_split_picture_has_a_half_of_each),
        cmocka_unit_test(times_are_csv),
        cmocka_unit_test(monte_carlo_is_timed_once),
        cmocka_unit_test(leaves_larger_than_cells_are_told),
        cmocka_unit_test(bad_usage_is_refused_in_one_line),
        cmocka_unit_test(without_display_or_driver_it_says_so),
        cmocka_unit_test(help_lists_every_option),
    };
    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
