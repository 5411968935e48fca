/* One picture by one stage, or by two of the same scene, side by side in the same view.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_PAIR_H
#define PREVIEW_PAIR_H

#include "preview/options.h"

/* The second is NULL where there is one alone. */
typedef struct {
    pps_scene *scene; /* of both; the pair's own */
    stage *of[2];
} stage_pair;

/* Open the stages that options ask for, and take the scene; false: the problem, and nothing
 * is left open, the scene neither. */
bool pair_open(pps_scene *scene, const preview_options *options, stage_pair *out,
               pps_problem *problem);
void pair_close(stage_pair *pair);

/* The same in its parts (stage.h): take the scene and make room; what may have a thread of
 * its own; the rest. A pair whose part has failed is to be closed. */
bool pair_create(pps_scene *scene, const preview_options *options, stage_pair *out,
                 pps_problem *problem);
bool pair_prepare(const stage_pair *pair, pps_problem *problem);
bool pair_upload(const stage_pair *pair, pps_problem *problem);

/* Draw into the bound frame buffer: the first left of column `at`, the second from there. */
void pair_draw(const stage_pair *pair, int at, const pps_camera *camera, int width,
               int height, const stage_look *look);

#endif
