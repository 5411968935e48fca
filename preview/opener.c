/* A thread reads a scene and does all that needs no OpenGL.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/opener.h"

#include <stdio.h>

#include "preview/stage_open.h"

static void work(opener *o) {
    pps_scene *scene = o->scene ? o->scene : scene_for(&o->options, &o->problem);
    o->scene = NULL;
    o->pair = (stage_pair){scene, {NULL, NULL}};
    o->good = scene && pair_create(scene, &o->options, &o->pair, &o->problem) &&
              pair_prepare(&o->pair, &o->problem);
}

static void *run(void *user) {
    opener *o = user;
    work(o);
    atomic_store(&o->done, true);
    o->tell();
    return NULL;
}

void opener_start(opener *o, const preview_options *options, pps_scene *scene,
                  void (*tell)(void)) {
    *o = (opener){.options = *options, .scene = scene, .tell = tell};
    atomic_init(&o->progress.step, 0);
    atomic_init(&o->progress.percent, -1);
    atomic_init(&o->progress.cancelled, false);
    atomic_init(&o->done, false);
    o->options.stage.progress = o->options.second.progress = &o->progress;
    if (options->scene) {
        snprintf(o->path, sizeof o->path, "%s", options->scene);
        o->options.scene = o->path;
    }
    o->running = true;
    o->threaded = pthread_create(&o->thread, NULL, run, o) == 0;
    if (!o->threaded) {
        run(o);
    }
}

static void join(opener *o) {
    if (o->threaded) {
        pthread_join(o->thread, NULL);
    }
    o->running = false;
}

bool opener_finished(opener *o) {
    if (!o->running || !atomic_load(&o->done)) {
        return false;
    }
    join(o);
    if (!o->good) {
        pair_close(&o->pair);
    }
    return true;
}

void opener_cancel(opener *o) { atomic_store(&o->progress.cancelled, true); }

void opener_end(opener *o) {
    if (o->running) {
        opener_cancel(o);
        join(o);
        pair_close(&o->pair);
    }
}

void opener_write(const opener *o, char *out, size_t size) {
    static const char *const step[] = {
        "scene", "cells", "maps", "G-factor", "light of the sky", "light of the sun"};
    int percent = atomic_load(&o->progress.percent);
    int used = snprintf(out, size, "%s", step[atomic_load(&o->progress.step)]);
    if (percent >= 0 && (size_t)used < size) {
        snprintf(out + used, size - (size_t)used, ", %d %%", percent);
    }
}
