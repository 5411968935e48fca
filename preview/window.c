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

#include "preview/stage_open.h"
#include "preview/window_own.h"

static const double LOOK_AGAIN = 0.5; /* seconds between looks at the scene's file */
static const double SLOW = 0.05;      /* a frame of more seconds is coarse in drags */
enum { FEWER_RAYS = 20 };             /* of Monte Carlo while the sun is dragged */

/* ---- the stages ---- */

static const char *scene_path(const view_window *w) {
    return w->scene_path[0] ? w->scene_path : w->settings.options.scene;
}

static void note_file_time(view_window *w) {
    struct stat about;
    if (scene_path(w) && stat(scene_path(w), &about) == 0) {
        w->changed = about.st_mtim;
    }
}

static void read_albedo(view_window *w) {
    const pps_scene *scene = w->stages.scene;
    w->settings.n_bands = scene->n_bands;
    for (int b = 0; b < scene->n_bands; b++) {
        w->settings.albedo[b] = pps_leaf_albedo(&scene->prototype[0].optics, b);
    }
}

/* What the scene says, into the settings. */
static void read_scene(view_window *w) {
    const double *to = w->stages.scene->sun.to;
    read_albedo(w);
    w->settings.sun[0] = atan2(to[1], to[0]) * 180 / 3.14159265358979323846;
    w->settings.sun[1] = asin(fmin(fmax(to[2], -1), 1)) * 180 / 3.14159265358979323846;
}

static void warn(view_window *w) {
    char before[sizeof w->warning];
    memcpy(before, w->warning, sizeof before);
    if (!leaves_too_large(w->stages.of[0], w->warning, sizeof w->warning)) {
        w->warning[0] = '\0';
    } else if (strcmp(before, w->warning) != 0) {
        fprintf(stderr, "ppscat-preview: %s\n", w->warning);
    }
}

/* Give leaves their new albedo, and find all light anew. */
static void light_leaves(view_window *w) {
    pps_problem problem = {""};
    for (int b = 0; b < w->stages.scene->n_bands; b++) {
        if (!isnan(w->settings.options.albedo[b])) {
            set_albedo(w->stages.scene, b, w->settings.options.albedo[b]);
        }
    }
    for (int i = 0; i < 2 && w->stages.of[i]; i++) {
        if (!stage_light_sky(w->stages.of[i], &problem)) {
            snprintf(w->note, sizeof w->note, "%s", problem.text);
        }
    }
}

/* ---- opening ---- */

static void wake(void) { glfwPostEmptyEvent(); }

static void start_opening(view_window *w, pps_scene *scene) {
    preview_options options = w->settings.options;
    options.scene = scene_path(w);
    if (w->opening.keep) {
        options.sun_given = true;
        memcpy(options.sun, w->settings.sun, sizeof options.sun);
    }
    if (!scene) {
        note_file_time(w);
    }
    w->opening.again = false;
    opener_start(&w->opener, &options, scene, wake);
}

void window_load(view_window *w, bool keep, const settings *before, const char *path) {
    opening *o = &w->opening;
    if (w->opener.running) { /* what is gone back to stays as it was */
        o->again = true;
        o->keep = o->keep && keep;
        opener_cancel(&w->opener);
    } else {
        o->settings = before ? *before : w->settings;
        memcpy(o->scene_path, w->scene_path, sizeof o->scene_path);
        o->keep = keep;
        o->fit = false;
    }
    if (path) {
        strcpy(w->scene_path, path);
        o->fit = true;
    }
    if (!w->opener.running) {
        start_opening(w, NULL);
    }
}

static void go_back(view_window *w, const pps_problem *problem) {
    w->settings = w->opening.settings;
    memcpy(w->scene_path, w->opening.scene_path, sizeof w->scene_path);
    snprintf(w->note, sizeof w->note, "%s", problem->text);
}

/* Show what was opened, in place of what is there, with what was set meanwhile. */
static void show_opened(view_window *w) {
    const preview_options *then = &w->opener.options, *now = &w->settings.options;
    settings before = w->settings;
    pair_close(&w->stages);
    w->stages = w->opener.pair;
    for (int i = 0; i < 2 && w->stages.of[i]; i++) {
        w->stages.of[i]->options.progress = NULL; /* the next opening's */
    }
    w->note[0] = '\0';
    read_scene(w);
    if (w->opening.keep) {
        memcpy(w->settings.sun, before.sun, sizeof before.sun);
    }
    if (memcmp(then->albedo, now->albedo, sizeof then->albedo) != 0) {
        light_leaves(w);
        read_albedo(w);
    }
    w->sun_moved =
        w->sun_moved || then->stage.sources != now->stage.sources ||
        (w->opening.keep && memcmp(then->sun, before.sun, sizeof before.sun) != 0);
    if (w->opening.fit) {
        window_start_view(w);
    }
    warn(w);
}

bool window_take(view_window *w, pps_problem *problem) {
    opener *o = &w->opener;
    if (!opener_finished(o)) {
        return true;
    }
    w->dirty = true;
    if (w->opening.again) {
        if (o->good) {
            pair_close(&o->pair);
        }
        start_opening(w, NULL);
        return true;
    }
    if (o->good && !pair_upload(&o->pair, &o->problem)) {
        pair_close(&o->pair);
        o->good = false;
    }
    if (o->good) {
        show_opened(w);
        return true;
    }
    go_back(w, &o->problem);
    *problem = o->problem;
    return w->stages.of[0] != NULL;
}

static void reload_when_changed(view_window *w) {
    struct stat about;
    if (scene_path(w) && stat(scene_path(w), &about) == 0 &&
        (about.st_mtim.tv_sec != w->changed.tv_sec ||
         about.st_mtim.tv_nsec != w->changed.tv_nsec)) {
        window_load(w, false, NULL, NULL);
    }
}

void window_apply(view_window *w, setting_effect effect, const settings *before) {
    if (effect == EFFECT_OPEN) {
        window_load(w, true, before, NULL);
    } else if (effect == EFFECT_LEAVES) {
        light_leaves(w);
    } else if (effect == EFFECT_SUN) {
        w->sun_moved = true;
    }
    if (w->settings.note[0]) {
        snprintf(w->note, sizeof w->note, "%s", w->settings.note);
    }
    w->dirty = true;
}

static bool light_sun(view_window *w, pps_problem *problem) {
    bool dragged = w->drag == DRAG_SUN || w->drag == DRAG_TIME;
    w->sun_moved = false;
    turn_sun(w->stages.scene, w->settings.sun[0], w->settings.sun[1]);
    for (int i = 0; i < 2 && w->stages.of[i]; i++) {
        stage *s = w->stages.of[i];
        s->options.sources = w->settings.options.stage.sources;
        uint64_t rays = stage_rays(s->scene, w->settings.options.stage.rays);
        s->options.rays = dragged ? rays / FEWER_RAYS + 1 : rays;
        if (!stage_light_sun(s, problem)) {
            return false;
        }
    }
    return true;
}

/* ---- what is written on the window ---- */

enum { TEXT = 4000 };

static void write_settings(const view_window *w, char *text, size_t size) {
    size_t used = 0;
    for (const setting *row = settings_table; row->keys && used < size; row++) {
        char value[40];
        row->write(&w->settings, value, sizeof value);
        used += (size_t)snprintf(text + used, size - used, "%-11s%-15s< %-15s>\n",
                                 row->keys, row->name, value);
    }
}

/* What is being opened, and how far that is. */
static void write_opening(const view_window *w, char *text, size_t size) {
    const char *scene = scene_path(w);
    char step[60];
    opener_write(&w->opener, step, sizeof step);
    snprintf(text, size, "opening %.200s: %s", scene ? scene : "a grove", step);
}

static void write_times(const view_window *w, char *text, size_t size) {
    size_t used =
        (size_t)snprintf(text, size, "frame %.0f ms", 1000 * w->frame_seconds);
    for (int i = 0; i < 2 && w->stages.of[i]; i++) {
        const stage *s = w->stages.of[i];
        const double *t = s->seconds;
        used +=
            (size_t)snprintf(text + used, size - used,
                             "\n%s, ms: 1 cells %.0f, 2 maps %.0f, 3 G %.0f, 4 sky "
                             "%.0f, 5 sun %.0f + %.0f",
                             options_model_name(&s->options), 1000 * t[0], 1000 * t[1],
                             1000 * t[2], 1000 * t[3], 1000 * t[4], 1000 * t[5]);
    }
    used += (size_t)snprintf(text + used, size - used,
                             "\n%zu triangles; h: help, Tab: no panel%s%s%s%s",
                             w->stages.of[0]->n_triangles, w->warning[0] ? "\n" : "",
                             w->warning, w->note[0] ? "\n" : "", w->note);
    if (w->opener.running && used + 1 < size) {
        text[used++] = '\n';
        write_opening(w, text + used, size - used);
    }
}

static void write_help(char *text, size_t size) {
    size_t used = 0;
    for (const setting *row = settings_table; row->keys && used < size; row++) {
        used += (size_t)snprintf(text + used, size - used, "%-13s%s: %s\n", row->keys,
                                 row->name, row->help);
    }
    for (int i = 0; settings_other_keys[i][0] && used < size; i++) {
        used += (size_t)snprintf(text + used, size - used, "%-13s%s\n",
                                 settings_other_keys[i][0], settings_other_keys[i][1]);
    }
}

static void write_panels(view_window *w, int width, int height) {
    char text[TEXT];
    int scale = w->scale, gap = 8 * scale;
    if (!w->stages.of[0]) {
        write_opening(w, text, sizeof text);
        panel_draw(&w->panel, width, height, scale, gap, gap, text);
        return;
    }
    if (w->help) {
        write_help(text, sizeof text);
        panel_draw(&w->panel, width, height, scale, gap, gap, text);
        return;
    }
    if (w->bare) {
        return;
    }
    write_settings(w, text, sizeof text);
    w->settings_place = panel_draw(&w->panel, width, height, scale, gap, gap, text);
    write_times(w, text, sizeof text);
    panel_draw(&w->panel, width, height, scale, gap, -gap, text);
    if (w->stages.of[1]) {
        panel_draw(&w->panel, width, height, scale, -gap, gap,
                   options_model_name(&w->stages.of[1]->options));
    }
}

/* ---- drawing ---- */

static double exposure(const view_window *w) {
    return w->settings.options.look.show == SHOW_LIGHT
               ? w->settings.options.exposure * stage_exposure(w->stages.of[0])
               : 1;
}

static int split_column(const view_window *w, int width) {
    return (int)lround(w->settings.split_at * width);
}

static void show(const view_window *w, const frame *f, int width, int height) {
    static const float white[] = {1, 1, 1, 1};
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(w->tone);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, f->texture);
    gl_set_int(w->tone, "picture", 0);
    gl_set_float(w->tone, "exposure", exposure(w));
    glBindVertexArray(w->empty);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    if (w->stages.of[1]) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(split_column(w, width) - w->scale, 0, w->scale, height);
        glClearBufferfv(GL_COLOR, 0, white);
        glDisable(GL_SCISSOR_TEST);
    }
}

/* Before there is a picture. */
static void clear(int width, int height) {
    static const float gray[] = {0.4F, 0.45F, 0.5F, 1};
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glClearBufferfv(GL_COLOR, 0, gray);
}

static void draw_frame(view_window *w, const frame *f) {
    pps_camera camera;
    orbit_camera(&w->orbit, &camera);
    frame_begin(f);
    pair_draw(&w->stages, split_column(w, f->width), &camera, f->width, f->height,
              &w->settings.options.look);
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
    if (pps_picture_write(picture, exposure(w), path, &problem)) {
        snprintf(w->note, sizeof w->note, "%s", problem.text);
    } else {
        snprintf(w->note, sizeof w->note, "saved %s", path);
    }
    pps_picture_free(picture);
}

/* Frames of the window's size, and letters that suit it and its screen. */
static bool fit_window(view_window *w, int width, int height, pps_problem *problem) {
    float scale;
    glfwGetWindowContentScale(w->window, &scale, NULL);
    int letters = width < 1600 * (double)scale ? 1 : 2;
    w->scale = (int)fmax(letters * (double)scale + 0.5, 1);
    if (width == w->fine.width && height == w->fine.height) {
        return true;
    }
    frame_free(&w->fine);
    frame_free(&w->coarse);
    w->shown = NULL;
    return frame_create(width, height, w->settings.options.samples, &w->fine,
                        problem) &&
           frame_create((width + 1) / 2, (height + 1) / 2, 1, &w->coarse, problem);
}

/* A picture that is asked for waits until all that was set before is there. */
static void draw_light(view_window *w) {
    bool save = w->save && !w->opener.running;
    bool coarse = w->drag && w->frame_seconds > SLOW && !save;
    double start = glfwGetTime();
    w->shown = coarse ? &w->coarse : &w->fine;
    draw_frame(w, w->shown);
    if (!coarse) {
        w->frame_seconds = glfwGetTime() - start;
    }
    if (save) {
        save_picture(w);
    }
    w->dirty = coarse; /* the fine one follows */
}

void window_show(view_window *w) {
    int width, height;
    glfwGetFramebufferSize(w->window, &width, &height);
    if (w->shown) {
        show(w, w->shown, width, height);
    } else {
        clear(width, height);
    }
    write_panels(w, width, height);
    glfwSwapBuffers(w->window);
}

bool window_draw(view_window *w, pps_problem *problem) {
    int width, height;
    glfwGetFramebufferSize(w->window, &width, &height);
    if (width < 1 || height < 1) { /* an icon */
        return true;
    }
    if ((w->sun_moved && !light_sun(w, problem)) ||
        !fit_window(w, width, height, problem)) {
        return false;
    }
    w->dirty = false;
    if (w->stages.of[0]) {
        draw_light(w);
    }
    window_show(w);
    return gl_check("drawing", problem);
}

void window_start_view(view_window *w) {
    const preview_options *o = &w->settings.options;
    orbit_fit(&w->orbit, w->stages.scene, o->view[0], o->view[1],
              (double)w->fine.width / w->fine.height);
    orbit_zoom(&w->orbit, o->zoom);
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
    w->window = glfwCreateWindow(w->settings.options.width, w->settings.options.height,
                                 "ppscat-preview", NULL, NULL);
    if (!w->window) {
        glfwGetError(&why);
        snprintf(problem->text, sizeof problem->text, "no window of OpenGL 3.3: %s",
                 why ? why : "the driver refuses");
        return false;
    }
    glfwMakeContextCurrent(w->window);
    glfwSwapInterval(1);
    window_listen(w);
    return gl_good_enough(problem);
}

static bool prepare(view_window *w, pps_problem *problem) {
    int width, height;
    glfwGetFramebufferSize(w->window, &width, &height);
    glGenVertexArrays(1, &w->empty);
    w->tone = gl_program("screen_vert", "tone_frag", problem);
    return w->tone && panel_create(&w->panel, problem) &&
           fit_window(w, width, height, problem);
}

static bool loop(view_window *w, pps_problem *problem) {
    double looked = glfwGetTime();
    while (!glfwWindowShouldClose(w->window)) {
        if (w->dirty || w->sun_moved) {
            glfwPollEvents();
            if (!window_draw(w, problem)) {
                return false;
            }
        } else if (w->opener.running) { /* its progress */
            window_show(w);
            glfwWaitEventsTimeout(LOOK_AGAIN);
        } else {
            glfwWaitEventsTimeout(LOOK_AGAIN);
        }
        if (!window_take(w, problem)) {
            return false;
        }
        if (!w->opener.running && glfwGetTime() - looked > LOOK_AGAIN) {
            reload_when_changed(w);
            looked = glfwGetTime();
        }
    }
    return true;
}

int window_open(const preview_options *options, view_window *w, pps_problem *problem) {
    *w = (view_window){.settings = {.options = *options, .split_at = 0.5}};
    note_file_time(w);
    pps_scene *scene = scene_for(options, problem); /* broken: no window opens */
    if (!scene) {
        return EXIT_USAGE;
    }
    if (!open_window(w, problem) || !prepare(w, problem)) {
        pps_scene_free(scene);
        return EXIT_FAILED;
    }
    w->opening.settings = w->settings;
    w->opening.fit = true;
    start_opening(w, scene);
    w->dirty = true;
    return EXIT_DONE;
}

void window_close(view_window *w) {
    if (w->window) {
        glfwHideWindow(w->window); /* at once; the thread may take a while */
        glfwPollEvents();
        opener_end(&w->opener);
        pair_close(&w->stages);
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
    if (!w) {
        strcpy(problem->text, "out of memory");
        return EXIT_FAILED;
    }
    int rc = window_open(options, w, problem);
    if (rc == EXIT_DONE && !loop(w, problem)) {
        rc = EXIT_FAILED;
    }
    window_close(w);
    free(w);
    return rc;
}
