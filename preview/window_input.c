/* Keys, mouse, and files dropped on the window.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "preview/window_own.h"

enum { NEAR_LINE = 6, LESS = 26 }; /* pixels; letters before the '<' of a row */

static void change(view_window *w, const setting *row, int step) {
    settings before = w->settings;
    w->note[0] = w->settings.note[0] = '\0';
    window_apply(w, row->change(&w->settings, step), &before);
}

/* ---- keys ---- */

static void reset_albedo(view_window *w) {
    settings before = w->settings;
    for (int b = 0; b < PPS_BANDS_MAX; b++) {
        w->settings.options.albedo[b] = (double)NAN;
    }
    window_apply(w, EFFECT_OPEN, &before);
}

static void press(view_window *w, int key) {
    switch (key) {
    case GLFW_KEY_TAB:
        w->bare = !w->bare;
        break;
    case GLFW_KEY_0:
        reset_albedo(w);
        break;
    case GLFW_KEY_HOME:
        window_start_view(w);
        break;
    case GLFW_KEY_S:
        w->save = true; /* of the next frame, with all that moved until now */
        break;
    case GLFW_KEY_R:
        window_load(w, true, NULL, NULL);
        break;
    case GLFW_KEY_H:
        w->help = !w->help;
        break;
    case GLFW_KEY_Q:
    case GLFW_KEY_ESCAPE:
        glfwSetWindowShouldClose(w->window, GLFW_TRUE);
        break;
    default:
        break;
    }
}

/* Keys that need no scene: they count while the first is being opened. */
static bool is_early(int key) {
    return key == GLFW_KEY_Q || key == GLFW_KEY_ESCAPE || key == GLFW_KEY_S;
}

static void on_key(GLFWwindow *window, int key, int code, int action, int mods) {
    view_window *w = glfwGetWindowUserPointer(window);
    int step;
    (void)code;
    if (action == GLFW_RELEASE || (!w->stages.of[0] && !is_early(key))) {
        return;
    }
    const setting *row = setting_of_key(key, mods & GLFW_MOD_SHIFT, &step);
    w->dirty = true;
    w->note[0] = '\0';
    if (row) {
        change(w, row, step);
    } else {
        press(w, key);
    }
}

/* ---- mouse ---- */

/* Pixels of the frame for one of the window's units. */
static double pixel_ratio(GLFWwindow *window) {
    int width, unit;
    glfwGetFramebufferSize(window, &width, NULL);
    glfwGetWindowSize(window, &unit, NULL);
    return unit > 0 ? (double)width / unit : 1;
}

/* The setting under the cursor, and which half of its value; NULL: none. */
static const setting *under_cursor(view_window *w, int *step) {
    double ratio = pixel_ratio(w->window);
    int line, column;
    if (w->bare || w->help ||
        !panel_at(&w->settings_place, w->scale, w->last[0] * ratio, w->last[1] * ratio,
                  &line, &column)) {
        return NULL;
    }
    for (int i = 0; i <= line; i++) {
        if (!settings_table[i].keys) {
            return NULL;
        }
    }
    *step = abs(column - LESS) <= 1 ? -1 : 1;
    return line < 0 ? NULL : &settings_table[line];
}

static bool on_split(const view_window *w) {
    int width;
    glfwGetWindowSize(w->window, &width, NULL);
    return w->stages.of[1] &&
           fabs(w->last[0] - w->settings.split_at * width) < NEAR_LINE;
}

static void on_button(GLFWwindow *window, int button, int action, int mods) {
    view_window *w = glfwGetWindowUserPointer(window);
    bool shift = mods & GLFW_MOD_SHIFT;
    int step;
    drag was = w->drag;
    if (!w->stages.of[0]) {
        return;
    }
    w->dirty = true;
    w->drag = DRAG_NONE;
    if (action != GLFW_PRESS) { /* what was coarse while it moved becomes fine */
        w->sun_moved = w->sun_moved || was == DRAG_SUN || was == DRAG_TIME;
        return;
    }
    const setting *row = under_cursor(w, &step);
    if (row && button == GLFW_MOUSE_BUTTON_LEFT) {
        change(w, row, step);
    } else if (button == GLFW_MOUSE_BUTTON_LEFT) {
        w->drag = on_split(w) ? DRAG_SPLIT : shift ? DRAG_PAN : DRAG_VIEW;
    } else if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        w->drag = shift ? DRAG_TIME : DRAG_SUN;
    } else {
        w->drag = on_split(w) ? DRAG_SPLIT : DRAG_PAN;
    }
}

/* By shares of the window. */
static void move(view_window *w, double x, double y, double aspect) {
    const pps_ground *ground = &w->stages.scene->ground;
    settings before = w->settings;
    switch (w->drag) {
    case DRAG_VIEW:
        orbit_turn(&w->orbit, -180 * x, 180 * y,
                   ground->present ? ground->height + 0.2 : -1e9);
        break;
    case DRAG_PAN:
        orbit_pan(&w->orbit, -x, y);
        break;
    case DRAG_SUN:
        window_apply(w, settings_turn_sun(&w->settings, -180 * x, -90 * y), &before);
        break;
    case DRAG_TIME:
        window_apply(w, settings_pass_time(&w->settings, 12 * x), &before);
        break;
    case DRAG_SPLIT:
        w->settings.split_at = fmin(fmax(w->settings.split_at + x / aspect, 0), 1);
        break;
    case DRAG_NONE:
        return;
    }
    w->dirty = true;
}

static void on_move(GLFWwindow *window, double x, double y) {
    view_window *w = glfwGetWindowUserPointer(window);
    int width, height;
    glfwGetWindowSize(window, &width, &height);
    double dx = x - w->last[0], dy = y - w->last[1];
    w->last[0] = x;
    w->last[1] = y;
    if (w->stages.of[0] && height > 0) {
        move(w, dx / height, dy / height, (double)width / height);
    }
}

static void on_wheel(GLFWwindow *window, double x, double y) {
    view_window *w = glfwGetWindowUserPointer(window);
    int step;
    (void)x;
    if (!w->stages.of[0]) {
        return;
    }
    const setting *row = under_cursor(w, &step);
    if (row && y != 0) {
        change(w, row, y > 0 ? 1 : -1);
    } else {
        orbit_zoom(&w->orbit, pow(1.1, y));
    }
    w->dirty = true;
}

/* ---- the window ---- */

static void on_drop(GLFWwindow *window, int n, const char **path) {
    view_window *w = glfwGetWindowUserPointer(window);
    if (n > 0 && strlen(path[0]) < sizeof w->scene_path) {
        window_load(w, false, NULL, path[0]);
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

void window_listen(view_window *w) {
    glfwSetWindowUserPointer(w->window, w);
    glfwSetKeyCallback(w->window, on_key);
    glfwSetCursorPosCallback(w->window, on_move);
    glfwSetMouseButtonCallback(w->window, on_button);
    glfwSetScrollCallback(w->window, on_wheel);
    glfwSetDropCallback(w->window, on_drop);
    glfwSetFramebufferSizeCallback(w->window, on_change);
    glfwSetWindowRefreshCallback(w->window, on_uncovered);
}
