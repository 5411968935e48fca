/* A scene, a context and a stage for as long as the work takes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/offscreen.h"

#include "preview/headless.h"
#include "preview/stage_open.h"

int offscreen_run(const preview_options *options, offscreen_work *work,
                  pps_problem *problem) {
    pps_scene *scene = scene_for(options, problem);
    if (!scene) {
        return EXIT_USAGE;
    }
    headless *context = headless_open(problem);
    if (!context) {
        pps_scene_free(scene);
        return EXIT_FAILED;
    }
    stage *s = stage_open(scene, &options->stage, problem);
    int rc = s ? work(s, options, problem) : EXIT_FAILED;
    stage_close(s);
    headless_close(context);
    return rc;
}
