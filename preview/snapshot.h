/* One frame into a file, without a window.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_SNAPSHOT_H
#define PREVIEW_SNAPSHOT_H

#include "preview/options.h"

/* Draw a stage as the options say; NULL: the problem. The caller frees the picture. */
pps_picture *snapshot_draw(stage *s, const preview_options *options,
                           pps_problem *problem);

/* Open OpenGL and the scene, draw, write. An exit code, and its problem. */
int snapshot_run(const preview_options *options, pps_problem *problem);

#endif
