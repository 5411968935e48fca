/* Gathering: paths from points on leaves back to sun and sky, the second reference.
 *
 * The irradiance of a face at a point is what the sun brings, if it is seen from there,
 * and pi times the radiance from a direction drawn by Lambert's law. That radiance is the
 * sky's, or that of the surface met: for a leaf the irradiances of its two faces, reflected
 * and transmitted, for the ground its own. So a path goes on from a face of what it meets.
 *
 * It shares rays, optics and roulette with light tracing, not where light enters, how it
 * is added up, or how the ground around an open scene is lit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include <ppscat/tree/light.h>

#include "tree/bounce.h"
#include "tree/leafpoint.h"
#include "tree/rays.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double UP[3] = {0, 0, 1};

typedef struct {
    const pps_scene *scene;
    pps_rays *rays;
    uint64_t seed, most_bounces;
    uint64_t samples;
    unsigned sources;
} gatherer;

/* Where a path stands: at a point, on the side of the surface that side * normal is on. */
typedef struct {
    double point[3], normal[3], side;
    uint64_t bounces;
    double q[PPS_BANDS_MAX]; /* irradiance here counts this much */
} place;

static bool wants(const gatherer *g, const place *at, unsigned direct) {
    return g->sources & (at->bounces ? direct << 1 : direct);
}

static void add_sun(const gatherer *g, const place *at, double *irradiance) {
    const pps_sun *sun = &g->scene->sun;
    double cosine = at->side * vec_dot(at->normal, sun->to);
    bool set = g->scene->ground.present &&
               (sun->to[2] <= 0 || at->point[2] < g->scene->ground.height);
    if (cosine <= 0 || set || !wants(g, at, PPS_SUN)) {
        return;
    }
    pps_line line = pps_rays_leave(g->rays, at->point, at->normal, sun->to);
    if (!pps_rays_occluded(g->rays, &line)) {
        for (int b = 0; b < g->scene->n_bands; b++) {
            irradiance[b] += at->q[b] * sun->irradiance[b] * cosine;
        }
    }
}

static void add_sky(const gatherer *g, const place *at, double z, double *irradiance) {
    for (int b = 0; b < g->scene->n_bands && wants(g, at, PPS_SKY); b++) {
        irradiance[b] += at->q[b] * PI * pps_sky_radiance(&g->scene->sky, b, z);
    }
}

static void step_to_ground(const gatherer *g, const pps_line *line, place *at) {
    vec_along(line->origin, line->far, line->direction, at->point);
    at->point[2] = g->scene->ground.height;
    memcpy(at->normal, UP, sizeof UP);
    at->side = 1;
    for (int b = 0; b < g->scene->n_bands; b++) {
        at->q[b] *= g->scene->ground.reflectance[b];
    }
}

/* Onto the face that is seen (its light reflected), or through to the other. */
static void step_to_leaf(const gatherer *g, const pps_hit *hit, double u, place *at) {
    const pps_instance *instance = &g->scene->instance[hit->instance];
    const pps_leaf_optics *o = &g->scene->prototype[instance->prototype].optics;
    int seen = hit->front ? PPS_FRONT : PPS_BACK;
    bool reflected = pps_bounce_choose(g->scene->n_bands, at->q, o->reflectance[seen],
                                       o->transmittance[1 - seen], u);
    memcpy(at->point, hit->point, sizeof at->point);
    memcpy(at->normal, hit->normal, sizeof at->normal);
    at->side = reflected == hit->front ? 1 : -1;
}

/* Follow one ray from a place to the next; false where the path ends, in the sky too. */
static bool step(const gatherer *g, const pps_uniforms *r, place *at,
                 double *irradiance) {
    double to[3];
    pps_hit hit;
    pps_bounce_lambert(at->normal, at->side, r->u[0], r->u[1], to);
    pps_line line = pps_rays_leave(g->rays, at->point, at->normal, to);
    bool ground = pps_bounce_ground(g->scene, &line);
    if (!pps_rays_nearest(g->rays, &line, &hit)) {
        if (!ground) {
            add_sky(g, at, to[2], irradiance);
            return false;
        }
        step_to_ground(g, &line, at);
    } else if (hit.leaf == SIZE_MAX) {
        return false;
    } else {
        step_to_leaf(g, &hit, r->u[2], at);
    }
    at->bounces++;
    return at->bounces <= g->most_bounces &&
           pps_bounce_lives(g->scene->n_bands, at->q, at->bounces, r->u[3]);
}

/* The irradiance that one path finds. */
static void gather_path(const gatherer *g, size_t leaf, int face, uint64_t item,
                        double *irradiance) {
    pps_leaf_point start;
    pps_leaf_point_draw(g->scene, leaf, g->seed, PPS_RANDOM_GATHER, item, &start);
    place at = {.side = face == PPS_FRONT ? 1 : -1, .q = {1, 1, 1, 1}};
    memcpy(at.point, start.point, sizeof at.point);
    memcpy(at.normal, start.normal, sizeof at.normal);
    memset(irradiance, 0, PPS_BANDS_MAX * sizeof *irradiance);
    pps_uniforms r;
    uint64_t event = 0;
    do {
        add_sun(g, &at, irradiance);
        r = pps_random(g->seed, PPS_RANDOM_GATHER, item, event++);
    } while (step(g, &r, &at, irradiance));
}

/* Means over paths and their standard errors. */
static void gather_face(const gatherer *g, size_t leaf, int face, double *mean,
                        double *error) {
    double n = (double)g->samples, x[PPS_BANDS_MAX], m[PPS_BANDS_MAX] = {0},
           spread[PPS_BANDS_MAX] = {0};
    for (uint64_t s = 0; s < g->samples; s++) {
        uint64_t item = (2 * leaf + (uint64_t)face) * g->samples + s;
        gather_path(g, leaf, face, item, x);
        for (int b = 0; b < g->scene->n_bands; b++) { /* Welford's sums */
            double off = x[b] - m[b];
            m[b] += off / (double)(s + 1);
            spread[b] += off * (x[b] - m[b]);
        }
    }
    for (int b = 0; b < g->scene->n_bands; b++) {
        mean[b] = m[b];
        error[b] = n > 1 ? sqrt(spread[b] / (n - 1) / n) : HUGE_VAL;
    }
}

static void gather_leaf(const gatherer *g, size_t leaf, pps_irradiance *out) {
    size_t at = leaf * (size_t)g->scene->n_bands;
    gather_face(g, leaf, PPS_FRONT, &out->front[at], &out->front_error[at]);
    gather_face(g, leaf, PPS_BACK, &out->back[at], &out->back_error[at]);
}

static pps_status gather_all(const gatherer *g, size_t n, const size_t *leaf,
                             const pps_trace_options *o, pps_irradiance *out) {
    _Atomic uint64_t done = 0;
    _Atomic bool stop = false;
#pragma omp parallel for schedule(dynamic)                                             \
    num_threads(o->threads > 0 ? o->threads : omp_get_max_threads())
    for (size_t i = 0; i < n; i++) {
        if (stop) {
            continue;
        }
        gather_leaf(g, leaf ? leaf[i] : i, out);
        uint64_t now = atomic_fetch_add(&done, 1) + 1;
        if (o->progress && omp_get_thread_num() == 0 && now < n) {
            stop = !o->progress(o->user, now, n);
        }
    }
    if (o->progress && !stop) {
        o->progress(o->user, n, n);
    }
    return stop ? PPS_ERR_CANCELLED : PPS_OK;
}

static void fill_nan(const pps_scene *scene, pps_irradiance *out) {
    for (size_t i = 0; i < scene->n_leaves * (size_t)scene->n_bands; i++) {
        out->front[i] = out->back[i] = (double)NAN;
        out->front_error[i] = out->back_error[i] = (double)NAN;
    }
}

static bool leaves_hold(const pps_scene *scene, size_t n, const size_t *leaf) {
    for (size_t i = 0; i < n; i++) {
        if (leaf[i] >= scene->n_leaves) {
            return false;
        }
    }
    return true;
}

pps_status pps_gather_light(const pps_scene *scene, size_t n, const size_t *leaf,
                            int samples, const pps_trace_options *options,
                            pps_irradiance **out) {
    pps_trace_options o = options ? *options : (pps_trace_options){0};
    gatherer g = {.scene = scene, .seed = o.seed};
    pps_irradiance *result = NULL;
    *out = NULL;
    if (!scene || !scene->first_leaf || samples < 1 || o.bounces < 0 ||
        o.sources > PPS_ALL_LIGHT || (leaf && !leaves_hold(scene, n, leaf))) {
        return PPS_ERR_ARGUMENT;
    }
    g.samples = (uint64_t)samples;
    g.sources = o.sources ? o.sources : PPS_ALL_LIGHT;
    g.most_bounces = pps_bounce_most(&o);
    pps_status status = pps_rays_create(scene, &g.rays);
    if (!status) {
        status = pps_irradiance_create(scene, true, &result);
    }
    if (!status) {
        fill_nan(scene, result);
        status = gather_all(&g, leaf ? n : scene->n_leaves, leaf, &o, result);
    }
    pps_rays_free(g.rays);
    if (status) {
        pps_irradiance_free(result);
        return status;
    }
    *out = result;
    return PPS_OK;
}
