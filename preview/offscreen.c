/* A context and stages for as long as the work takes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/offscreen.h"

#include <stdio.h>

#include "preview/headless.h"
#include "preview/stage_open.h"

int offscreen_run(const preview_options *options, offscreen_work *work,
                  pps_problem *problem) {
    stage_pair pair;
    char warning[200];
    int rc = EXIT_FAILED;
    pps_scene *scene =
        scene_for(options, problem); /* broken: the driver is not asked */
    if (!scene) {
        return EXIT_USAGE;
    }
    headless *context = headless_open(problem);
    if (!context) {
        pps_scene_free(scene);
    } else if (pair_open(scene, options, &pair, problem)) {
        if (leaves_too_large(pair.of[0], warning, sizeof warning)) {
            fprintf(stderr, "ppscat-preview: %s\n", warning);
        }
        rc = work(&pair, options, problem);
        pair_close(&pair);
    }
    headless_close(context);
    return rc;
}
