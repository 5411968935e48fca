/* The difference of two answers in the eye of a viewer.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include <ppscat/tree/seen.h>

#include "tree/rays.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double TOP = 0.999; /* the percentile that stands for the brightest */

double pps_leaf_radiance(const pps_scene *scene, const pps_irradiance *light,
                         size_t leaf, int face, int band) {
    pps_scene_leaf at;
    pps_scene_leaf_at(scene, leaf, &at);
    const pps_leaf_optics *o =
        &scene->prototype[scene->instance[at.instance].prototype].optics;
    size_t i = leaf * (size_t)light->n_bands + (size_t)band;
    double own = face == PPS_FRONT ? light->front[i] : light->back[i];
    double other = face == PPS_FRONT ? light->back[i] : light->front[i];
    return (o->reflectance[face][band] * own + o->transmittance[!face][band] * other) /
           PI;
}

/* A pixel's leaf and face; leaf is SIZE_MAX where there is none. */
typedef struct {
    size_t leaf;
    int face;
} pixel;

static void look(const pps_rays *rays, const double to[3], int n, pixel *seen) {
    double center[3], radius, x[3], y[3];
    pps_rays_ball(rays, center, &radius);
    vec_frame(to, x, y);
#pragma omp parallel for schedule(dynamic, 8)
    for (int row = 0; row < n; row++) {
        for (int column = 0; column < n; column++) {
            double across = radius * (2 * (column + 0.5) / n - 1);
            double up = radius * (2 * (row + 0.5) / n - 1);
            pps_line line = {.near = 0, .far = INFINITY};
            pps_hit hit;
            vec_along(center, across, x, line.origin);
            vec_along(line.origin, up, y, line.origin);
            vec_along(line.origin, 2 * radius, to, line.origin);
            for (int k = 0; k < 3; k++) {
                line.direction[k] = -to[k];
            }
            bool any = pps_rays_nearest(rays, &line, &hit);
            seen[row * n + column] = (pixel){any ? hit.leaf : SIZE_MAX,
                                             any && hit.front ? PPS_FRONT : PPS_BACK};
        }
    }
}

static int by_size(const void *a, const void *b) {
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* truth: room for all pixels and bands. */
static pps_status summarize(const pps_scene *scene, const pps_irradiance *truth,
                            const pps_irradiance *light, size_t n, const pixel *seen,
                            double *value, pps_seen_difference *out) {
    double difference = 0, sum = 0, true_sum = 0;
    size_t m = 0;
    *out = (pps_seen_difference){0};
    for (size_t i = 0; i < n; i++) {
        if (seen[i].leaf == SIZE_MAX) {
            continue;
        }
        out->n_pixels++;
        for (int b = 0; b < scene->n_bands; b++) {
            double want =
                pps_leaf_radiance(scene, truth, seen[i].leaf, seen[i].face, b);
            double got = pps_leaf_radiance(scene, light, seen[i].leaf, seen[i].face, b);
            value[m++] = want;
            difference += fabs(got - want);
            sum += got;
            true_sum += want;
        }
    }
    if (!(true_sum > 0)) {
        return PPS_ERR_UNSUPPORTED;
    }
    qsort(value, m, sizeof *value, by_size);
    out->over_top = difference / (double)m / value[(size_t)(TOP * (double)(m - 1))];
    out->relative = difference / true_sum;
    out->ratio = sum / true_sum;
    return PPS_OK;
}

pps_status pps_seen_compare(const pps_scene *scene, const pps_irradiance *truth,
                            const pps_irradiance *light, const double to[3], int pixels,
                            pps_seen_difference *out) {
    if (pixels < 1 || pixels > 16384 || truth->n_leaves != scene->n_leaves ||
        light->n_leaves != scene->n_leaves || truth->n_bands != scene->n_bands ||
        light->n_bands != scene->n_bands || fabs(vec_length(to) - 1) > 1e-9) {
        return PPS_ERR_ARGUMENT;
    }
    size_t n = (size_t)pixels * (size_t)pixels;
    pixel *seen = malloc(n * sizeof *seen);
    double *value = malloc(n * (size_t)scene->n_bands * sizeof *value);
    pps_rays *rays = NULL;
    pps_status status = seen && value ? pps_rays_create(scene, &rays) : PPS_ERR_MEMORY;
    if (!status) {
        look(rays, to, pixels, seen);
        status = summarize(scene, truth, light, n, seen, value, out);
    }
    pps_rays_free(rays);
    free(seen);
    free(value);
    return status;
}
