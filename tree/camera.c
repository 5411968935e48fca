/* A camera that has the whole scene in its frame.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include <ppscat/tree/picture.h>

#include "tree/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;
static const double FIELD_OF_VIEW = 30, MARGIN = 1.06;

/* How far back from the target a pinhole must stand along `back` to have a point in its
 * frame: by the point's height and width there, and its own place along the way. */
static double distance_for(const double p[3], const double target[3],
                           const double axis[3][3], double tangent, double aspect) {
    double from[3];
    vec_sub(p, target, from);
    double wide = fabs(vec_dot(from, axis[0])) / (tangent * aspect);
    double high = fabs(vec_dot(from, axis[1])) / tangent;
    return MARGIN * fmax(wide, high) + vec_dot(from, axis[2]);
}

void pps_camera_fit(const pps_scene *scene, double azimuth, double elevation,
                    double aspect, pps_camera *camera) {
    double a = azimuth * DEGREE, e = elevation * DEGREE;
    /* Right, up, and back towards the eye; up tips over with the view from above. */
    const double axis[3][3] = {{-sin(a), cos(a), 0},
                               {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)},
                               {cos(e) * cos(a), cos(e) * sin(a), sin(e)}};
    double tangent = tan(FIELD_OF_VIEW / 2 * DEGREE), far = 0;
    pps_box all, leaves;
    pps_scene_box(scene, &all, &leaves);
    *camera = (pps_camera){.field_of_view = FIELD_OF_VIEW};
    for (int i = 0; i < 3; i++) {
        camera->target[i] = (all.low[i] + all.high[i]) / 2;
    }
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_mesh *mesh = scene->prototype[scene->instance[k].prototype].mesh;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            double p[3];
            pps_instance_point(&scene->instance[k], mesh->position[v], p);
            far = fmax(far, distance_for(p, camera->target, axis, tangent, aspect));
        }
    }
    vec_along(camera->target, far, axis[2], camera->eye);
    memcpy(camera->up, axis[1], sizeof camera->up);
}
