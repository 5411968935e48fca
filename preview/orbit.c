/* Angles, distance and target, and the pinhole that they make.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/orbit.h"

#include <math.h>
#include <string.h>

static const double DEGREE = 3.14159265358979323846 / 180;

/* Right, up, and back towards the eye. */
static void axes(const orbit *o, double axis[3][3]) {
    double a = o->azimuth * DEGREE, e = o->elevation * DEGREE;
    const double right[3] = {-sin(a), cos(a), 0};
    const double up[3] = {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)};
    const double back[3] = {cos(e) * cos(a), cos(e) * sin(a), sin(e)};
    memcpy(axis[0], right, sizeof right);
    memcpy(axis[1], up, sizeof up);
    memcpy(axis[2], back, sizeof back);
}

void orbit_fit(orbit *o, const pps_scene *scene, double azimuth, double elevation,
               double aspect) {
    pps_camera camera;
    double square = 0;
    pps_camera_fit(scene, azimuth, elevation, aspect, &camera);
    *o = (orbit){.azimuth = azimuth,
                 .elevation = elevation,
                 .field_of_view = camera.field_of_view};
    for (int i = 0; i < 3; i++) {
        o->target[i] = camera.target[i];
        square += pow(camera.eye[i] - camera.target[i], 2);
    }
    o->distance = sqrt(square);
}

void orbit_camera(const orbit *o, pps_camera *out) {
    double axis[3][3];
    axes(o, axis);
    *out = (pps_camera){.field_of_view = o->field_of_view};
    for (int i = 0; i < 3; i++) {
        out->target[i] = o->target[i];
        out->eye[i] = o->target[i] + o->distance * axis[2][i];
        out->up[i] = axis[1][i];
    }
}

void orbit_turn(orbit *o, double azimuth, double elevation, double floor) {
    double sine = (floor - o->target[2]) / o->distance;
    double least = sine > -1 ? asin(fmin(sine, 1)) / DEGREE : -89;
    o->azimuth = remainder(o->azimuth + azimuth, 360);
    o->elevation = fmin(fmax(o->elevation + elevation, fmax(least, -89)), 89);
}

void orbit_pan(orbit *o, double right, double up) {
    double axis[3][3], height = 2 * o->distance * tan(o->field_of_view * DEGREE / 2);
    axes(o, axis);
    for (int i = 0; i < 3; i++) {
        o->target[i] += height * (right * axis[0][i] + up * axis[1][i]);
    }
}

void orbit_zoom(orbit *o, double factor) {
    o->distance = fmin(fmax(o->distance / factor, 0.05), 1e5);
}
