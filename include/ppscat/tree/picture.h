/* Pictures: linear light in, PNG out.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_PICTURE_H
#define PPSCAT_TREE_PICTURE_H

#include <ppscat/tree/light.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Linear rgb, [3 * (y * width + x)], y down. */
typedef struct pps_picture {
    int width, height;
    float *rgb;
} pps_picture;

PPS_API pps_status pps_picture_create(int width, int height, pps_picture **out);
PPS_API void pps_picture_free(pps_picture *picture); /* NULL is fine */

/* sRGB, 8 bit, after multiplying by exposure (0: the brightest percent is white). */
PPS_API pps_status pps_picture_write(const pps_picture *picture, double exposure,
                                     const char *path, pps_problem *problem);

/* A pinhole; `up` need not be normal to the view. */
typedef struct pps_camera {
    double eye[3], target[3], up[3];
    double field_of_view; /* vertical, degrees */
} pps_camera;

/* Looks at the whole scene from an azimuth (degrees from +x) and elevation. */
PPS_API void pps_camera_fit(const pps_scene *scene, double azimuth, double elevation,
                            double aspect, pps_camera *camera);

/* Primary rays, n x n a pixel (samples = n): leaves by their irradiance and optics,
 * the ground by `ground_irradiance` of its points in shadow or light, wood as black
 * Lambertian of its colour under the mean leaf irradiance. Bands are red, green, blue in
 * order; one band is grey. */
PPS_API pps_status pps_render(const pps_scene *scene, const pps_irradiance *irradiance,
                              const pps_camera *camera, int samples,
                              pps_picture *picture);

/* A value a leaf in false colour from low to high, with a colour bar and its title. */
typedef struct pps_false_color {
    const double *value; /* [leaf]; NaN is grey */
    double low, high;
    const char *title;
} pps_false_color;
PPS_API pps_status pps_render_false(const pps_scene *scene,
                                    const pps_false_color *color,
                                    const pps_camera *camera, int samples,
                                    pps_picture *picture);

#ifdef __cplusplus
}
#endif
#endif
