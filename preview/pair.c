/* A scene, and a stage for each model that lights it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/pair.h"

bool pair_open(pps_scene *scene, const preview_options *options, stage_pair *out,
               pps_problem *problem) {
    *out = (stage_pair){scene, {NULL, NULL}};
    for (int i = 0; i < (options->split ? 2 : 1); i++) {
        out->of[i] = stage_open(scene, i ? &options->second : &options->stage, problem);
        if (!out->of[i]) {
            pair_close(out);
            return false;
        }
    }
    return true;
}

void pair_close(stage_pair *pair) {
    stage_close(pair->of[0]);
    stage_close(pair->of[1]);
    pps_scene_free(pair->scene);
    *pair = (stage_pair){NULL, {NULL, NULL}};
}

void pair_draw(const stage_pair *pair, int at, const pps_camera *camera, int width,
               int height, const stage_look *look) {
    if (!pair->of[1]) {
        stage_draw(pair->of[0], camera, width, height, look);
        return;
    }
    glEnable(GL_SCISSOR_TEST); /* it holds for clearing too */
    glScissor(0, 0, at, height);
    stage_draw(pair->of[0], camera, width, height, look);
    glScissor(at, 0, width - at, height);
    stage_draw(pair->of[1], camera, width, height, look);
    glDisable(GL_SCISSOR_TEST);
}
