/* A camera as OpenGL needs it, and what it sees.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_STAGE_VIEW_H
#define PREVIEW_STAGE_VIEW_H

#include <ppscat/tree/picture.h>

/* The camera's axes, and the matrix from the scene to clip space. */
typedef struct {
    double eye[3];
    double right[3], up[3], back[3], tangent, aspect;
    float to_clip[16]; /* by columns */
} view;

/* Near and far planes lie about a box, that of the scene. */
void view_set(const pps_box *box, const pps_camera *camera, double aspect, view *v);

/* Whether any of a ball may be in view; off: its middle, from the eye. */
bool view_has(const view *v, const double off[3], double radius);

#endif
