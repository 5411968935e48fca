/* Attenuation of a leaf's octants by rays: what the products of attenuation.c stand for.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <omp.h>

#include <ppscat/tree/leaf_light.h>

#include "tree/leafpoint.h"
#include "tree/rays.h"

static const double PI = 3.14159265358979323846;

enum { DEFAULT_SAMPLES = 64 };

/* Evenly over octant j. */
static void draw_direction(const pps_uniforms *r, int j, double out[3]) {
    double z = r->u[0], s = sqrt(1 - z * z), phi = PI / 2 * r->u[1];
    double plain[3] = {s * cos(phi), s * sin(phi), z};
    for (int k = 0; k < 3; k++) {
        out[k] = j >> k & 1 ? plain[k] : -plain[k];
    }
}

/* Every line has a point of its own, so that the leaf as a whole is seen. */
static float see_octant(const pps_scene *scene, const pps_rays *rays, size_t leaf,
                        int octant, int samples, uint64_t seed) {
    int seen = 0;
    for (int i = 0; i < samples; i++) {
        uint64_t item =
            ((uint64_t)leaf * PPS_OCTANTS + (uint64_t)octant) * (uint64_t)samples +
            (uint64_t)i;
        pps_uniforms r = pps_random(seed, PPS_RANDOM_OCTANTS, item, 0);
        pps_leaf_point from;
        double to[3];
        pps_leaf_point_draw(scene, leaf, seed, PPS_RANDOM_OCTANTS, item, &from);
        draw_direction(&r, octant, to);
        pps_line line = pps_rays_leave(rays, from.point, from.normal, to);
        seen += !pps_rays_occluded(rays, &line);
    }
    return (float)seen / (float)samples;
}

pps_status pps_leaf_visibility(const pps_scene *scene, int samples, uint64_t seed,
                               int threads, float *att) {
    pps_rays *rays;
    if (!scene || !att || samples < 0 || threads < 0) {
        return PPS_ERR_ARGUMENT;
    }
    pps_status status = pps_rays_create(scene, &rays);
    if (status) {
        return status;
    }
    int n = samples ? samples : DEFAULT_SAMPLES;
    int cores = threads ? threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 64) num_threads(cores)
    for (size_t leaf = 0; leaf < scene->n_leaves; leaf++) {
        for (int j = 0; j < PPS_OCTANTS; j++) {
            att[PPS_OCTANTS * leaf + (size_t)j] =
                see_octant(scene, rays, leaf, j, n, seed);
        }
    }
    pps_rays_free(rays);
    return PPS_OK;
}
