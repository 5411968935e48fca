/* What the window shows: scenes, opened in a thread of their own while the window goes on, and
 * settings that change their light.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "preview/stage_open.h"
#include "preview/window_own.h"

enum { FEWER_RAYS = 20 }; /* of Monte Carlo while the sun is dragged */

/* ---- the scene ---- */

const char *window_scene_path(const view_window *w) {
    return w->scene_path[0] ? w->scene_path : w->settings.options.scene;
}

static void note_file_time(view_window *w) {
    struct stat about;
    if (window_scene_path(w) && stat(window_scene_path(w), &about) == 0) {
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
    stage_options sppg = w->settings.options.stage;
    pps_problem problem;
    read_albedo(w);
    w->settings.any_model =
        options_model("sppg", &sppg) && stage_takes(w->stages.scene, &sppg, &problem);
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
    options.scene = window_scene_path(w);
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
        snprintf(w->scene_path, sizeof w->scene_path, "%s", path);
        o->fit = true;
    }
    if (!w->opener.running) {
        start_opening(w, NULL);
    }
}

/* To what is there still; the sun and the camera are where they have been moved to. */
static void go_back(view_window *w, const pps_problem *problem) {
    const preview_options *was = &w->opening.settings.options;
    preview_options *now = &w->settings.options;
    w->sun_moved = w->sun_moved || was->stage.sources != now->stage.sources;
    now->stage = was->stage;
    now->second = was->second;
    now->split = was->split;
    memcpy(now->albedo, was->albedo, sizeof now->albedo);
    memcpy(w->scene_path, w->opening.scene_path, sizeof w->scene_path);
    snprintf(w->note, sizeof w->note, "%s", problem->text);
}

/* NaN is like NaN: an albedo that is the scene's. */
static bool alike(const double *a, const double *b, int n) {
    for (int i = 0; i < n; i++) {
        if (a[i] != b[i] && !(isnan(a[i]) && isnan(b[i]))) {
            return false;
        }
    }
    return true;
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
    if (!alike(then->albedo, now->albedo, PPS_BANDS_MAX)) {
        light_leaves(w);
        read_albedo(w);
    }
    w->sun_moved = w->sun_moved || then->stage.sources != now->stage.sources ||
                   (w->opening.keep && !alike(then->sun, before.sun, 2));
    if (w->opening.fit) {
        window_start_view(w);
    }
    warn(w);
}

pps_scene *window_read(view_window *w, pps_problem *problem) {
    note_file_time(w);
    return scene_for(&w->settings.options, problem);
}

void window_begin(view_window *w, pps_scene *scene) {
    w->opening = (opening){.settings = w->settings, .fit = true};
    start_opening(w, scene);
    w->dirty = true;
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

void window_reload(view_window *w) {
    struct stat about;
    if (window_scene_path(w) && stat(window_scene_path(w), &about) == 0 &&
        (about.st_mtim.tv_sec != w->changed.tv_sec ||
         about.st_mtim.tv_nsec != w->changed.tv_nsec)) {
        window_load(w, false, NULL, NULL);
    }
}

/* ---- settings ---- */

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

bool window_light_sun(view_window *w, pps_problem *problem) {
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
