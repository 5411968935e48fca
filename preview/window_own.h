/* What the files of the window share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_WINDOW_OWN_H
#define PREVIEW_WINDOW_OWN_H

#include <time.h>

#define GLFW_INCLUDE_NONE
#include <epoxy/gl.h>

#include <GLFW/glfw3.h>

#include "preview/frame.h"
#include "preview/orbit.h"
#include "preview/pair.h"
#include "preview/panel.h"
#include "preview/settings.h"

typedef enum { DRAG_NONE, DRAG_VIEW, DRAG_PAN, DRAG_SUN, DRAG_TIME, DRAG_SPLIT } drag;

typedef struct {
    GLFWwindow *window;
    settings settings;
    char scene_path[4096]; /* of a dropped file */
    stage_pair stages;
    orbit orbit;
    frame fine, coarse;
    GLuint tone, empty;
    panel panel;
    panel_place settings_place;              /* as drawn last */
    int scale;                               /* pixels a dot of letters */
    bool help, bare, dirty, sun_moved, save; /* bare: without the panel of settings */
    drag drag;
    double last[2]; /* place of the cursor, as its last event had it */
    double frame_seconds;
    struct timespec changed; /* of the scene's file */
    char warning[200], note[600];
    int pictures;
} view_window;

/* Open it with the scene that options ask for. An exit code, its problem: EXIT_USAGE where
 * the scene is to blame. To be closed in any case. */
int window_open(const preview_options *options, view_window *w, pps_problem *problem);
void window_close(view_window *w);

/* Draw a frame of what is there now, and what is written over it. */
bool window_draw(view_window *w, pps_problem *problem);

/* Read the scene and light it, the sun staying where it is if `keep`. On failure what was
 * there stays, and a note tells why. */
bool window_load(view_window *w, bool keep);

/* Do what a changed setting asks for; `before` is gone back to where that fails. */
void window_apply(view_window *w, setting_effect effect, const settings *before);

/* The camera as at the start. */
void window_start_view(view_window *w);

/* Let the window call us: keys, mouse, files dropped on it. */
void window_listen(view_window *w);

#endif
