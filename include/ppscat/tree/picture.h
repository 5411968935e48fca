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

/* The exposure that makes white of the brightest percent of the pixels of n pictures, by
 * their largest part; NULL ones do not count. 1 if all are black. MEMORY. */
PPS_API pps_status pps_picture_exposure(size_t n, pps_picture *const *picture,
                                        double *exposure);

/* Multiplies all radiances. */
PPS_API void pps_picture_expose(pps_picture *picture, double exposure);

/* A pinhole; `up` need not be normal to the view. */
typedef struct pps_camera {
    double eye[3], target[3], up[3];
    double field_of_view; /* vertical, degrees */
} pps_camera;

/* Has the whole scene in view, from an azimuth (degrees from +x towards +y) and elevation
 * (degrees); `aspect` is the picture's width over its height. */
PPS_API void pps_camera_fit(const pps_scene *scene, double azimuth, double elevation,
                            double aspect, pps_camera *camera);

/* Primary rays, samples x samples a pixel (1 to 16). A leaf's face has the radiance
 * (R E + T' E')/pi: its own reflectance and irradiance, the other face's transmittance and
 * irradiance, times its texture over the texture's mean. Wood (its colour) and ground take
 * the sun where they see it and, by a few rays, the light of sky and leaves. Bands are red,
 * green, blue in order; one band is grey. A scene that repeats is shown once, in the light
 * it has among its copies. MEMORY; UNSUPPORTED: Embree will not run here; ARGUMENT:
 * irradiance of another scene, samples, or a camera that looks nowhere. */
PPS_API pps_status pps_render(const pps_scene *scene, const pps_irradiance *irradiance,
                              const pps_camera *camera, int samples,
                              pps_picture *picture);

/* A value a leaf in false colour from low to high, with a colour bar and its title; wood
 * is dark, the rest white. To be written with exposure 1. ARGUMENT: as above, or low is not
 * below high. */
typedef struct pps_false_color {
    const double *value; /* [leaf]; NaN is grey */
    double low, high;
    const char *title; /* NULL: none */
    bool bare;         /* no bar and no title: those of a sheet */
} pps_false_color;
PPS_API pps_status pps_render_false(const pps_scene *scene,
                                    const pps_false_color *color,
                                    const pps_camera *camera, int samples,
                                    pps_picture *picture);

/* What leaves send to the eye, sorted by what they did with it: red was reflected by the
 * face seen, green came through it; of bands the mean (B Figure 7e). In the radiance of
 * pps_render, to be exposed; wood has the light of leaves only, the rest is black.
 * Status as there. */
PPS_API pps_status pps_render_split(const pps_scene *scene,
                                    const pps_irradiance *irradiance,
                                    const pps_camera *camera, int samples,
                                    pps_picture *picture);

/* Panels of one size in rows, each under its caption, white around them. */
typedef struct pps_sheet {
    int columns;
    size_t n;                   /* panels, row by row; at least one */
    pps_picture *const *panel;  /* NULL: left blank */
    const char *const *caption; /* a line each */
    const char *footer;         /* a line below all; NULL: none */
    const pps_false_color *key; /* its bar at the right, its title on top; NULL: none */
} pps_sheet;

/* The sheet as a picture to be written with exposure 1, as the panels are. Lines that are too long are cut off. MEMORY; ARGUMENT: panels differ in size or
 * are all blank, or the sheet is larger than a picture may be. */
PPS_API pps_status pps_sheet_draw(const pps_sheet *sheet, pps_picture **out);

#ifdef __cplusplus
}
#endif
#endif
