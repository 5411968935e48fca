/* Light tracing: rays from sun and sky through the scene with all their bounces.
 *
 * What arrives at a face of a leaf is added to it. Sums are integers (fixed point), added
 * atomically: no order of rays, and no number of threads, changes a bit of them. Powers
 * of energy are summed by blocks of rays in order.
 *
 * The variance of a sum over rays is that of independent rays: of what one ray brings to a
 * face on all its visits, squared.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include <ppscat/tree/light.h>

#include "tree/bounce.h"
#include "tree/launch.h"
#include "tree/rays.h"
#include "tree/vec.h"

enum { DEFAULT_RAYS = 1000000, BLOCK = 4096, MOST_VISITS = 64 };

/* Sums keep these bits above rays * unit, for the rays that bring more. */
enum { SUM_ROOM = 4, SQUARE_ROOM = 10 };

static const double UP[3] = {0, 0, 1};

/* Side by side: a visit touches one line of the cache. */
typedef struct {
    _Atomic int64_t sum, square;
} face_sum;

typedef struct {
    const pps_scene *scene;
    pps_rays *rays;
    pps_launch launch;
    uint64_t n_rays, most_bounces;
    unsigned sources;
    double unit[PPS_BANDS_MAX]; /* of power in the sums: the largest of any ray */
    double sum_one, square_one; /* fixed-point 1 */
    face_sum *face;             /* [(leaf * 2 + face) * n_bands + band] */
} tracer;

/* A ray on its way, with all it has brought to leaves so far: one visit a face. */
typedef struct {
    size_t face; /* leaf * 2 + face */
    double power[PPS_BANDS_MAX];
} visit;

typedef struct {
    pps_light_ray ray;
    uint64_t bounces;
    pps_energy energy;
    int n_visits;
    visit visit[MOST_VISITS];
} path;

/* ---- sums ---- */

static void keep_visits(const tracer *t, path *p) {
    int n_bands = t->scene->n_bands;
    for (int i = 0; i < p->n_visits; i++) {
        for (int b = 0; b < n_bands; b++) {
            double x = t->unit[b] > 0 ? p->visit[i].power[b] / t->unit[b] : 0;
            face_sum *at = &t->face[p->visit[i].face * (size_t)n_bands + (size_t)b];
            atomic_fetch_add_explicit(&at->sum, llrint(x * t->sum_one),
                                      memory_order_relaxed);
            atomic_fetch_add_explicit(&at->square, llrint(x * x * t->square_one),
                                      memory_order_relaxed);
        }
    }
    p->n_visits = 0;
}

static void arrive(const tracer *t, path *p, size_t face) {
    if (!(t->sources & p->ray.source)) {
        return;
    }
    int i = 0;
    while (i < p->n_visits && p->visit[i].face != face) {
        i++;
    }
    if (i == MOST_VISITS) { /* a very long path: as if a new ray went on */
        keep_visits(t, p);
        i = 0;
    }
    if (i == p->n_visits) {
        p->n_visits++;
        p->visit[i] = (visit){.face = face};
        /* its sums, by the time that the path ends */
        __builtin_prefetch(&t->face[face * (size_t)t->scene->n_bands], 1);
    }
    for (int b = 0; b < t->scene->n_bands; b++) {
        p->visit[i].power[b] += p->ray.q[b] * p->ray.unit[b];
    }
}

/* power += share * what the ray carries */
static void give(const tracer *t, const path *p, const double *share, double *power) {
    for (int b = 0; b < t->scene->n_bands; b++) {
        power[b] += (share ? share[b] : 1) * p->ray.q[b] * p->ray.unit[b];
    }
}

/* ---- bounces ---- */

/* After a bounce: roulette. What chance adds to the power is accounted for. */
static bool go_on(const tracer *t, path *p, const double *before, double u) {
    int n_bands = t->scene->n_bands;
    bool lives = pps_bounce_lives(n_bands, p->ray.q, ++p->bounces, u);
    for (int b = 0; b < n_bands; b++) {
        double after = lives ? p->ray.q[b] : 0;
        p->energy.chance[b] += (after - before[b]) * p->ray.unit[b];
    }
    if (p->bounces == 1) { /* from now on it is indirect light */
        p->ray.source |= p->ray.source << 1;
        p->ray.source &= PPS_SUN_INDIRECT | PPS_SKY_INDIRECT;
    }
    return lives;
}

static bool meet_leaf(const tracer *t, path *p, const pps_hit *hit,
                      const pps_uniforms *r) {
    const pps_instance *instance = &t->scene->instance[hit->instance];
    const pps_leaf_optics *o = &t->scene->prototype[instance->prototype].optics;
    int face = hit->front ? PPS_FRONT : PPS_BACK;
    double kept[PPS_BANDS_MAX], before[PPS_BANDS_MAX], out[3];
    arrive(t, p, 2 * hit->leaf + (size_t)face);
    if (p->bounces == t->most_bounces) {
        give(t, p, NULL, p->energy.leaves);
        return false;
    }
    for (int b = 0; b < t->scene->n_bands; b++) {
        double scattered = o->reflectance[face][b] + o->transmittance[face][b];
        kept[b] = 1 - scattered;
        before[b] = p->ray.q[b] * scattered;
    }
    give(t, p, kept, p->energy.leaves);
    bool reflected =
        pps_bounce_choose(t->scene->n_bands, p->ray.q, o->reflectance[face],
                          o->transmittance[face], r->u[2]);
    pps_bounce_lambert(hit->normal, reflected == hit->front ? 1 : -1, r->u[0], r->u[1],
                       out);
    p->ray.line = pps_rays_leave(t->rays, hit->point, hit->normal, out);
    return go_on(t, p, before, r->u[3]);
}

static bool meet_ground(const tracer *t, path *p, const pps_uniforms *r) {
    double kept[PPS_BANDS_MAX], before[PPS_BANDS_MAX], at[3], out[3];
    if (p->bounces == t->most_bounces) {
        give(t, p, NULL, p->energy.ground);
        return false;
    }
    for (int b = 0; b < t->scene->n_bands; b++) {
        kept[b] = 1 - t->scene->ground.reflectance[b];
        before[b] = p->ray.q[b] * t->scene->ground.reflectance[b];
    }
    give(t, p, kept, p->energy.ground);
    memcpy(p->ray.q, before, sizeof p->ray.q);
    vec_along(p->ray.line.origin, p->ray.line.far, p->ray.line.direction, at);
    at[2] = t->scene->ground.height;
    pps_bounce_lambert(UP, 1, r->u[0], r->u[1], out);
    p->ray.line = pps_rays_leave(t->rays, at, UP, out);
    return go_on(t, p, before, r->u[3]);
}

static void trace_ray(const tracer *t, uint64_t i, path *p) {
    pps_launch_ray(&t->launch, i, &p->ray);
    p->bounces = (p->ray.source & (PPS_SUN_INDIRECT | PPS_SKY_INDIRECT)) != 0;
    p->n_visits = 0;
    pps_random_stream stream = pps_launch_stream(&t->launch, i);
    give(t, p, NULL, p->energy.launched);
    bool lives = p->ray.q[0] + p->ray.q[1] + p->ray.q[2] + p->ray.q[3] > 0;
    for (uint64_t event = 1; lives; event++) {
        pps_uniforms r = pps_random(t->launch.seed, stream, i, event);
        bool ground = pps_bounce_ground(t->scene, &p->ray.line);
        pps_hit hit;
        if (!pps_rays_nearest(t->rays, &p->ray.line, &hit)) {
            lives = ground && meet_ground(t, p, &r);
            if (!ground) {
                give(t, p, NULL, p->energy.escaped);
            }
        } else if (hit.leaf == SIZE_MAX) {
            give(t, p, NULL, p->energy.wood);
            lives = false;
        } else {
            lives = meet_leaf(t, p, &hit, &r);
        }
    }
    keep_visits(t, p);
}

/* ---- all rays ---- */

static void add_energy(pps_energy *to, const pps_energy *from) {
    for (int b = 0; b < PPS_BANDS_MAX; b++) {
        to->launched[b] += from->launched[b];
        to->leaves[b] += from->leaves[b];
        to->wood[b] += from->wood[b];
        to->ground[b] += from->ground[b];
        to->escaped[b] += from->escaped[b];
        to->chance[b] += from->chance[b];
    }
}

static pps_status trace_all(const tracer *t, const pps_trace_options *o,
                            pps_energy *energy) {
    int64_t n_blocks = (int64_t)((t->n_rays + BLOCK - 1) / BLOCK);
    pps_energy *block = calloc((size_t)n_blocks + 1, sizeof *block);
    _Atomic uint64_t done = 0;
    _Atomic bool stop = false;
    if (!block) {
        return PPS_ERR_MEMORY;
    }
#pragma omp parallel for schedule(dynamic)                                             \
    num_threads(o->threads > 0 ? o->threads : omp_get_max_threads())
    for (int64_t k = 0; k < n_blocks; k++) {
        path p = {.n_visits = 0};
        uint64_t first = (uint64_t)k * BLOCK;
        uint64_t last = first + BLOCK < t->n_rays ? first + BLOCK : t->n_rays;
        for (uint64_t i = first; i < last && !stop; i++) {
            trace_ray(t, i, &p);
        }
        block[k] = p.energy;
        uint64_t now = atomic_fetch_add(&done, last - first) + last - first;
        if (o->progress && omp_get_thread_num() == 0 && !stop) {
            stop = !o->progress(o->user, now, t->n_rays);
        }
    }
    if (o->progress && !stop) {
        o->progress(o->user, t->n_rays, t->n_rays);
    }
    for (int64_t k = 0; k < n_blocks && energy; k++) {
        add_energy(energy, &block[k]);
    }
    free(block);
    return stop ? PPS_ERR_CANCELLED : PPS_OK;
}

/* From sums of powers to irradiances and their standard errors. A face that no ray met has
 * the error of one ray. */
static void finish(const tracer *t, pps_irradiance *out) {
    size_t n_bands = (size_t)t->scene->n_bands;
    double n = (double)t->n_rays;
    for (size_t leaf = 0; leaf < t->scene->n_leaves; leaf++) {
        pps_scene_leaf at;
        pps_scene_leaf_at(t->scene, leaf, &at);
        for (size_t i = 0; i < 2 * n_bands && at.area > 0; i++) {
            size_t from = leaf * 2 * n_bands + i, b = i % n_bands;
            double sum = (double)t->face[from].sum / t->sum_one;
            double square = (double)t->face[from].square / t->square_one;
            double variance = sum > 0 ? fmax(square - sum * sum / n, 0) : 1;
            double value = sum * t->unit[b] / at.area;
            double error = sqrt(variance) * t->unit[b] / at.area;
            (i < n_bands ? out->front : out->back)[leaf * n_bands + b] = value;
            (i < n_bands ? out->front_error : out->back_error)[leaf * n_bands + b] =
                error;
        }
    }
}

static pps_status prepare(tracer *t, const pps_trace_options *o) {
    const pps_scene *scene = t->scene;
    size_t n = 2 * scene->n_leaves * (size_t)scene->n_bands + 1;
    t->sources = o->sources ? o->sources : PPS_ALL_LIGHT;
    t->most_bounces = pps_bounce_most(o);
    t->face = calloc(n, sizeof *t->face);
    pps_status status = t->face ? pps_rays_create(scene, &t->rays) : PPS_ERR_MEMORY;
    if (status) {
        return status;
    }
    pps_launch_plan(&t->launch, scene, t->rays, o->rays ? o->rays : DEFAULT_RAYS,
                    o->seed, t->sources);
    t->n_rays = t->launch.first[PPS_LAUNCHES];
    for (int k = 0; k < PPS_LAUNCHES; k++) {
        for (int b = 0; b < scene->n_bands; b++) {
            t->unit[b] = fmax(t->unit[b], t->launch.unit[k][b]);
        }
    }
    int bits = 63 - (int)ceil(log2((double)t->n_rays + 1));
    t->sum_one = ldexp(1, bits - SUM_ROOM);
    t->square_one = ldexp(1, bits - SQUARE_ROOM);
    return PPS_OK;
}

pps_status pps_trace_light(const pps_scene *scene, const pps_trace_options *options,
                           pps_irradiance **out, pps_energy *energy) {
    pps_trace_options o = options ? *options : (pps_trace_options){0};
    tracer t = {.scene = scene};
    pps_irradiance *result = NULL;
    *out = NULL;
    if (!scene || !scene->first_leaf || o.bounces < 0 || o.sources > PPS_ALL_LIGHT ||
        o.rays > (uint64_t)1 << 40) {
        return PPS_ERR_ARGUMENT;
    }
    if (energy) {
        memset(energy, 0, sizeof *energy);
    }
    pps_status status = prepare(&t, &o);
    if (!status) {
        status = pps_irradiance_create(scene, true, &result);
    }
    if (!status) {
        status = trace_all(&t, &o, energy);
    }
    if (!status) {
        finish(&t, result);
        *out = result;
    } else {
        pps_irradiance_free(result);
    }
    pps_rays_free(t.rays);
    free(t.face);
    return status;
}
