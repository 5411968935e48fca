/* Work on a stage without a window: open, do, close.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_OFFSCREEN_H
#define PREVIEW_OFFSCREEN_H

#include "preview/options.h"

/* What is done with an open stage; an exit code, and its problem. */
typedef int offscreen_work(stage *s, const preview_options *options,
                           pps_problem *problem);

/* Open the scene, OpenGL and the stage that the options ask for, work, close all. */
int offscreen_run(const preview_options *options, offscreen_work *work,
                  pps_problem *problem);

#endif
