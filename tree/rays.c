/* Rays by Embree: queries along lines.
 *
 * In a scene that repeats a line is cut at the walls of the central cell and goes on at the
 * opposite wall.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "tree/rays_embree.h"
#include "tree/vec.h"

/* Where a line that stays in a repeating layer ends, in periods. */
static const double MOST_PERIODS = 1e4;

/* ---- lines, cut at the walls of the central cell ---- */

typedef struct {
    const pps_rays *rays;
    const double *direction;
    double at[3];     /* where the piece starts, in the central cell */
    double done, far; /* distances from the line's origin: to there, to the end */
    double piece;     /* length of the piece */
    double wall[2];   /* distance from `at` to the wall ahead */
} walk;

/* What of the line lies between the heights of the scene. */
static void clip_to_layer(const pps_box *cell, const pps_line *line, walk *w) {
    double z = line->origin[2], dz = line->direction[2];
    if (dz == 0) {
        w->far = z >= cell->low[2] && z <= cell->high[2] ? w->far : -1;
        return;
    }
    double in = ((dz > 0 ? cell->low : cell->high)[2] - z) / dz;
    double out = ((dz > 0 ? cell->high : cell->low)[2] - z) / dz;
    w->done = fmax(w->done, in);
    w->far = fmin(w->far, out);
}

/* What of it lies in the ball about the scene; a line that starts in there is whole. */
static void clip_to_ball(const pps_rays *rays, const pps_line *line, walk *w) {
    double from[3];
    vec_sub(line->origin, rays->origin, from);
    double beyond = vec_dot(from, from) - rays->radius * rays->radius;
    if (beyond <= 0) {
        return;
    }
    double b = vec_dot(from, line->direction), inside = b * b - beyond;
    double half = sqrt(fmax(inside, 0));
    w->done = fmax(w->done, -b - half);
    w->far = inside > 0 ? fmin(w->far, half - b) : -1;
}

/* Distances are counted from where the line enters the scene: from a distance, single
 * precision would lose the leaves. */
static walk start_walk(const pps_rays *rays, const pps_line *line) {
    walk w = {.rays = rays,
              .direction = line->direction,
              .done = line->near,
              .far = line->far};
    const double *period = rays->scene->period;
    if (!rays->periodic) {
        clip_to_ball(rays, line, &w);
        vec_along(line->origin, w.done, line->direction, w.at);
        return w;
    }
    clip_to_layer(&rays->cell, line, &w);
    w.far = fmin(w.far, w.done + MOST_PERIODS * fmax(period[0], period[1]));
    vec_along(line->origin, w.done, line->direction, w.at);
    for (int i = 0; i < 2; i++) {
        w.at[i] -= period[i] * floor((w.at[i] - rays->cell.low[i]) / period[i]);
    }
    return w;
}

/* Find the next piece; false at the line's end. */
static bool cut_piece(walk *w) {
    w->piece = w->far - w->done;
    for (int i = 0; i < 2 && w->rays->periodic; i++) {
        double d = w->direction[i];
        const pps_box *cell = &w->rays->cell;
        double to = (d > 0 ? cell->high : cell->low)[i] - w->at[i];
        w->wall[i] = d != 0 ? fmax(to / d, 0) : HUGE_VAL;
        w->piece = fmin(w->piece, w->wall[i]);
    }
    return w->piece >= 0;
}

/* Go on behind the wall where the piece ends; false at the line's end. */
static bool pass_wall(walk *w) {
    bool passed = false;
    if (!w->rays->periodic) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        const pps_box *cell = &w->rays->cell;
        bool wall = w->wall[i] <= w->piece;
        w->at[i] = !wall                 ? w->at[i] + w->piece * w->direction[i]
                   : w->direction[i] > 0 ? cell->low[i]
                                         : cell->high[i];
        passed = passed || wall;
    }
    w->at[2] += w->piece * w->direction[2];
    w->done += w->piece;
    return passed;
}

static struct RTCRay piece_ray(const walk *w) {
    const double *o = w->rays->origin, *d = w->direction;
    return (struct RTCRay){.org_x = (float)(w->at[0] - o[0]),
                           .org_y = (float)(w->at[1] - o[1]),
                           .org_z = (float)(w->at[2] - o[2]),
                           .dir_x = (float)d[0],
                           .dir_y = (float)d[1],
                           .dir_z = (float)d[2],
                           .tfar = (float)w->piece,
                           .mask = UINT32_MAX};
}

/* The copy that was hit: instances are numbered as copies are, and so are the meshes that
 * stand in the scene themselves. */
static const pps_rays_copy *hit_copy(const pps_rays *rays, const struct RTCHit *hit) {
    bool itself = hit->instID[0] == RTC_INVALID_GEOMETRY_ID;
    return &rays->copy[itself ? hit->geomID : hit->instID[0]];
}

/* ---- queries ---- */

/* What a counting query carries through Embree to its filter. */
typedef struct {
    pps_query_context context; /* first: the filter gets its address */
    const pps_rays *rays;
    int leaves;
    bool wood;
} counter;

static void count_and_pass(const struct RTCFilterFunctionNArguments *args) {
    counter *c = (counter *)(void *)args->context;
    const struct RTCHit *hit = pps_filtered_hit(args);
    bool leaf = hit->primID < hit_copy(c->rays, hit)->n_leaf_triangles;
    c->leaves += leaf;
    c->wood = c->wood || !leaf;
    args->valid[0] = 0;
}

#if PPS_EMBREE_MAJOR >= 4
static void query_nearest(RTCScene scene, struct RTCRayHit *ray) {
    rtcIntersect1(scene, ray, NULL);
}

static void query_occluded(RTCScene scene, struct RTCRay *ray) {
    rtcOccluded1(scene, ray, NULL);
}

static void query_count(RTCScene scene, struct RTCRay *ray, counter *c) {
    struct RTCOccludedArguments arguments;
    rtcInitRayQueryContext(&c->context);
    rtcInitOccludedArguments(&arguments);
    arguments.context = &c->context;
    arguments.filter = count_and_pass;
    rtcOccluded1(scene, ray, &arguments);
}
#else
static void query_nearest(RTCScene scene, struct RTCRayHit *ray) {
    pps_query_context context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, ray);
}

static void query_occluded(RTCScene scene, struct RTCRay *ray) {
    pps_query_context context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, ray);
}

static void query_count(RTCScene scene, struct RTCRay *ray, counter *c) {
    rtcInitIntersectContext(&c->context);
    c->context.filter = count_and_pass;
    rtcOccluded1(scene, &c->context, ray);
}
#endif

/* Into the scene: turned by the copy's yaw. */
static void turn(const pps_rays_copy *at, const double own[3], double out[3]) {
    out[0] = at->cosine * own[0] - at->sine * own[1];
    out[1] = at->sine * own[0] + at->cosine * own[1];
    out[2] = own[2];
}

static void describe_hit(const walk *w, const struct RTCRayHit *found, pps_hit *hit) {
    const pps_rays *rays = w->rays;
    const pps_rays_copy *at = hit_copy(rays, &found->hit);
    const struct RTCHit *h = &found->hit;
    double piece = (double)found->ray.tfar;
    turn(at, (double[3]){(double)h->Ng_x, (double)h->Ng_y, (double)h->Ng_z},
         hit->normal);
    vec_normalize(hit->normal);
    vec_along(w->at, piece, w->direction, hit->point);
    hit->distance = w->done + piece;
    hit->u = (double)h->u;
    hit->v = (double)h->v;
    hit->instance = at->instance;
    hit->triangle = h->primID;
    uint32_t leaf = at->leaf_of[h->primID];
    hit->leaf = leaf == PPS_NO_LEAF ? SIZE_MAX : at->first_leaf + leaf;
    hit->front = vec_dot(hit->normal, w->direction) < 0;
}

bool pps_rays_nearest(const pps_rays *rays, const pps_line *line, pps_hit *hit) {
    walk w = start_walk(rays, line);
    while (cut_piece(&w)) {
        struct RTCRayHit ray = {.ray = piece_ray(&w)};
        ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        query_nearest(rays->top, &ray);
        if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
            describe_hit(&w, &ray, hit);
            return true;
        }
        if (!pass_wall(&w)) {
            break;
        }
    }
    return false;
}

bool pps_rays_occluded(const pps_rays *rays, const pps_line *line) {
    walk w = start_walk(rays, line);
    while (cut_piece(&w)) {
        struct RTCRay ray = piece_ray(&w);
        query_occluded(rays->top, &ray);
        if (ray.tfar < 0) {
            return true;
        }
        if (!pass_wall(&w)) {
            break;
        }
    }
    return false;
}

int pps_rays_count(const pps_rays *rays, const pps_line *line, bool *wood) {
    counter c = {.rays = rays};
    walk w = start_walk(rays, line);
    while (cut_piece(&w)) {
        struct RTCRay ray = piece_ray(&w);
        query_count(rays->top, &ray, &c);
        if (!pass_wall(&w)) {
            break;
        }
    }
    *wood = c.wood;
    return c.leaves;
}

/* ---- places ---- */

pps_line pps_rays_leave(const pps_rays *rays, const double point[3],
                        const double normal[3], const double direction[3]) {
    pps_line line = {.far = INFINITY};
    double side = copysign(rays->nudge, vec_dot(normal, direction));
    vec_along(point, side, normal, line.origin);
    memcpy(line.direction, direction, sizeof line.direction);
    return line;
}

void pps_rays_ball(const pps_rays *rays, double center[3], double *radius) {
    memcpy(center, rays->origin, sizeof rays->origin);
    *radius = rays->radius;
}

const pps_box *pps_rays_cell(const pps_rays *rays) { return &rays->cell; }
