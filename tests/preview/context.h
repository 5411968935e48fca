/* What tests of the stage share: OpenGL without a display, a scene, options.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_PREVIEW_CONTEXT_H
#define TESTS_PREVIEW_CONTEXT_H

#include "preview/options.h"

/* Setup and teardown of a group. */
int context_setup(void **state);
int context_teardown(void **state);

/* Three crowns of flat leaves, turned and scaled, over a ground. */
pps_scene *three_crowns(void);

/* Of a picture of them, one sample a pixel, maps of the library's size. */
enum { CROWNS_WIDTH = 240, CROWNS_HEIGHT = 200 };
preview_options crowns_options(const char *model, unsigned sources);

/* Open a stage; the test fails if it cannot be. Close it, and free its scene. */
stage *stage_for(pps_scene *scene, const preview_options *options);
void stage_done(stage *s);

#endif
