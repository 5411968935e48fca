/* Two stages of one scene each their own, for their light differs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/pair.h"

#include "preview/stage_open.h"

bool pair_open(const preview_options *options, stage_pair *out, int *rc,
               pps_problem *problem) {
    *out = (stage_pair){{NULL, NULL}};
    for (int i = 0; i < (options->split ? 2 : 1); i++) {
        pps_scene *scene = scene_for(options, problem);
        *rc = scene ? EXIT_FAILED : EXIT_USAGE;
        out->of[i] =
            scene ? stage_open(scene, i ? &options->second : &options->stage, problem)
                  : NULL;
        if (!out->of[i]) {
            pair_close(out);
            return false;
        }
    }
    return true;
}

void pair_close(stage_pair *pair) {
    for (int i = 0; i < 2; i++) {
        stage_close(pair->of[i]);
        pair->of[i] = NULL;
    }
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
