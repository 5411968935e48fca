/* A camera that has the whole scene in its frame.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include <ppscat/tree/picture.h>

#include "tree/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;
static const double FIELD_OF_VIEW = 30, MARGIN = 1.05;

/* The frame's four edges are planes through the eye. In the camera's axes (right, up, back)
 * a point is inside the right one where x + t z <= e_x + t e_z, t the tangent of the half
 * angle, and so on around: the farthest point for each plane decides. */
typedef struct {
    double right, left, top, bottom; /* max of x + t z, -x + t z, y + s z, -y + s z */
    double middle[2];                /* least and most z */
} extent;

static void widen(extent *e, const double p[3], double across, double up) {
    e->right = fmax(e->right, p[0] + across * p[2]);
    e->left = fmax(e->left, -p[0] + across * p[2]);
    e->top = fmax(e->top, p[1] + up * p[2]);
    e->bottom = fmax(e->bottom, -p[1] + up * p[2]);
    e->middle[0] = fmin(e->middle[0], p[2]);
    e->middle[1] = fmax(e->middle[1], p[2]);
}

void pps_camera_fit(const pps_scene *scene, double azimuth, double elevation,
                    double aspect, pps_camera *camera) {
    double a = azimuth * DEGREE, e = elevation * DEGREE;
    /* Right, up, and back towards the eye; up tips over with the view from above. */
    const double axis[3][3] = {{-sin(a), cos(a), 0},
                               {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)},
                               {cos(e) * cos(a), cos(e) * sin(a), sin(e)}};
    double up = tan(FIELD_OF_VIEW / 2 * DEGREE) / MARGIN, across = up * aspect;
    extent all = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, {INFINITY, -INFINITY}};
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_mesh *mesh = scene->prototype[scene->instance[k].prototype].mesh;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            double p[3], own[3];
            pps_instance_point(&scene->instance[k], mesh->position[v], p);
            for (int i = 0; i < 3; i++) {
                own[i] = vec_dot(axis[i], p);
            }
            widen(&all, own, across, up);
        }
    }
    double x = (all.right - all.left) / 2, y = (all.top - all.bottom) / 2;
    double back =
        fmax((all.right + all.left) / (2 * across), (all.top + all.bottom) / (2 * up));
    double middle = (all.middle[0] + all.middle[1]) / 2;
    *camera = (pps_camera){.field_of_view = FIELD_OF_VIEW};
    for (int i = 0; i < 3; i++) {
        double off_axis = x * axis[0][i] + y * axis[1][i];
        camera->target[i] = off_axis + middle * axis[2][i];
        camera->eye[i] = off_axis + back * axis[2][i];
    }
    memcpy(camera->up, axis[1], sizeof camera->up);
}
