/* An OpenGL context without a display or window: EGL, surfaceless.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_HEADLESS_H
#define PREVIEW_HEADLESS_H

#include <ppscat/tree/mesh.h>

typedef struct headless headless;

/* Make a context and make it current; NULL: the problem says why there is none. */
headless *headless_open(pps_problem *problem);
void headless_close(headless *context); /* NULL is fine */

#endif
