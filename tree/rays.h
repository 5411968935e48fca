/* Rays through a scene: the nearest hit, any hit, all hits.
 *
 * Lines are in the scene's space, metres. Cut-out alpha holds: where a surface is not there,
 * rays pass. A scene that repeats is met at its own place and at all others; a hit tells the
 * place within the central cell. Queries are const and may come from many threads at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_RAYS_H
#define PPS_TREE_RAYS_H

#include <ppscat/tree/scene.h>

typedef struct pps_rays pps_rays;

/* The stretch near..far of a line; `direction` has length 1; far may be INFINITY. In a
 * scene that repeats, a line that never leaves the layer ends after 10,000 periods. */
typedef struct pps_line {
    double origin[3], direction[3], near, far;
} pps_line;

typedef struct pps_hit {
    double distance;   /* from the line's origin */
    double u, v;       /* barycentric: a + u (b - a) + v (c - a) */
    double normal[3];  /* of the triangle in the scene, towards its front; unit */
    double point[3];   /* in the central cell if the scene repeats */
    size_t leaf;       /* scene number, SIZE_MAX for wood */
    size_t instance;   /* of the scene */
    uint32_t triangle; /* of the instance's mesh */
    bool front;        /* the line meets the triangle's front */
} pps_hit;

/* The scene must be indexed, outlive the rays, and keep its instances and meshes; sun,
 * sky, ground and optics may change. MEMORY; UNSUPPORTED: Embree will not run here. */
pps_status pps_rays_create(const pps_scene *scene, pps_rays **out);
void pps_rays_free(pps_rays *rays); /* NULL is fine */

bool pps_rays_nearest(const pps_rays *rays, const pps_line *line, pps_hit *hit);
bool pps_rays_occluded(const pps_rays *rays, const pps_line *line);

/* Leaf triangles crossed, those behind wood too; `wood` tells whether wood was. */
int pps_rays_count(const pps_rays *rays, const pps_line *line, bool *wood);

/* The line that leaves a point of a surface: it starts off the plane, on the side it goes
 * to, by more than the rounding of single precision, so it cannot meet where it starts. */
pps_line pps_rays_leave(const pps_rays *rays, const double point[3],
                        const double normal[3], const double direction[3]);

/* The ball about all that rays can hit (of one cell, if the scene repeats). */
void pps_rays_ball(const pps_rays *rays, double center[3], double *radius);

/* The walls of the central cell (infinite in an open scene), and the heights between which
 * there is anything to hit. */
const pps_box *pps_rays_cell(const pps_rays *rays);

#endif
