/* The subcommands of `tree` as a user meets them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A bush of 300 leaves in a file, and a scene about it. */
static void make_scene(void) {
    result r = program_run("tree grow --crown uniform --leaves 300 --leaf-area-index 2 "
                           "--seed 4 -o bush.obj");
    FILE *scene = fopen("bush.json", "w");

    assert_int_equal(r.status, 0);
    assert_non_null(scene);
    fputs("{\"prototypes\": {\"bush\": {\"mesh\": \"bush.obj\",\n"
          "  \"optics\": {\"reflectance\": 0.4, \"transmittance\": 0.3}}},\n"
          " \"bands\": [\"red\", \"blue\"],\n"
          " \"sun\": {\"direction\": [0, 0, 1], \"irradiance\": [2, 1]},\n"
          " \"sky\": {\"zenith\": 0.1, \"horizon\": 0.1}}\n",
          scene);
    fclose(scene);
    result_free(&r);
}

static void grow_writes_a_mesh_and_its_measures(void **state) {
    result r = program_run("tree grow --crown tall --leaves 50 --leaf-area-index 3 "
                           "--seed 7 -o tall.ply");
    const char *row = next_line(r.out);

    (void)state;
    assert_int_equal(r.status, 0);
    assert_true(strncmp(r.out, "vertices,triangles,leaves,leaf_area,", 36) == 0);
    assert_true(strncmp(row, "200,100,50,", 11) == 0);
    assert_true(file_exists("tall.ply"));
    assert_false(file_exists("tall.ply-metadata.json"));
    result_free(&r);
}

static void a_seed_grows_the_same_tree(void **state) {
    result a =
        program_shell("$P tree grow --seed 3 -o a.obj && $P tree grow --seed 3 "
                      "-o b.obj && cmp -i 60 a.obj b.obj && ! cmp -s a.obj c.obj");

    (void)state;
    assert_int_equal(a.status, 0);
    result_free(&a);
}

/* Every leaf, band, model and component has its row, in the order of the columns. */
static void irradiance_has_a_row_for_every_leaf_band_model_and_component(void **state) {
    (void)state;
    make_scene();
    result r = program_run("tree irradiance bush.json --model lattice,ss,leaf,mc "
                           "--component all,sun --rays 1000 -o bush.csv");
    char *csv = read_file("bush.csv");
    const char *line = next_line(csv);
    static const char *const models[] = {"lattice", "ss", "leaf", "mc"};

    assert_int_equal(r.status, 0);
    assert_true(file_exists("bush.csv-metadata.json"));
    assert_int_equal(count_lines(csv), 1 + 300 * 2 * 4 * 2);
    for (int i = 0; i < 300 * 2 * 4 * 2; i++, line = next_line(line)) {
        char *leaf = csv_field(line, 1), *band = csv_field(line, 10);
        char *model = csv_field(line, 15), *component = csv_field(line, 16);
        assert_int_equal(atoi(leaf), i / 16);
        assert_string_equal(band, i / 8 % 2 ? "blue" : "red");
        assert_string_equal(model, models[i / 2 % 4]);
        assert_string_equal(component, i % 2 ? "sun" : "all");
        free(leaf);
        free(band);
        free(model);
        free(component);
    }
    free(csv);
    result_free(&r);
}

/* The sun falls on the face turned to it, |n.s| of it at most; of all that would without
 * shade, the cell's visibility is the share that does (points on 300 leaves: one standard
 * deviation is 0.01). */
static void the_sun_alone_is_geometry(void **state) {
    (void)state;
    make_scene();
    result r = program_run("tree irradiance bush.json --model lattice --component sun "
                           "--cells 1");
    const char *line = next_line(r.out);
    double falls = 0, could = 0, visibility = 0;

    assert_int_equal(r.status, 0);
    for (; line; line = next_line(line)) {
        char *band = csv_field(line, 10);
        double x[5];
        static const size_t fields[] = {8, 9, 13, 17, 18};
        for (int k = 0; k < 5; k++) {
            char *text = csv_field(line, fields[k]);
            x[k] = strtod(text, NULL);
            free(text);
        }
        double unshaded = (strcmp(band, "red") == 0 ? 2 : 1) * fabs(x[0]);
        double front = x[3], back = x[4];
        assert_true(front >= 0 && back >= 0);
        assert_true(front + back <= unshaded * (1 + 1e-5));
        assert_true(x[0] > 0 ? back == 0 : front == 0);
        falls += x[1] * (front + back);
        could += x[1] * unshaded;
        visibility = x[2];
        free(band);
    }
    assert_true(visibility > 0.05 && visibility < 0.95);
    assert_true(fabs(falls / could - visibility) < 0.03);
    result_free(&r);
}

/* What a model does not know is empty, said once, and exit 3. */
static void unknown_light_is_refused_not_invented(void **state) {
    (void)state;
    make_scene();
    result r = program_run("tree irradiance bush.json --model leaf "
                           "--component sky-indirect");
    char *front = csv_field(next_line(r.out), 17);

    assert_int_equal(r.status, 3);
    assert_string_equal(front, "");
    assert_int_equal(count_lines(r.err), 1);
    assert_non_null(strstr(r.err, "leaf refuses component sky-indirect"));
    free(front);
    result_free(&r);
}

/* The G-factor of an item is that of --compensate; without one a model has none. */
static void a_model_may_name_its_own_g_factor(void **state) {
    (void)state;
    make_scene();
    result both = program_run("tree irradiance bush.json --model spp+derived,spp");
    result one =
        program_run("tree irradiance bush.json --model spp --compensate derived");
    const char *line = next_line(both.out), *alone = next_line(one.out);

    assert_int_equal(both.status, 0);
    for (; alone; alone = next_line(alone), line = next_line(line)) {
        char *model = csv_field(line, 15), *front = csv_field(line, 17),
             *want = csv_field(alone, 17);
        assert_string_equal(model, "spp+derived");
        assert_string_equal(front, want);
        free(model);
        free(front);
        line = next_line(line);
        model = csv_field(line, 15);
        front = csv_field(line, 14);
        assert_string_equal(model, "spp");
        assert_string_equal(front, "1");
        free(model);
        free(front);
        free(want);
    }
    result_free(&both);
    result_free(&one);
}

static void render_makes_a_png(void **state) {
    (void)state;
    make_scene();
    result r =
        program_shell("$P tree render bush.json -o bush.png --size 40x30 && "
                      "$P tree render bush.json -o g.png --size 64x48 --model spp "
                      "--compensate derived --false-color g-factor && "
                      "head -c 4 bush.png | tail -c 3 && tail -c +17 bush.png | "
                      "head -c 8 | od -An -tu1");
    assert_int_equal(r.status, 0);
    assert_true(strncmp(r.out, "PNG", 3) == 0);
    assert_non_null(strstr(r.out, "40   0   0   0  30"));
    assert_true(file_exists("g.png"));
    assert_false(file_exists("bush.png.part"));
    result_free(&r);
}

/* The size in a PNG's header. */
static void png_size(const char *path, int *width, int *height) {
    FILE *file = fopen(path, "rb");
    unsigned char head[24];

    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    fclose(file);
    *width = head[18] << 8 | head[19];
    *height = head[22] << 8 | head[23];
}

/* Models across; with several components models down and components across. A panel that
 * a model has no light for stays blank, said once, and exit 3. */
static void a_picture_of_several_has_a_panel_each(void **state) {
    (void)state;
    enum { W = 60, H = 40, LINE = 14, GAP = 4 };
    int width, height;
    make_scene();
    result row = program_run("tree render bush.json -o row.png --size 60x40 "
                             "--model spp+derived,spp,ss");
    result grid =
        program_run("tree render bush.json -o grid.png --size 60x40 --model "
                    "leaf,lattice --component sky,sun,sky-indirect,all+split");
    result key = program_run("tree render bush.json -o key.png --size 60x40 --model "
                             "spp,ss --false-color irradiance");
    assert_int_equal(row.status, 0);
    png_size("row.png", &width, &height);
    assert_int_equal(width, 3 * W + 2 * GAP);
    assert_int_equal(height, LINE + H + LINE);
    assert_int_equal(grid.status, 3);
    assert_int_equal(count_lines(grid.err), 1);
    assert_non_null(strstr(grid.err, "leaf refuses component sky-indirect"));
    png_size("grid.png", &width, &height);
    assert_int_equal(width, 4 * W + 3 * GAP);
    assert_int_equal(height, 2 * (LINE + H) + LINE);
    assert_int_equal(key.status, 0);
    result_free(&row);
    result_free(&grid);
    result_free(&key);
}

static void threads_do_not_change_an_answer(void **state) {
    (void)state;
    make_scene();
    result r = program_shell(
        "for j in 1 3; do $P tree irradiance bush.json --model mc,gather,lattice "
        "--rays 20000 --samples 4 -j $j -o j$j.csv || exit 1; done; cmp j1.csv j3.csv");
    assert_int_equal(r.status, 0);
    result_free(&r);
}

/* One line that names the option, the value and what is allowed; exit 2. */
static void bad_input_is_one_line_and_exit_2(void **state) {
    static const struct {
        const char *arguments, *says;
    } cases[] = {
        {"tree", "'tree' is no subcommand; allowed: tree grow, tree irradiance"},
        {"tree foo", "'tree foo' is no subcommand; allowed: tree grow"},
        {"tree grow extra", "unexpected argument 'extra'"},
        {"tree grow --species oak", "--species: no species 'oak'"},
        {"tree grow --crown round", "--crown: unknown value 'round'; allowed: uniform"},
        {"tree grow --crown tall --species maple", "contradict each other"},
        {"tree grow --leaves 10", "--leaves '10' is for --crown"},
        {"tree grow --crown tall --leaves 0", "--leaves: '0' is not possible"},
        {"tree grow --crown tall --leaf-area-index 0", "--leaf-area-index: '0' is out"},
        {"tree grow --seed -1", "--seed: '-1' is not possible"},
        {"tree grow -o a.stl", "a.stl: a mesh is written as .obj or .ply"},
        {"tree grow -o nowhere/a.obj", "--output: cannot write 'nowhere/a.obj'"},
        {"tree irradiance", "tree irradiance: which scene?"},
        {"tree irradiance none.json", "none.json: No such file"},
        {"tree irradiance bush.json --model mcx",
         "unknown model 'mcx'; did you mean 'mc'"},
        {"tree irradiance bush.json --model ss,ss", "'ss' is there twice"},
        {"tree irradiance bush.json --model ''", "--model: unknown model ''"},
        {"tree irradiance bush.json --component moon",
         "unknown component 'moon'; allowed: all"},
        {"tree irradiance bush.json --compensate derived",
         "--model 'lattice' names none"},
        {"tree irradiance bush.json --sun 10", "two numbers, AZIMUTH,ELEVATION"},
        {"tree irradiance bush.json --sun 10,95", "an elevation above 0 up to 90"},
        {"tree irradiance bush.json --model lattice+derived",
         "unknown model 'lattice+derived'"},
        {"tree irradiance bush.json --bounces x", "from 1 to 1000000, or all"},
        {"tree irradiance bush.json --cells 0", "--cells: '0' is not possible"},
        {"tree irradiance bush.json --leaf x", "--leaf: 'x' is for meshes"},
        {"tree irradiance bush.obj --leaf x", "no material or object name matches 'x'"},
        {"tree irradiance bush.json -o nowhere/a.csv", "nowhere/a.csv"},
        {"tree render bush.json", "--output: '' is not possible; allowed: FILE.png"},
        {"tree render bush.json -o a.jpg", "allowed: FILE.png"},
        {"tree render bush.json -o nowhere/a.png", "cannot write 'nowhere/a.png'"},
        {"tree render bush.json -o a.png --size 3x3", "--size: '3x3' is not possible"},
        {"tree render bush.json -o a.png --view up,down", "--view: 'up,down'"},
        {"tree render bush.json -o a.png --model leaf --component sky-indirect",
         "do not fit"},
        {"tree render bush.json -o a.png --model ss,spp --false-color depth "
         "--component sun+split",
         "'sun+split' has colours of its own"},
        {"tree irradiance bush.json --component sun+split",
         "unknown component 'sun+split'"},
        {"tree render bush.json -o a.png --model ss,spp --component "
         "all,sun,indirect,sky --size 16384x16",
         "--size: '16384x16' is too large for 4 x 2 panels"},
        {"tree render bush.json -o a.png --range 1,2", "--range is for --false-color"},
        {"tree render bush.json -o a.png --false-color depth --range 2,1", "is empty"},
        {"tree render bush.json -o a.png --false-color depth --model leaf",
         "model 'leaf' has no cells"},
        {"tree render bush.json -o a.png --exposure 0",
         "--exposure: '0' is out of range"},
    };

    (void)state;
    make_scene();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        result r = program_run(cases[i].arguments);
        if (r.status != 2 || count_lines(r.err) != 1 || !strstr(r.err, cases[i].says))
            fail_msg("ppscat %s: status %d, says: %s", cases[i].arguments, r.status,
                     r.err);
        assert_false(file_exists("a.png"));
        result_free(&r);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grow_writes_a_mesh_and_its_measures),
        cmocka_unit_test(a_seed_grows_the_same_tree),
        cmocka_unit_test(irradiance_has_a_row_for_every_leaf_band_model_and_component),
        cmocka_unit_test(the_sun_alone_is_geometry),
        cmocka_unit_test(unknown_light_is_refused_not_invented),
        cmocka_unit_test(a_model_may_name_its_own_g_factor),
        cmocka_unit_test(render_makes_a_png),
        cmocka_unit_test(a_picture_of_several_has_a_panel_each),
        cmocka_unit_test(threads_do_not_change_an_answer),
        cmocka_unit_test(bad_input_is_one_line_and_exit_2),
    };
    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
