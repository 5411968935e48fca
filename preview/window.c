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
    const char *scene = window_scene_path(w);
    char step[60];
    opener_write(&w->opener, step, sizeof step);
    snprintf(text, size, "opening %.200s: %s", scene ? scene : "a grove", step);
}

static size_t write_steps(const stage *s, char *text, size_t size) {
    const double *t = s->seconds;
    return (size_t)snprintf(
        text, size,
        "\n%s, ms: 1 cells %.0f, 2 maps %.0f, 3 G %.0f, 4 sky %.0f, 5 sun %.0f + %.0f",
        options_model_name(&s->options), 1000 * t[0], 1000 * t[1], 1000 * t[2],
        1000 * t[3], 1000 * t[4], 1000 * t[5]);
}

static void write_times(const view_window *w, char *text, size_t size) {
    const stage *first = w->stages.of[0], *second = w->stages.of[1];
    size_t used =
        (size_t)snprintf(text, size, "frame %.0f ms", 1000 * w->frame_seconds);
    used += write_steps(first, text + used, size - used);
    if (second) {
        used += write_steps(second, text + used, size - used);
    }
    used += (size_t)snprintf(text + used, size - used,
                             "\n%zu triangles; h: help, Tab: no panel%s%s%s%s",
                             first->n_triangles, w->warning[0] ? "\n" : "", w->warning,
                             w->note[0] ? "\n" : "", w->note);
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
    if ((w->sun_moved && !window_light_sun(w, problem)) ||
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
            window_reload(w);
            looked = glfwGetTime();
        }
    }
    return true;
}

int window_open(const preview_options *options, view_window *w, pps_problem *problem) {
    *w = (view_window){.settings = {.options = *options, .split_at = 0.5}};
    pps_scene *scene = window_read(w, problem); /* broken: no window opens */
    if (!scene) {
        return EXIT_USAGE;
    }
    if (!open_window(w, problem) || !prepare(w, problem)) {
        pps_scene_free(scene);
        return EXIT_FAILED;
    }
    window_begin(w, scene);
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
