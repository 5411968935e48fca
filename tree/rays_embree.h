/* What stands behind pps_rays: one Embree scene of instances over one geometry a prototype,
 * or of that geometry itself where it stands only once.
 *
 * Embree computes in single precision. Prototypes are therefore stored about their own
 * centres and the scene about its centre, and lines that leave a surface start off it by
 * more than what was rounded away.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_RAYS_EMBREE_H
#define PPS_TREE_RAYS_EMBREE_H

#if PPS_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
typedef struct RTCRayQueryContext pps_query_context;
#define PPS_SCENE_FLAG_COUNT RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS
#else
#include <embree3/rtcore.h>
typedef struct RTCIntersectContext pps_query_context;
#define PPS_SCENE_FLAG_COUNT RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
#endif

#include "tree/rays.h"

typedef struct {
    RTCScene scene;
    double center[3], half[3]; /* box of the mesh, in its own space */
    uint32_t n_leaf_triangles; /* wood comes after */
    bool once;                 /* it stands at one place only: no instance, no scene */
} pps_rays_prototype;

/* An instance, seen at one of the places where it repeats. */
typedef struct {
    uint32_t instance, n_leaf_triangles;
    double cosine, sine; /* of its yaw; 1, 0 where Embree's mesh is turned already */
    size_t first_leaf;
    const uint32_t *leaf_of; /* of a triangle */
} pps_rays_copy;

struct pps_rays {
    const pps_scene *scene;
    RTCDevice device;
    RTCScene top;
    pps_rays_prototype *prototype;
    pps_rays_copy *copy; /* numbered as the geometries of `top` */
    size_t n_copies;
    bool periodic;
    pps_box cell;
    double origin[3]; /* of Embree's space, in the scene */
    double radius, nudge;
};

/* The hit that a filter is asked about: we only ever trace single rays, and of one hit the
 * layout is that of RTCHit. */
static inline const struct RTCHit *
pps_filtered_hit(const struct RTCFilterFunctionNArguments *args) {
    return (const struct RTCHit *)(const void *)args->hit;
}

#endif
