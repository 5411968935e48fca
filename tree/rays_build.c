/* Building an Embree scene from ours: prototypes, their instances, and in a scene that
 * repeats every copy of an instance that reaches into the central cell.
 *
 * Spatial splits (RTC_BUILD_QUALITY_HIGH) would report a triangle more than once to the
 * filter that counts; the default quality does not, and tests/tree/test_rays.c holds it
 * to that.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/rays_embree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/alpha.h"
#include "tree/vec.h"

typedef pps_rays_prototype prototype;
typedef pps_rays_copy copy;

static const pps_instance AS_IT_IS = {.scale = 1};
static const double DEGREE = 3.14159265358979323846 / 180;

/* Rounding of coordinates and transforms in single precision, of the scene's extent. */
static const double NUDGE = 1e-6;

/* A scene whose period is a tiny part of its plants is refused. */
static const double MOST_COPIES = 1e6;

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

/* Embree's filter for cut-out alpha: a hit where nothing is does not count. */
static void pass_through_holes(const struct RTCFilterFunctionNArguments *args) {
    const struct RTCHit *hit = pps_filtered_hit(args);
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

/* A mesh at its place, seen from an origin. */
static RTCGeometry triangles(RTCDevice device, pps_mesh *mesh,
                             const pps_instance *place, const double origin[3]) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *position =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh->n_vertices);
    uint32_t *index =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(uint32_t), mesh->n_triangles);
    if (position && index) {
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            double at[3];
            pps_instance_point(place, mesh->position[v], at);
            for (int i = 0; i < 3; i++) {
                position[3 * v + (size_t)i] = (float)(at[i] - origin[i]);
            }
        }
        memcpy(index, mesh->triangle, mesh->n_triangles * sizeof *mesh->triangle);
        if (any_holes(mesh)) {
            rtcSetGeometryUserData(geometry, mesh);
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

/* Not RTC_SCENE_FLAG_ROBUST: queries would take a fifth longer. Of 5 million rays within a
 * crown of 18,000 triangles, in double precision 2 met another leaf with it and 4 without. */
static RTCScene new_scene(RTCDevice device) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, PPS_SCENE_FLAG_COUNT);
    return scene;
}

/* A mesh that stands at one place is put there itself: a level less for every ray. */
static bool stands_once(const pps_scene *scene, size_t i) {
    size_t n = 0;
    for (size_t k = 0; k < scene->n_instances; k++) {
        n += (size_t)scene->instance[k].prototype == i;
    }
    return n == 1 && !(scene->period[0] > 0);
}

static pps_status build_prototypes(pps_rays *rays) {
    for (size_t i = 0; i < rays->scene->n_prototypes; i++) {
        prototype *p = &rays->prototype[i];
        pps_mesh *mesh = rays->scene->prototype[i].mesh;
        measure_mesh(mesh, p);
        p->once = stands_once(rays->scene, i);
        if (p->once) {
            continue;
        }
        p->scene = new_scene(rays->device);
        RTCGeometry geometry = triangles(rays->device, mesh, &AS_IT_IS, p->center);
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
                             double *first, double *last) {
    double period = rays->scene->period[axis];
    *first = *last = 0;
    if (rays->periodic) {
        *first = ceil((rays->cell.low[axis] - box->high[axis] - rays->nudge) / period);
        *last = floor((rays->cell.high[axis] - box->low[axis] + rays->nudge) / period);
    }
}

static RTCGeometry instance(const pps_rays *rays, const copy *made, size_t k,
                            const double shift[2]) {
    const pps_instance *instance = &rays->scene->instance[k];
    const prototype *p = &rays->prototype[instance->prototype];
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
    return geometry;
}

static void place_copy(pps_rays *rays, size_t k, const double shift[2]) {
    const pps_instance *at = &rays->scene->instance[k];
    const prototype *p = &rays->prototype[at->prototype];
    pps_mesh *mesh = rays->scene->prototype[at->prototype].mesh;
    copy *made = &rays->copy[rays->n_copies];
    *made = (copy){.instance = (uint32_t)k,
                   .n_leaf_triangles = p->n_leaf_triangles,
                   .cosine = p->once ? 1 : cos(at->yaw * DEGREE),
                   .sine = p->once ? 0 : sin(at->yaw * DEGREE),
                   .first_leaf = rays->scene->first_leaf[k],
                   .leaf_of = mesh->leaf_of};
    RTCGeometry geometry = p->once ? triangles(rays->device, mesh, at, rays->origin)
                                   : instance(rays, made, k, shift);
    rtcAttachGeometryByID(rays->top, geometry, (unsigned)rays->n_copies++);
    rtcReleaseGeometry(geometry);
}

/* Room for more copies, n in all. */
static pps_status reserve_copies(pps_rays *rays, double n) {
    if (!(n <= MOST_COPIES)) {
        return PPS_ERR_ARGUMENT;
    }
    copy *more = realloc(rays->copy, (size_t)n * sizeof *more);
    rays->copy = more ? more : rays->copy;
    return more ? PPS_OK : PPS_ERR_MEMORY;
}

static pps_status build_copies(pps_rays *rays) {
    const pps_scene *scene = rays->scene;
    rays->top = new_scene(rays->device);
    for (size_t k = 0; k < scene->n_instances; k++) {
        pps_box box = instance_box(rays, k);
        double x[2], y[2];
        shifts_into_cell(rays, &box, 0, &x[0], &x[1]);
        shifts_into_cell(rays, &box, 1, &y[0], &y[1]);
        double more = (x[1] - x[0] + 1) * (y[1] - y[0] + 1);
        pps_status status = reserve_copies(rays, (double)rays->n_copies + more);
        if (status) {
            return status;
        }
        int nx = (int)(x[1] - x[0]) + 1, ny = (int)(y[1] - y[0]) + 1;
        for (int i = 0; i < nx * ny; i++) {
            const double shift[2] = {(x[0] + i % nx) * scene->period[0],
                                     (y[0] + i / nx % ny) * scene->period[1]};
            place_copy(rays, k, shift);
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
