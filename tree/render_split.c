/* A picture of what leaves reflect, red, and what they let through, green.
 *
 * The same scene with three bands: in the first its leaves only reflect, in the second
 * they only let through, and what falls on them is what they would have sent on.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/picture.h>

enum { REFLECTED, THROUGH, UNUSED, N_BANDS };

/* Mean over the bands of what the leaf's face sends on by reflectance or transmittance. */
static double sent(const pps_scene *scene, const double share[PPS_BANDS_MAX],
                   const double *light) {
    double sum = 0;
    for (int b = 0; b < scene->n_bands; b++) {
        sum += share[b] * light[b] / scene->n_bands;
    }
    return sum;
}

static void split_leaves(const pps_scene *scene, const pps_irradiance *light,
                         pps_irradiance *out) {
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_prototype *p = &scene->prototype[scene->instance[k].prototype];
        for (size_t i = 0; i < p->mesh->n_leaves; i++) {
            size_t leaf = scene->first_leaf[k] + i;
            size_t from = leaf * (size_t)scene->n_bands, to = leaf * N_BANDS;
            const double *in[2] = {light->front + from, light->back + from};
            double *on[2] = {out->front + to, out->back + to};
            for (int face = 0; face < 2; face++) {
                on[face][REFLECTED] =
                    sent(scene, p->optics.reflectance[face], in[face]);
                on[face][THROUGH] =
                    sent(scene, p->optics.transmittance[face], in[face]);
                on[face][UNUSED] = 0;
            }
        }
    }
}

/* No light but that of leaves. */
static pps_status split_scene(const pps_scene *scene, pps_scene *out) {
    *out = *scene;
    out->n_bands = N_BANDS;
    memset(out->sun.irradiance, 0, sizeof out->sun.irradiance);
    out->sky = (pps_sky){0};
    out->ground.present = false;
    out->prototype = malloc((scene->n_prototypes + 1) * sizeof *out->prototype);
    for (size_t i = 0; out->prototype && i < scene->n_prototypes; i++) {
        out->prototype[i] = scene->prototype[i];
        out->prototype[i].optics = (pps_leaf_optics){0};
        for (int face = 0; face < 2; face++) {
            out->prototype[i].optics.reflectance[face][REFLECTED] = 1;
            out->prototype[i].optics.transmittance[face][THROUGH] = 1;
        }
    }
    return out->prototype ? PPS_OK : PPS_ERR_MEMORY;
}

pps_status pps_render_split(const pps_scene *scene, const pps_irradiance *irradiance,
                            const pps_camera *camera, int samples,
                            pps_picture *picture) {
    pps_scene split;
    pps_irradiance *light = NULL;
    if (irradiance->n_leaves != scene->n_leaves ||
        irradiance->n_bands != scene->n_bands) {
        return PPS_ERR_ARGUMENT;
    }
    pps_status status = split_scene(scene, &split);
    if (!status) {
        status = pps_irradiance_create(&split, false, &light);
    }
    if (!status) {
        split_leaves(scene, irradiance, light);
        status = pps_render(&split, light, camera, samples, picture);
    }
    pps_irradiance_free(light);
    free(split.prototype);
    return status;
}
