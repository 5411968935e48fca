/* Rays by Embree: a scene of instances over one geometry a prototype.
 *
 * Embree computes in single precision. Prototypes are therefore stored about their own
 * centres and the scene about its centre, and lines that leave a surface start off it by
 * more than what was rounded away.
 *
 * A scene that repeats keeps every copy of an instance that reaches into the central cell;
 * a line is cut at the cell's walls and goes on at the opposite one.
 *
 * Spatial splits (RTC_BUILD_QUALITY_HIGH) would report a triangle more than once to the
 * filter that counts; the default quality does not, and tests/tree/test_rays.c holds it
 * to that.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if PPS_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext query_context;
#define SCENE_FLAG_COUNT RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext query_context;
#define SCENE_FLAG_COUNT RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#endif

#include "tree/alpha.h"
#include "tree/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;

/* Rounding of coordinates and transforms in single precision, of the scene's extent. */
static const double NUDGE = 1e-6;

/* Where a line that stays in a repeating layer ends, in periods. */
static const double MOST_PERIODS = 1e4;

typedef struct {
    RTCScene scene;
    double center[3], half[3]; /* box of the mesh, in its own space */
    uint32_t n_leaf_triangles; /* wood comes after */
} prototype;

/* An instance, seen at one of the places where it repeats. */
typedef struct {
    uint32_t instance, n_leaf_triangles;
    double cosine, sine; /* of its yaw */
    size_t first_leaf;
    const uint32_t *leaf_of; /* of a triangle */
} copy;

struct pps_rays {
    const pps_scene *scene;
    RTCDevice device;
    RTCScene top;
    prototype *prototype;
    copy *copy; /* numbered as the instances of `top` */
    size_t n_copies;
    bool periodic;
    pps_box cell;
    double origin[3]; /* of Embree's space, in the scene */
    double radius, nudge;
};

/* ---- building ---- */

static pps_status status_of(RTCDevice device) {
    switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
        return PPS_OK;
    case RTC_ERROR_OUT_OF_MEMORY:
        return PPS_ERR_MEMORY;
    case RTC_ERROR_INVALID_ARGUMENT:
        return PPS_ERR_ARGUMENT;
    default:
        return PPS_ERR_UNSUPPORTED;
    }
}

/* The hit that a filter is asked about: we only ever trace single rays, and of one hit the
 * layout is that of RTCHit. */
static const struct RTCHit *filtered(const struct RTCFilterFunctionNArguments *args) {
    return (const struct RTCHit *)(const void *)args->hit;
}

/* Embree's filter for cut-out alpha: a hit where nothing is does not count. */
static void pass_through_holes(const struct RTCFilterFunctionNArguments *args) {
    const struct RTCHit *hit = filtered(args);
    if (!pps_alpha_there(args->geometryUserPtr, hit->primID, (double)hit->u,
                         (double)hit->v)) {
        args->valid[0] = 0;
    }
}

static bool any_holes(const pps_mesh *mesh) {
    bool any = false;
    for (size_t t = 0; t < mesh->n_triangles && !any; t++) {
        any = pps_alpha_any(mesh, t);
    }
    return any;
}

static void measure_mesh(const pps_mesh *mesh, prototype *p) {
    double low[3] = {INFINITY, INFINITY, INFINITY},
           high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t t = 0; t < 3 * mesh->n_triangles; t++) {
        const double *at = mesh->position[mesh->triangle[t / 3][t % 3]];
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], at[i]);
            high[i] = fmax(high[i], at[i]);
        }
        p->n_leaf_triangles += t % 3 == 0 && mesh->leaf_of[t / 3] != PPS_NO_LEAF;
    }
    for (int i = 0; i < 3; i++) {
        p->center[i] = (low[i] + high[i]) / 2;
        p->half[i] = (high[i] - low[i]) / 2;
    }
}

static RTCGeometry triangles(RTCDevice device, const pps_mesh *mesh,
                             const double center[3]) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *position =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh->n_vertices);
    uint32_t *index =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(uint32_t), mesh->n_triangles);
    if (position && index) {
        for (size_t i = 0; i < 3 * mesh->n_vertices; i++) {
            position[i] = (float)(mesh->position[i / 3][i % 3] - center[i % 3]);
        }
        memcpy(index, mesh->triangle, mesh->n_triangles * sizeof *mesh->triangle);
        if (any_holes(mesh)) {
            rtcSetGeometryUserData(geometry, (void *)(uintptr_t)mesh);
            rtcSetGeometryIntersectFilterFunction(geometry, pass_through_holes);
            rtcSetGeometryOccludedFilterFunction(geometry, pass_through_holes);
        }
#if PPS_EMBREE_MAJOR >= 4
        rtcSetGeometryEnableFilterFunctionFromArguments(geometry, true);
#endif
        rtcCommitGeometry(geometry);
    }
    return geometry;
}

static RTCScene new_scene(RTCDevice device) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | SCENE_FLAG_COUNT);
    return scene;
}

static pps_status build_prototypes(pps_rays *rays) {
    for (size_t i = 0; i < rays->scene->n_prototypes; i++) {
        prototype *p = &rays->prototype[i];
        const pps_mesh *mesh = rays->scene->prototype[i].mesh;
        measure_mesh(mesh, p);
        p->scene = new_scene(rays->device);
        RTCGeometry geometry = triangles(rays->device, mesh, p->center);
        rtcAttachGeometry(p->scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(p->scene);
        pps_status status = status_of(rays->device);
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

/* The box of an instance at its own place. */
static pps_box instance_box(const pps_rays *rays, size_t k) {
    const pps_instance *instance = &rays->scene->instance[k];
    const prototype *p = &rays->prototype[instance->prototype];
    pps_box box;
    double center[3], c = fabs(cos(instance->yaw * DEGREE)),
                      s = fabs(sin(instance->yaw * DEGREE));
    double half[3] = {c * p->half[0] + s * p->half[1], s * p->half[0] + c * p->half[1],
                      p->half[2]};
    pps_instance_point(instance, p->center, center);
    for (int i = 0; i < 3; i++) {
        box.low[i] = center[i] - instance->scale * half[i];
        box.high[i] = center[i] + instance->scale * half[i];
    }
    return box;
}

/* The central cell lies about the middle of the scene's box. */
static void set_cell(pps_rays *rays) {
    pps_box all = instance_box(rays, 0);
    for (size_t k = 1; k < rays->scene->n_instances; k++) {
        pps_box box = instance_box(rays, k);
        for (int i = 0; i < 3; i++) {
            all.low[i] = fmin(all.low[i], box.low[i]);
            all.high[i] = fmax(all.high[i], box.high[i]);
        }
    }
    double half[3], widest = 0;
    for (int i = 0; i < 3; i++) {
        rays->origin[i] = (all.low[i] + all.high[i]) / 2;
        half[i] = (all.high[i] - all.low[i]) / 2;
        if (i < 2) {
            double wall = rays->periodic ? rays->scene->period[i] / 2 : HUGE_VAL;
            rays->cell.low[i] = rays->origin[i] - wall;
            rays->cell.high[i] = rays->origin[i] + wall;
            half[i] = rays->periodic ? fmax(half[i], wall) : half[i];
        }
        widest = fmax(widest, half[i]);
    }
    rays->nudge = NUDGE * widest;
    rays->cell.low[2] = all.low[2] - rays->nudge;
    rays->cell.high[2] = all.high[2] + rays->nudge;
}

/* Periods, along an axis, by which an interval may be moved and still meet the cell. */
static void shifts_into_cell(const pps_rays *rays, const pps_box *box, int axis,
                             int *first, int *last) {
    double period = rays->scene->period[axis];
    *first = *last = 0;
    if (rays->periodic) {
        *first =
            (int)ceil((rays->cell.low[axis] - box->high[axis] - rays->nudge) / period);
        *last =
            (int)floor((rays->cell.high[axis] - box->low[axis] + rays->nudge) / period);
    }
}

static void place_copy(pps_rays *rays, size_t k, const double shift[2]) {
    const pps_instance *instance = &rays->scene->instance[k];
    const prototype *p = &rays->prototype[instance->prototype];
    copy *made = &rays->copy[rays->n_copies];
    *made =
        (copy){.instance = (uint32_t)k,
               .n_leaf_triangles = p->n_leaf_triangles,
               .cosine = cos(instance->yaw * DEGREE),
               .sine = sin(instance->yaw * DEGREE),
               .first_leaf = rays->scene->first_leaf[k],
               .leaf_of = rays->scene->prototype[instance->prototype].mesh->leaf_of};
    double at[3];
    pps_instance_point(instance, p->center, at);
    vec_sub(at, rays->origin, at);
    float c = (float)(instance->scale * made->cosine),
          s = (float)(instance->scale * made->sine);
    float matrix[12] = {c, s, 0, -s, c, 0, 0, 0, (float)instance->scale}; /* columns */
    matrix[9] = (float)(at[0] + shift[0]);
    matrix[10] = (float)(at[1] + shift[1]);
    matrix[11] = (float)at[2];
    RTCGeometry geometry = rtcNewGeometry(rays->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, p->scene);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(rays->top, geometry, (unsigned)rays->n_copies++);
    rtcReleaseGeometry(geometry);
}

static pps_status build_copies(pps_rays *rays) {
    const pps_scene *scene = rays->scene;
    size_t room = 0;
    rays->top = new_scene(rays->device);
    for (size_t k = 0; k < scene->n_instances; k++) {
        pps_box box = instance_box(rays, k);
        int x[2], y[2];
        shifts_into_cell(rays, &box, 0, &x[0], &x[1]);
        shifts_into_cell(rays, &box, 1, &y[0], &y[1]);
        for (int i = x[0]; i <= x[1]; i++) {
            for (int j = y[0]; j <= y[1]; j++) {
                if (rays->n_copies == room) {
                    room = 2 * room + 16;
                    copy *more = realloc(rays->copy, room * sizeof *more);
                    if (!more) {
                        return PPS_ERR_MEMORY;
                    }
                    rays->copy = more;
                }
                place_copy(rays, k,
                           (double[2]){i * scene->period[0], j * scene->period[1]});
            }
        }
    }
    rtcCommitScene(rays->top);
    return status_of(rays->device);
}

/* The farthest corner of any triangle from the middle. */
static void measure_ball(pps_rays *rays) {
    double most = 0;
    for (size_t k = 0; k < rays->scene->n_instances; k++) {
        const pps_instance *instance = &rays->scene->instance[k];
        const prototype *p = &rays->prototype[instance->prototype];
        const pps_mesh *mesh = rays->scene->prototype[instance->prototype].mesh;
        double c = cos(instance->yaw * DEGREE), s = sin(instance->yaw * DEGREE), at[3];
        pps_instance_point(instance, p->center, at);
        vec_sub(at, rays->origin, at);
        double reach = instance->scale * vec_length(p->half) + vec_length(at);
        for (size_t t = 0; reach > most && t < 3 * mesh->n_triangles; t++) {
            const double *own = mesh->position[mesh->triangle[t / 3][t % 3]];
            double d[3];
            vec_sub(own, p->center, d);
            double turned[3] = {c * d[0] - s * d[1], s * d[0] + c * d[1], d[2]};
            vec_along(at, instance->scale, turned, d);
            most = fmax(most, vec_length(d));
        }
    }
    rays->radius = most + rays->nudge;
}

pps_status pps_rays_create(const pps_scene *scene, pps_rays **out) {
    *out = NULL;
    if (!scene || !scene->first_leaf) {
        return PPS_ERR_ARGUMENT;
    }
    pps_rays *rays = calloc(1, sizeof *rays);
    if (!rays) {
        return PPS_ERR_MEMORY;
    }
    rays->scene = scene;
    rays->periodic = scene->period[0] > 0;
    rays->prototype = calloc(scene->n_prototypes, sizeof *rays->prototype);
    rays->device = rtcNewDevice("threads=1"); /* one builds the same tree every time */
    pps_status status = !rays->prototype ? PPS_ERR_MEMORY
                        : !rays->device  ? status_of(NULL)
                                         : build_prototypes(rays);
    if (!status) {
        set_cell(rays);
        measure_ball(rays);
        status = build_copies(rays);
    }
    if (status) {
        pps_rays_free(rays);
        return status;
    }
    *out = rays;
    return PPS_OK;
}

void pps_rays_free(pps_rays *rays) {
    if (!rays) {
        return;
    }
    if (rays->top) {
        rtcReleaseScene(rays->top);
    }
    for (size_t i = 0; rays->prototype && i < rays->scene->n_prototypes; i++) {
        if (rays->prototype[i].scene) {
            rtcReleaseScene(rays->prototype[i].scene);
        }
    }
    if (rays->device) {
        rtcReleaseDevice(rays->device);
    }
    free(rays->prototype);
    free(rays->copy);
    free(rays);
}

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

/* What of it lies in the ball about the scene. */
static void clip_to_ball(const pps_rays *rays, const pps_line *line, walk *w) {
    double from[3];
    vec_sub(line->origin, rays->origin, from);
    double b = vec_dot(from, line->direction);
    double inside = rays->radius * rays->radius - (vec_dot(from, from) - b * b);
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
    for (int i = 0; i < 2 && w->rays->periodic; i++) {
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

/* ---- queries ---- */

/* What a counting query carries through Embree to its filter. */
typedef struct {
    query_context context; /* first: the filter gets its address */
    const pps_rays *rays;
    int leaves;
    bool wood;
} counter;

static void count_and_pass(const struct RTCFilterFunctionNArguments *args) {
    counter *c = (counter *)(void *)args->context;
    const struct RTCHit *hit = filtered(args);
    bool leaf = hit->primID < c->rays->copy[hit->instID[0]].n_leaf_triangles;
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
    query_context context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, ray);
}

static void query_occluded(RTCScene scene, struct RTCRay *ray) {
    query_context context;
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
static void turn(const copy *at, const double own[3], double out[3]) {
    out[0] = at->cosine * own[0] - at->sine * own[1];
    out[1] = at->sine * own[0] + at->cosine * own[1];
    out[2] = own[2];
}

static void describe_hit(const walk *w, const struct RTCRayHit *found, pps_hit *hit) {
    const pps_rays *rays = w->rays;
    const copy *at = &rays->copy[found->hit.instID[0]];
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
