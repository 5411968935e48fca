/* Axes, the matrix to clip space, and the view's four sides.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/stage_view.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static void normalize(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3 && length > 0; i++) {
        v[i] /= length;
    }
}

/* Near and far planes about the whole scene. */
static void depth_range(const pps_box *all, const pps_camera *camera,
                        const double back[3], double *near, double *far) {
    double most = 0;
    for (int corner = 0; corner < 8; corner++) {
        double off[3];
        for (int i = 0; i < 3; i++) {
            off[i] = (corner >> i & 1 ? all->high[i] : all->low[i]) - camera->eye[i];
        }
        most = fmax(most, -dot(off, back));
    }
    *far = fmax(4 * most, 100);
    *near = fmax(most / 1000, 0.02);
}

void view_set(const pps_box *box, const pps_camera *camera, double aspect, view *v) {
    double near, far;
    for (int i = 0; i < 3; i++) {
        v->eye[i] = camera->eye[i];
        v->back[i] = camera->eye[i] - camera->target[i];
    }
    normalize(v->back);
    cross(camera->up, v->back, v->right);
    normalize(v->right);
    cross(v->back, v->right, v->up);
    v->tangent = tan(camera->field_of_view * PI / 360);
    v->aspect = aspect;
    depth_range(box, camera, v->back, &near, &far);
    const double *row[] = {v->right, v->up, v->back};
    const double scale[] = {1 / (v->tangent * aspect), 1 / v->tangent,
                            (far + near) / (near - far)};
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            /* In front of the eye `back` is negative, clip z and w grow. */
            v->to_clip[4 * c + r] = (float)(scale[r] * row[r][c]);
            v->to_clip[4 * c + 3] = (float)-v->back[c];
        }
        v->to_clip[12 + r] = (float)(-scale[r] * dot(row[r], camera->eye));
    }
    v->to_clip[14] += (float)(2 * far * near / (near - far));
    v->to_clip[15] = (float)dot(v->back, camera->eye);
}

/* A ball against the four sides of the view and the eye's plane. */
bool view_has(const view *v, const double off[3], double radius) {
    double ahead = -dot(off, v->back);
    double half[] = {v->tangent * v->aspect, v->tangent};
    double side[] = {fabs(dot(off, v->right)), fabs(dot(off, v->up))};
    bool in = ahead > -radius;
    for (int i = 0; i < 2; i++) {
        in = in && side[i] - half[i] * ahead < radius * sqrt(1 + half[i] * half[i]);
    }
    return in;
}
