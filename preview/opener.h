/* Opening scenes in a thread of its own, so that the window goes on meanwhile.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_OPENER_H
#define PREVIEW_OPENER_H

#include <pthread.h>

#include "preview/pair.h"

/* Fields are the caller's to read where running is false; while it is true, only those of
 * progress are. */
typedef struct {
    bool running;
    preview_options options; /* what is opened */
    char path[4096];         /* of its scene, where it has one */
    pps_scene *scene;        /* given, or read by the thread; until it is the pair's */
    stage_pair pair;         /* what came of it, not yet uploaded */
    bool good;               /* else the pair is closed, and a problem is there */
    pps_problem problem;
    stage_progress progress;
    void (*tell)(void); /* called by the thread at its end */
    bool threaded;
    pthread_t thread;
    atomic_bool done;
} opener;

/* Begin: with the scene that is given, or (NULL) that of the options. */
void opener_start(opener *o, const preview_options *options, pps_scene *scene,
                  void (*tell)(void));

/* Whether it has just come to its end: the pair is then the caller's, if good. */
bool opener_finished(opener *o);

/* What is opened is not wanted any more: come to the end early, but do not wait for it. */
void opener_cancel(opener *o);

/* The same, waiting; nothing is left of it. */
void opener_end(opener *o);

/* "cells", "light of the sun, 43 %", .. */
void opener_write(const opener *o, char *out, size_t size);

#endif
