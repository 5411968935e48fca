/* The window by what its events do to it: files dropped, wheel, size, a dense screen, keys.
 * Under a virtual display.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "preview/window_own.h"
#include "support/support.h"

static const char OAK[] = PPS_DATA_DIR "/trees/oak_small.obj";

/* As a desktop tells programs of a dense screen; the tool may not be there. */
static const char DENSE[] = "xprop -root -f RESOURCE_MANAGER 8s "
                            "-set RESOURCE_MANAGER 'Xft.dpi: 192' 2>/dev/null";
static bool dense;

static view_window w;

static void write_cards(const char *path, int n) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int i = 0; i < n; i++) {
        fprintf(file, "v 0 %d 0\nv 9 %d 0\nv 9 %d 9\nv 0 %d 9\n", i, i, i, i);
    }
    fputs("usemtl leaf\n", file);
    for (int i = 0; i < n; i++) {
        fprintf(file, "f %d %d %d %d\n", 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4);
    }
    assert_int_equal(fclose(file), 0);
}

/* Until all is open that was asked for. */
static bool open_all(pps_problem *problem) {
    bool good = true;
    while (good && w.opener.running) {
        glfwWaitEventsTimeout(0.05);
        good = window_take(&w, problem);
    }
    return good;
}

static int setup(void **state) {
    (void)state;
    static char arguments[][24] = {"p", "--model", "leaf",    "--samples",
                                   "1", "--size",  "300x240", "window-cards.obj"};
    char *argv[9] = {NULL};
    preview_options options;
    pps_problem problem = {""};
    for (int i = 0; i < 8; i++) {
        argv[i] = arguments[i];
    }
    write_cards("window-cards.obj", 4);
    dense = system(DENSE) == 0;
    if (!options_read(8, argv, &options, &problem) ||
        window_open(&options, &w, &problem) != EXIT_DONE ||
        !window_draw(&w, &problem) || !open_all(&problem) ||
        !window_draw(&w, &problem)) {
        print_message("%s\n", problem.text);
        return -1;
    }
    return 0;
}

/* Closed in the midst of Monte Carlo that would take hours. */
static int teardown(void **state) {
    (void)state;
    if (!options_model("mc", &w.settings.options.stage)) {
        return -1;
    }
    w.settings.options.stage.rays = 10000000000;
    window_load(&w, true, NULL, NULL);
    window_close(&w);
    return 0;
}

static void settle(void) {
    pps_problem problem = {""};
    if (!open_all(&problem)) {
        fail_msg("%s", problem.text);
    }
}

static void draw(void) {
    pps_problem problem = {""};
    settle();
    if (!window_draw(&w, &problem)) {
        fail_msg("%s", problem.text);
    }
}

/* The callback that the window has registered is called as GLFW would. */
static void begin_drop(const char *path) {
    GLFWdropfun call = glfwSetDropCallback(w.window, NULL);
    call(w.window, 1, &path);
    glfwSetDropCallback(w.window, call);
}

static void drop(const char *path) {
    begin_drop(path);
    settle();
}

static void wheel(double y) {
    GLFWscrollfun call = glfwSetScrollCallback(w.window, NULL);
    call(w.window, 0, y);
    glfwSetScrollCallback(w.window, call);
}

static void key(int code, int mods) {
    GLFWkeyfun call = glfwSetKeyCallback(w.window, NULL);
    call(w.window, code, 0, GLFW_PRESS, mods);
    glfwSetKeyCallback(w.window, call);
}

static void a_dropped_mesh_is_opened_and_framed(void **state) {
    (void)state;
    double far = w.orbit.distance;
    assert_int_equal(w.stages.of[0]->n_triangles, 8);
    drop(OAK);
    assert_string_equal(w.note, "");
    assert_int_equal(w.stages.of[0]->n_triangles, 6806);
    assert_true(w.orbit.distance != far);
    draw();
}

static void a_dropped_file_that_is_no_scene_changes_nothing(void **state) {
    (void)state;
    size_t n = w.stages.of[0]->n_triangles;
    drop("no-such-file.obj");
    assert_non_null(strstr(w.note, "no-such-file.obj"));
    assert_int_equal(w.stages.of[0]->n_triangles, n);
    assert_null(strstr(w.scene_path, "no-such-file"));
    draw();
}

static void a_reload_keeps_the_camera_and_the_sun(void **state) {
    (void)state;
    drop("window-cards.obj");
    key(GLFW_KEY_LEFT, 0);
    wheel(3);
    orbit before = w.orbit;
    double sun = w.settings.sun[0];
    write_cards("window-cards.obj", 6);
    key(GLFW_KEY_R, 0);
    settle();
    assert_int_equal(w.stages.of[0]->n_triangles, 12);
    assert_memory_equal(&before, &w.orbit, sizeof before);
    assert_close(w.settings.sun[0], sun, 0, 1e-9);
}

/* What is there is drawn and moves while something else is opened. */
static void the_window_goes_on_while_a_scene_opens(void **state) {
    (void)state;
    pps_problem problem = {""};
    drop("window-cards.obj");
    double far = w.orbit.distance;
    begin_drop(OAK);
    assert_true(w.opener.running);
    wheel(1);
    assert_true(window_draw(&w, &problem));
    window_show(&w);
    assert_close(w.orbit.distance, far / 1.1, 1e-12, 0);
    assert_int_equal(w.stages.of[0]->n_triangles, 12);
    settle();
    assert_int_equal(w.stages.of[0]->n_triangles, 6806);
}

/* Of models asked for one after another the last is there; the sun stands where it was put
 * meanwhile. */
static void what_is_set_while_a_scene_opens_holds(void **state) {
    (void)state;
    stage_options was = w.settings.options.stage;
    key(GLFW_KEY_M, 0);
    key(GLFW_KEY_LEFT, 0);
    key(GLFW_KEY_M, GLFW_MOD_SHIFT);
    key(GLFW_KEY_M, GLFW_MOD_SHIFT);
    key(GLFW_KEY_2, 0);
    draw();
    const stage *s = w.stages.of[0];
    assert_string_not_equal(options_model_name(&s->options), options_model_name(&was));
    assert_string_equal(options_model_name(&s->options),
                        options_model_name(&w.settings.options.stage));
    double azimuth =
        atan2(s->scene->sun.to[1], s->scene->sun.to[0]) * 180 / 3.14159265358979323846;
    assert_close(azimuth, w.settings.sun[0], 0, 1e-9);
    assert_close(pps_leaf_albedo(&s->scene->prototype[0].optics, 1),
                 w.settings.options.albedo[1], 1e-12, 0);
    key(GLFW_KEY_M, 0);
    settle();
    assert_string_equal(options_model_name(&w.stages.of[0]->options),
                        options_model_name(&was));
}

/* A plant turned by 30 degrees is none for sppg: the key goes past it, all the way round. */
static void models_that_do_not_take_the_scene_are_passed_over(void **state) {
    (void)state;
    FILE *file = fopen("window-turned.json", "w");
    assert_non_null(file);
    fputs("{\"prototypes\": {\"a\": {\"mesh\": \"window-cards.obj\"}}, "
          "\"instances\": [{\"yaw\": 30}], "
          "\"sun\": {\"direction\": [0, 0, 1], \"irradiance\": [1, 1, 1]}}",
          file);
    assert_int_equal(fclose(file), 0);
    drop("window-turned.json");
    assert_string_equal(w.note, "");
    stage_options was = w.settings.options.stage;
    int n = 0;
    do {
        key(GLFW_KEY_M, 0);
        settle();
        assert_string_equal(w.note, "");
        assert_string_not_equal(options_model_name(&w.stages.of[0]->options), "sppg");
        n++;
    } while (strcmp(options_model_name(&w.settings.options.stage),
                    options_model_name(&was)) != 0);
    assert_int_equal(n, pps_light_model_count()); /* with mc, without leaf-lattice */
    drop("window-cards.obj");
}

/* All that was asked for since goes back with it. */
static void a_failure_while_a_scene_opens_goes_back(void **state) {
    (void)state;
    stage_options was = w.settings.options.stage;
    size_t n = w.stages.of[0]->n_triangles;
    key(GLFW_KEY_M, 0);
    begin_drop("no-such-file.obj");
    settle();
    assert_non_null(strstr(w.note, "no-such-file.obj"));
    assert_int_equal(w.stages.of[0]->n_triangles, n);
    assert_string_equal(options_model_name(&w.settings.options.stage),
                        options_model_name(&was));
    assert_null(strstr(w.scene_path, "no-such-file"));
}

static void the_wheel_comes_nearer(void **state) {
    (void)state;
    key(GLFW_KEY_TAB, 0); /* no panel that may lie under the cursor */
    draw();
    double far = w.orbit.distance;
    wheel(1);
    assert_close(w.orbit.distance, far / 1.1, 1e-12, 0);
    wheel(-1);
    assert_close(w.orbit.distance, far, 1e-12, 0);
    key(GLFW_KEY_TAB, 0);
    draw();
}

static void frames_follow_the_window_s_size(void **state) {
    (void)state;
    glfwSetWindowSize(w.window, 200, 160);
    for (int i = 0; i < 100 && w.fine.width != 200; i++) {
        glfwWaitEventsTimeout(0.05);
        draw();
    }
    assert_int_equal(w.fine.width, 200);
    assert_int_equal(w.fine.height, 160);
}

/* On a screen of 192 dots an inch letters are twice as large. */
static void letters_grow_with_the_screen_s_density(void **state) {
    (void)state;
    float scale;
    glfwGetWindowContentScale(w.window, &scale, NULL);
    print_message("content scale %g\n", (double)scale);
    assert_true(!dense || scale == 2);
    assert_int_equal(w.scale, (int)scale);
    assert_int_equal(w.settings_place.x, 8 * (int)scale);
}

/* Each setting goes one way, and back; what it shows changes and is what it was. */
static void every_setting_goes_and_comes_back(void **state) {
    (void)state;
    for (const setting *row = settings_table; row->keys; row++) {
        char before[40], there[40], back[40];
        row->write(&w.settings, before, sizeof before);
        key(row->more, 0);
        draw();
        row->write(&w.settings, there, sizeof there);
        key(row->less ? row->less : row->more, row->less ? 0 : GLFW_MOD_SHIFT);
        draw();
        row->write(&w.settings, back, sizeof back);
        bool albedo = strncmp(row->name, "albedo", 6) == 0; /* in steps of 0.05 */
        bool stays = strcmp(row->name, "G-factor") == 0;    /* `leaf` takes none */
        if ((strcmp(before, there) == 0) != stays ||
            (!albedo && strcmp(before, back) != 0)) {
            fail_msg("%s: %s, %s, %s", row->name, before, there, back);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_dropped_mesh_is_opened_and_framed),
        cmocka_unit_test(a_dropped_file_that_is_no_scene_changes_nothing),
        cmocka_unit_test(a_reload_keeps_the_camera_and_the_sun),
        cmocka_unit_test(the_window_goes_on_while_a_scene_opens),
        cmocka_unit_test(what_is_set_while_a_scene_opens_holds),
        cmocka_unit_test(models_that_do_not_take_the_scene_are_passed_over),
        cmocka_unit_test(a_failure_while_a_scene_opens_goes_back),
        cmocka_unit_test(the_wheel_comes_nearer),
        cmocka_unit_test(frames_follow_the_window_s_size),
        cmocka_unit_test(letters_grow_with_the_screen_s_density),
        cmocka_unit_test(every_setting_goes_and_comes_back),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
