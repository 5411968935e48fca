/* A scene, and a stage for each model that lights it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/pair.h"

bool pair_create(pps_scene *scene, const preview_options *options, stage_pair *out,
                 pps_problem *problem) {
    *out = (stage_pair){scene, {NULL, NULL}};
    out->of[0] = stage_create(scene, &options->stage, problem);
    if (options->split) {
        out->of[1] = stage_create(scene, &options->second, problem);
    }
    return out->of[0] && (out->of[1] || !options->split);
}

bool pair_prepare(const stage_pair *pair, pps_problem *problem) {
    return stage_prepare(pair->of[0], problem) &&
           (!pair->of[1] || stage_prepare(pair->of[1], problem));
}

bool pair_upload(const stage_pair *pair, pps_problem *problem) {
    return stage_upload(pair->of[0], problem) &&
           (!pair->of[1] || stage_upload(pair->of[1], problem));
}

bool pair_open(pps_scene *scene, const preview_options *options, stage_pair *out,
               pps_problem *problem) {
    if (pair_create(scene, options, out, problem) && pair_prepare(out, problem) &&
        pair_upload(out, problem)) {
        return true;
    }
    pair_close(out);
    return false;
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
