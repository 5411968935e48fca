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
#include "preview/opener.h"
#include "preview/orbit.h"
#include "preview/pair.h"
#include "preview/panel.h"
#include "preview/settings.h"

typedef enum { DRAG_NONE, DRAG_VIEW, DRAG_PAN, DRAG_SUN, DRAG_TIME, DRAG_SPLIT } drag;

enum { PATH = 4096 };

/* What is gone back to where opening fails, and what else is to be done when it is through. */
typedef struct {
    settings settings;
    char scene_path[PATH];
    bool keep;  /* the sun stays where it is */
    bool fit;   /* the camera starts anew */
    bool again; /* meanwhile something else was asked for: begin from the start */
} opening;

typedef struct {
    GLFWwindow *window;
    settings settings;
    char scene_path[PATH]; /* of a dropped file */
    stage_pair stages;     /* none before the first are open */
    opener opener;
    opening opening;
    orbit orbit;
    frame fine, coarse;
    const frame *shown; /* one of these, as drawn last; NULL: none yet */
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

/* Open it, and begin to open the scene that options ask for. An exit code, its problem:
 * EXIT_USAGE where the scene is to blame. To be closed in any case. */
int window_open(const preview_options *options, view_window *w, pps_problem *problem);
void window_close(view_window *w);

/* Draw a frame of what is there now, and what is written over it; or show the last one with
 * what is written now. */
bool window_draw(view_window *w, pps_problem *problem);
void window_show(view_window *w);

/* The file or name of the scene; NULL: the grove. */
const char *window_scene_path(const view_window *w);

/* Before there is a window: read the scene that the options name (NULL: the problem), and
 * then begin to open it. */
pps_scene *window_read(view_window *w, pps_problem *problem);
void window_begin(view_window *w, pps_scene *scene);

/* Begin to read the scene, of `path` if one is given, and to light it, the sun staying where
 * it is if `keep`. Until that is done what is there stays; where it fails, so it does, with
 * the settings that were `before` (NULL: as they are), and a note tells why. */
void window_load(view_window *w, bool keep, const settings *before, const char *path);

/* To be called now and then: take what has been opened. False: there is nothing to show, and
 * the problem. */
bool window_take(view_window *w, pps_problem *problem);

/* To be called now and then: read the scene anew if its file has changed. */
void window_reload(view_window *w);

/* Find the sun's light where it stands now, on what is there. */
bool window_light_sun(view_window *w, pps_problem *problem);

/* Do what a changed setting asks for; `before` is gone back to where that fails. */
void window_apply(view_window *w, setting_effect effect, const settings *before);

/* The camera as at the start. */
void window_start_view(view_window *w);

/* Let the window call us: keys, mouse, files dropped on it. */
void window_listen(view_window *w);

#endif
