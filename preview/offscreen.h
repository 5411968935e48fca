/* Work on stages without a window: open, do, close.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_OFFSCREEN_H
#define PREVIEW_OFFSCREEN_H

#include "preview/pair.h"

/* What is done with open stages; an exit code, and its problem. */
typedef int offscreen_work(const stage_pair *pair, const preview_options *options,
                           pps_problem *problem);

/* Open OpenGL, and the scene and stages that the options ask for, work, close all. */
int offscreen_run(const preview_options *options, offscreen_work *work,
                  pps_problem *problem);

#endif
