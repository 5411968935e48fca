/* A window by GLFW. Frames are drawn when something changed; while the mouse drags, and a
 * fine frame takes long, at half the size.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/window.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define GLFW_INCLUDE_NONE
#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include "preview/frame.h"
#include "preview/orbit.h"
#include "preview/panel.h"
#include "preview/stage_open.h"

static const double LOOK_AGAIN = 0.5; /* seconds between looks at the scene's file */
static const double SLOW = 0.05;      /* a frame of more seconds is coarse in drags */

typedef struct {
    GLFWwindow *window;
    preview_options options;
    char scene_path[4096]; /* of a dropped file */
    stage *stage;
    orbit orbit;
    double sun[2]; /* azimuth, elevation */
    frame fine, coarse;
    GLuint tone, empty;
    panel panel;
    bool help, dirty, sun_moved, dragging, save;
    double last[2], frame_seconds;
    struct timespec changed; /* of the scene's file */
    char note[600];
    int pictures;
} view_window;

static const char HELP[] = "left drag     orbit\n"
                           "right drag    the sun\n"
                           "middle drag   pan (or shift and left)\n"
                           "wheel         zoom\n"
                           "arrows        the sun by 5 degrees\n"
                           "m, M          next model, one back\n"
                           "g             G-factor: none, derived, printed\n"
                           "c             component: all, sun, indirect, sky, ...\n"
                           "f             false colour: sun, scattered, off\n"
                           "[ ]           exposure\n"
                           "Home          the view at the start\n"
                           "s             save a picture\n"
                           "r             read the scene again\n"
                           "h             this list\n"
                           "q, Esc        leave";

/* ---- the stage ---- */

static const char *scene_path(const view_window *w) {
    return w->scene_path[0] ? w->scene_path : w->options.scene;
}

static void note_file_time(view_window *w) {
    struct stat about;
    if (scene_path(w) && stat(scene_path(w), &about) == 0) {
        w->changed = about.st_mtim;
    }
}

static void read_sun(view_window *w) {
    const double *to = w->stage->scene->sun.to;
    w->sun[0] = atan2(to[1], to[0]) * 180 / 3.14159265358979323846;
    w->sun[1] = asin(fmin(fmax(to[2], -1), 1)) * 180 / 3.14159265358979323846;
}

static double aspect(const view_window *w) {
    return (double)w->fine.width / w->fine.height;
}

/* Read the scene and light it. The sun stays where it was if `keep`. On failure what was
 * there stays, and a note tells why. */
static bool load(view_window *w, bool keep, pps_problem *problem) {
    preview_options options = w->options;
    options.scene = scene_path(w);
    if (keep) {
        options.sun_given = true;
        memcpy(options.sun, w->sun, sizeof options.sun);
    }
    note_file_time(w);
    pps_scene *scene = scene_for(&options, problem);
    stage *fresh = scene ? stage_open(scene, &options.stage, problem) : NULL;
    if (!fresh) {
        snprintf(w->note, sizeof w->note, "%s", problem->text);
        w->dirty = true;
        return false;
    }
    stage_close(w->stage);
    w->stage = fresh;
    w->note[0] = '\0';
    w->dirty = true;
    read_sun(w);
    return true;
}

static void reload_when_changed(view_window *w) {
    struct stat about;
    pps_problem problem = {""};
    if (scene_path(w) && stat(scene_path(w), &about) == 0 &&
        (about.st_mtim.tv_sec != w->changed.tv_sec ||
         about.st_mtim.tv_nsec != w->changed.tv_nsec)) {
        load(w, false, &problem);
    }
}

/* ---- drawing ---- */

static const char *model_name(const view_window *w) {
    const stage_options *o = &w->options.stage;
    return o->way == STAGE_INSTANCES     ? "sppg"
           : o->way == STAGE_MONTE_CARLO ? "mc"
                                         : o->model->name;
}

static const char *component_name(unsigned sources) {
    return sources == PPS_ALL_LIGHT      ? "all light"
           : sources == PPS_SUN          ? "sun"
           : sources == PPS_SUN_INDIRECT ? "indirect"
           : sources == PPS_SKY          ? "sky"
           : sources == PPS_SKY_INDIRECT ? "sky-indirect"
                                         : "some light";
}

static void write_panels(const view_window *w, int width, int height, int scale) {
    static const char *const form[] = {"", ", G derived", ", G printed"};
    static const char *const show[] = {"", "\nfalse colour: the sun's share",
                                       "\nfalse colour: scattered light"};
    const double *t = w->stage->seconds;
    char text[1000];
    snprintf(
        text, sizeof text,
        "%s%s, %s%s\nsun %.0f, %.0f  frame %.0f ms\ncells %.2f s, sky %.0f ms, sun "
        "%.0f + %.0f ms\n%zu triangles  (h: help)",
        model_name(w), form[w->options.stage.compensate],
        component_name(w->options.stage.sources), show[w->options.look.show], w->sun[0],
        w->sun[1], 1000 * w->frame_seconds, t[0] + t[1] + t[2], 1000 * t[3],
        1000 * t[4], 1000 * t[5], w->stage->n_triangles);
    panel_draw(&w->panel, width, height, scale, false, w->help ? HELP : text);
    if (w->note[0]) {
        panel_draw(&w->panel, width, height, scale, true, w->note);
    }
}

static void show(const view_window *w, const frame *f, int width, int height) {
    double exposure = w->options.exposure * stage_exposure(w->stage);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(w->tone);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, f->texture);
    gl_set_int(w->tone, "picture", 0);
    gl_set_float(w->tone, "exposure",
                 w->options.look.show == SHOW_LIGHT ? exposure : 1);
    glBindVertexArray(w->empty);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

static void draw_frame(view_window *w, const frame *f) {
    pps_camera camera;
    orbit_camera(&w->orbit, &camera);
    frame_begin(f);
    stage_draw(w->stage, &camera, f->width, f->height, &w->options.look);
    frame_finish(f);
    glFinish();
}

/* The fine frame, as it was drawn last. */
static void save_picture(view_window *w) {
    w->save = false;
    pps_problem problem = {""};
    pps_picture *picture;
    char path[64];
    struct stat about;
    do {
        snprintf(path, sizeof path, "ppscat-preview-%d.png", ++w->pictures);
    } while (stat(path, &about) == 0 && w->pictures < 10000);
    if (pps_picture_create(w->fine.width, w->fine.height, &picture)) {
        return;
    }
    frame_read(&w->fine, picture);
    double exposure = w->options.look.show == SHOW_LIGHT
                          ? w->options.exposure * stage_exposure(w->stage)
                          : 1;
    if (pps_picture_write(picture, exposure, path, &problem)) {
        snprintf(w->note, sizeof w->note, "%s", problem.text);
    } else {
        snprintf(w->note, sizeof w->note, "saved %s", path);
    }
    pps_picture_free(picture);
}

static bool draw(view_window *w, pps_problem *problem) {
    int width, height;
    float scale;
    glfwGetFramebufferSize(w->window, &width, &height);
    glfwGetWindowContentScale(w->window, &scale, NULL);
    if (width < 1 || height < 1) { /* an icon */
        return true;
    }
    if (w->sun_moved) {
        turn_sun(w->stage->scene, w->sun[0], w->sun[1]);
        if (!stage_light_sun(w->stage, problem)) {
            return false;
        }
        w->sun_moved = false;
    }
    if (width != w->fine.width || height != w->fine.height) {
        frame_free(&w->fine);
        frame_free(&w->coarse);
        if (!frame_create(width, height, w->options.samples, &w->fine, problem) ||
            !frame_create((width + 1) / 2, (height + 1) / 2, 1, &w->coarse, problem)) {
            return false;
        }
    }
    bool coarse = w->dragging && w->frame_seconds > SLOW && !w->save;
    const frame *f = coarse ? &w->coarse : &w->fine;
    double start = glfwGetTime();
    draw_frame(w, f);
    if (!coarse) {
        w->frame_seconds = glfwGetTime() - start;
    }
    if (w->save) {
        save_picture(w);
    }
    show(w, f, width, height);
    double letters =
        width < 900 * (double)scale ? 1 : 2; /* small windows, small letters */
    write_panels(w, width, height, (int)fmax(letters * (double)scale, 1));
    glfwSwapBuffers(w->window);
    w->dirty = coarse; /* the fine one follows */
    return gl_check("drawing", problem);
}

/* ---- keys ---- */

/* The models in the order of the table, then sppg and mc. */
static void next_model(view_window *w, int step) {
    int n = (int)pps_light_model_count(), at = n;
    preview_options before = w->options;
    pps_problem problem = {""};
    for (int i = 0; i < n; i++) {
        at = before.stage.model == pps_light_model_at((size_t)i) ? i : at;
    }
    at = before.stage.way == STAGE_MONTE_CARLO ? n + 1 : at;
    at = (at + step + n + 2) % (n + 2);
    while (!options_model(at == n       ? "sppg"
                          : at == n + 1 ? "mc"
                                        : pps_light_model_at((size_t)at)->name,
                          &w->options.stage)) {
        at = (at + step + n + 2) % (n + 2); /* one that has no cells to show */
    }
    stage_options *o = &w->options.stage;
    o->compensate = o->way == STAGE_INSTANCES ? PPS_COMPENSATE_DERIVED : 0;
    if (!load(w, true, &problem)) {
        w->options = before;
    }
}

static void next_compensation(view_window *w) {
    stage_options *o = &w->options.stage, before = *o;
    pps_problem problem = {""};
    if (o->way == STAGE_INSTANCES || (o->way == STAGE_GRID && o->model->compensates)) {
        o->compensate = (pps_compensation)((o->compensate + 1) % 3);
        if (!load(w, true, &problem)) {
            *o = before;
        }
    } else {
        snprintf(w->note, sizeof w->note, "%s takes no G-factor", model_name(w));
    }
}

static void next_component(view_window *w) {
    unsigned *now = &w->options.stage.sources;
    *now = *now == PPS_ALL_LIGHT      ? 1
           : *now >= PPS_SKY_INDIRECT ? PPS_ALL_LIGHT
                                      : *now * 2;
    w->stage->options.sources = *now;
    w->sun_moved = true;
}

static void move_sun(view_window *w, double azimuth, double elevation) {
    w->sun[0] = remainder(w->sun[0] + azimuth, 360);
    w->sun[1] = fmin(fmax(w->sun[1] + elevation, 1), 90);
    w->sun_moved = true;
}

static void start_view(view_window *w) {
    orbit_fit(&w->orbit, w->stage->scene, w->options.view[0], w->options.view[1],
              aspect(w));
}

static void on_key(GLFWwindow *window, int key, int code, int action, int mods) {
    view_window *w = glfwGetWindowUserPointer(window);
    pps_problem problem = {""};
    (void)code;
    if (action == GLFW_RELEASE || !w->stage) {
        return;
    }
    w->dirty = true;
    w->note[0] = '\0';
    switch (key) {
    case GLFW_KEY_LEFT:
        move_sun(w, 5, 0);
        break;
    case GLFW_KEY_RIGHT:
        move_sun(w, -5, 0);
        break;
    case GLFW_KEY_UP:
        move_sun(w, 0, 5);
        break;
    case GLFW_KEY_DOWN:
        move_sun(w, 0, -5);
        break;
    case GLFW_KEY_M:
        next_model(w, mods & GLFW_MOD_SHIFT ? -1 : 1);
        break;
    case GLFW_KEY_G:
        next_compensation(w);
        break;
    case GLFW_KEY_C:
        next_component(w);
        break;
    case GLFW_KEY_F:
        w->options.look.show = (stage_show)((w->options.look.show + 1) % 3);
        break;
    case GLFW_KEY_LEFT_BRACKET:
        w->options.exposure /= 1.2;
        break;
    case GLFW_KEY_RIGHT_BRACKET:
        w->options.exposure *= 1.2;
        break;
    case GLFW_KEY_HOME:
        start_view(w);
        break;
    case GLFW_KEY_S:
        w->save = true; /* of the next frame, with all that moved until now */
        break;
    case GLFW_KEY_R:
        load(w, true, &problem);
        break;
    case GLFW_KEY_H:
        w->help = !w->help;
        break;
    case GLFW_KEY_Q:
    case GLFW_KEY_ESCAPE:
        glfwSetWindowShouldClose(window, GLFW_TRUE);
        break;
    default:
        break;
    }
}

/* ---- mouse ---- */

static bool held(GLFWwindow *window, int button) {
    return glfwGetMouseButton(window, button) == GLFW_PRESS;
}

static void on_move(GLFWwindow *window, double x, double y) {
    view_window *w = glfwGetWindowUserPointer(window);
    int width, height;
    glfwGetWindowSize(window, &width, &height);
    double dx = x - w->last[0], dy = y - w->last[1];
    bool shift = glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                 glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    bool left = held(window, GLFW_MOUSE_BUTTON_LEFT);
    w->last[0] = x;
    w->last[1] = y;
    w->dragging = left || held(window, GLFW_MOUSE_BUTTON_RIGHT) ||
                  held(window, GLFW_MOUSE_BUTTON_MIDDLE);
    if (!w->stage || !w->dragging || height < 1) {
        return;
    }
    const pps_ground *ground = &w->stage->scene->ground;
    double floor = ground->present ? ground->height + 0.2 : -1e9;
    if (left && !shift) {
        orbit_turn(&w->orbit, -180 * dx / height, 180 * dy / height, floor);
    } else if (held(window, GLFW_MOUSE_BUTTON_RIGHT)) {
        move_sun(w, -180 * dx / height, -90 * dy / height);
    } else {
        orbit_pan(&w->orbit, -dx / height, dy / height);
    }
    w->dirty = true;
}

static void on_button(GLFWwindow *window, int button, int action, int mods) {
    view_window *w = glfwGetWindowUserPointer(window);
    (void)button;
    (void)mods;
    w->dragging = action == GLFW_PRESS;
    w->dirty = true;
}

static void on_wheel(GLFWwindow *window, double x, double y) {
    view_window *w = glfwGetWindowUserPointer(window);
    (void)x;
    orbit_zoom(&w->orbit, pow(1.1, y));
    w->dirty = true;
}

static void on_drop(GLFWwindow *window, int n, const char **path) {
    view_window *w = glfwGetWindowUserPointer(window);
    pps_problem problem = {""};
    char before[sizeof w->scene_path];
    if (n < 1 || strlen(path[0]) >= sizeof w->scene_path) {
        return;
    }
    memcpy(before, w->scene_path, sizeof before);
    strcpy(w->scene_path, path[0]);
    if (load(w, false, &problem)) {
        start_view(w);
    } else {
        memcpy(w->scene_path, before, sizeof before);
    }
}

static void on_change(GLFWwindow *window, int width, int height) {
    view_window *w = glfwGetWindowUserPointer(window);
    (void)width;
    (void)height;
    w->dirty = true;
}

static void on_uncovered(GLFWwindow *window) {
    view_window *w = glfwGetWindowUserPointer(window);
    w->dirty = true;
}

/* ---- life ---- */

static bool open_window(view_window *w, pps_problem *problem) {
    const char *why = NULL;
    if (!glfwInit()) {
        glfwGetError(&why);
        snprintf(problem->text, sizeof problem->text,
                 "no window: %s (--snapshot FILE.png needs no display)",
                 why ? why : "no display");
        return false;
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    w->window = glfwCreateWindow(w->options.width, w->options.height, "ppscat-preview",
                                 NULL, NULL);
    if (!w->window) {
        glfwGetError(&why);
        snprintf(problem->text, sizeof problem->text, "no window of OpenGL 3.3: %s",
                 why ? why : "the driver refuses");
        return false;
    }
    glfwMakeContextCurrent(w->window);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(w->window, w);
    glfwSetKeyCallback(w->window, on_key);
    glfwSetCursorPosCallback(w->window, on_move);
    glfwSetMouseButtonCallback(w->window, on_button);
    glfwSetScrollCallback(w->window, on_wheel);
    glfwSetDropCallback(w->window, on_drop);
    glfwSetFramebufferSizeCallback(w->window, on_change);
    glfwSetWindowRefreshCallback(w->window, on_uncovered);
    return gl_good_enough(problem);
}

static bool prepare(view_window *w, pps_problem *problem) {
    int width, height;
    glfwGetFramebufferSize(w->window, &width, &height);
    glGenVertexArrays(1, &w->empty);
    w->tone = gl_program("screen_vert", "tone_frag", problem);
    return w->tone && panel_create(&w->panel, problem) &&
           frame_create(width, height, w->options.samples, &w->fine, problem) &&
           frame_create((width + 1) / 2, (height + 1) / 2, 1, &w->coarse, problem);
}

static bool loop(view_window *w, pps_problem *problem) {
    double looked = glfwGetTime();
    while (!glfwWindowShouldClose(w->window)) {
        if (w->dirty || w->sun_moved) {
            glfwPollEvents();
            if (!draw(w, problem)) {
                return false;
            }
        } else {
            glfwWaitEventsTimeout(LOOK_AGAIN);
        }
        if (glfwGetTime() - looked > LOOK_AGAIN) {
            reload_when_changed(w);
            looked = glfwGetTime();
        }
    }
    return true;
}

static void close_window(view_window *w) {
    if (w->window) {
        stage_close(w->stage);
        frame_free(&w->fine);
        frame_free(&w->coarse);
        panel_free(&w->panel);
        glDeleteProgram(w->tone);
        glDeleteVertexArrays(1, &w->empty);
        glfwDestroyWindow(w->window);
    }
    glfwTerminate();
}

int window_run(const preview_options *options, pps_problem *problem) {
    view_window *w = calloc(1, sizeof *w);
    int rc = EXIT_FAILED;
    if (!w) {
        strcpy(problem->text, "out of memory");
        return rc;
    }
    w->options = *options;
    pps_scene *scene = scene_for(options, problem); /* broken: no window opens */
    if (!scene) {
        free(w);
        return EXIT_USAGE;
    }
    pps_scene_free(scene);
    if (open_window(w, problem) && prepare(w, problem) && load(w, false, problem)) {
        start_view(w);
        rc = loop(w, problem) ? EXIT_DONE : EXIT_FAILED;
    }
    close_window(w);
    free(w);
    return rc;
}
