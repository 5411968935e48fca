/* A camera that goes round what it looks at.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_ORBIT_H
#define PREVIEW_ORBIT_H

#include <ppscat/tree/picture.h>

/* Degrees, as in pps_camera_fit; metres. */
typedef struct {
    double azimuth, elevation, distance, target[3], field_of_view;
} orbit;

/* As pps_camera_fit stands. */
void orbit_fit(orbit *o, const pps_scene *scene, double azimuth, double elevation,
               double aspect);
void orbit_camera(const orbit *o, pps_camera *out);

/* Turn by degrees; move the target by shares of the picture's height; come nearer by a
 * factor. The eye never goes under `floor` metres of height. */
void orbit_turn(orbit *o, double azimuth, double elevation, double floor);
void orbit_pan(orbit *o, double right, double up);
void orbit_zoom(orbit *o, double factor);

#endif
