/* Where light enters a scene: rays of sun and sky, with the power that each carries.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_LAUNCH_H
#define PPS_TREE_LAUNCH_H

#include <ppscat/tree/light.h>

#include "tree/random.h"
#include "tree/rays.h"

/* In an open scene light enters the ball about all that rays can meet, in one that repeats
 * the top (or bottom) of the layer. The last two are light that an open scene gets from
 * the ground around: from places lit directly by what misses the ball. */
typedef enum {
    PPS_LAUNCH_SUN,
    PPS_LAUNCH_SKY,
    PPS_LAUNCH_BELOW, /* the sky under the horizon, where there is no ground */
    PPS_LAUNCH_SUN_GROUND,
    PPS_LAUNCH_SKY_GROUND,
    PPS_LAUNCHES
} pps_launch_kind;

typedef struct pps_launch {
    const pps_scene *scene;
    bool periodic;
    pps_box cell;
    double center[3], radius;
    uint64_t seed;
    uint64_t first[PPS_LAUNCHES + 1]; /* rays of a kind: first[k]..first[k+1]-1 */
    double unit[PPS_LAUNCHES][PPS_BANDS_MAX]; /* mean power of one of them, per band */
} pps_launch;

/* Share about `rays` rays among the kinds that `sources` asks for, by their power; a kind
 * that has any gets at least one. first[PPS_LAUNCHES] is their number. */
void pps_launch_plan(pps_launch *launch, const pps_scene *scene, const pps_rays *rays,
                     uint64_t n_rays, uint64_t seed, unsigned sources);

/* A ray at its start. */
typedef struct pps_light_ray {
    pps_line line;
    const double *unit;      /* power = q * unit */
    double q[PPS_BANDS_MAX]; /* 0 in all bands: light of another kind, not launched */
    unsigned source;         /* pps_light_source */
} pps_light_ray;
void pps_launch_ray(const pps_launch *launch, uint64_t i, pps_light_ray *ray);

/* Random numbers of ray i; event 0 and those from 2^63 on are the launch's own. */
pps_random_stream pps_launch_stream(const pps_launch *launch, uint64_t i);

#endif
