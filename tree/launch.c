/* Where light enters a scene.
 *
 * An open scene over an infinite ground: light reaches what stands on it straight, or from
 * the ground. The ground near by is lit by rays that were launched at the ball, and those
 * go on from there as any ray does. The ground further out is lit by light that misses the
 * ball; of all rays that enter the ball from below we keep those whose ground point gets
 * such light. The two together are the whole ground, nothing twice.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/launch.h"

#include <math.h>
#include <string.h>

#include "tree/bounce.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double UP[3] = {0, 0, 1};

/* Events of a ray's row of random numbers; those between are its bounces. */
#define START 0
#define GROUND_LIGHT ((uint64_t)1 << 63)

static bool over_ground(const pps_launch *l) { return l->scene->ground.present; }

/* Radiance of the sky averaged over its half, by solid angle or (periodic) by the cosine. */
static double mean_radiance(const pps_sky *sky, int band, bool by_cosine) {
    double slope = sky->zenith[band] - sky->horizon[band];
    return sky->horizon[band] + slope * (by_cosine ? 2 / 3.0 : 0.5);
}

/* The power that enters by each kind. */
static double power_of(const pps_launch *l, pps_launch_kind kind, int b) {
    const pps_scene *s = l->scene;
    double disk = PI * l->radius * l->radius, sphere_side = 2 * PI * disk;
    double top = s->period[0] * s->period[1];
    double sun = over_ground(l) && s->sun.to[2] <= 0 ? 0 : s->sun.irradiance[b];
    double ground = over_ground(l) && !l->periodic ? s->ground.reflectance[b] : 0;
    switch (kind) {
    case PPS_LAUNCH_SUN:
        return l->periodic ? sun * fabs(s->sun.to[2]) * top : sun * disk;
    case PPS_LAUNCH_SKY:
        return l->periodic ? mean_radiance(&l->scene->sky, b, true) * PI * top
                           : mean_radiance(&l->scene->sky, b, false) * sphere_side;
    case PPS_LAUNCH_BELOW:
        return over_ground(l)
                   ? 0
                   : s->sky.below[b] * (l->periodic ? PI * top : sphere_side);
    case PPS_LAUNCH_SUN_GROUND:
        return ground * sun * s->sun.to[2] / PI * sphere_side;
    case PPS_LAUNCH_SKY_GROUND:
        return ground * mean_radiance(&l->scene->sky, b, true) * sphere_side;
    default:
        return 0;
    }
}

static unsigned sources_of(pps_launch_kind kind) {
    switch (kind) {
    case PPS_LAUNCH_SUN:
        return PPS_SUN | PPS_SUN_INDIRECT;
    case PPS_LAUNCH_SUN_GROUND:
        return PPS_SUN_INDIRECT;
    case PPS_LAUNCH_SKY_GROUND:
        return PPS_SKY_INDIRECT;
    default:
        return PPS_SKY | PPS_SKY_INDIRECT;
    }
}

void pps_launch_plan(pps_launch *l, const pps_scene *scene, const pps_rays *rays,
                     uint64_t n_rays, uint64_t seed, unsigned sources) {
    double share[PPS_LAUNCHES] = {0}, total[PPS_BANDS_MAX] = {0}, whole = 0;
    *l = (pps_launch){
        .scene = scene, .periodic = scene->period[0] > 0, .cell = *pps_rays_cell(rays)};
    l->seed = seed;
    pps_rays_ball(rays, l->center, &l->radius);
    for (int k = 0; k < PPS_LAUNCHES; k++) {
        for (int b = 0; b < scene->n_bands; b++) {
            bool wanted = sources & sources_of((pps_launch_kind)k);
            l->unit[k][b] = wanted ? power_of(l, (pps_launch_kind)k, b) : 0;
            total[b] += l->unit[k][b];
        }
    }
    for (int k = 0; k < PPS_LAUNCHES; k++) { /* every band weighs the same */
        for (int b = 0; b < scene->n_bands; b++) {
            share[k] += total[b] > 0 ? l->unit[k][b] / total[b] : 0;
        }
        whole += share[k];
    }
    for (int k = 0; k < PPS_LAUNCHES; k++) {
        double n = share[k] > 0 ? fmax(round((double)n_rays * share[k] / whole), 1) : 0;
        l->first[k + 1] = l->first[k] + (uint64_t)n;
        for (int b = 0; b < scene->n_bands; b++) {
            l->unit[k][b] = n > 0 ? l->unit[k][b] / n : 0;
        }
    }
}

static pps_launch_kind kind_of(const pps_launch *l, uint64_t i) {
    int k = 0;
    while (k + 1 < PPS_LAUNCHES && i >= l->first[k + 1]) {
        k++;
    }
    return (pps_launch_kind)k;
}

pps_random_stream pps_launch_stream(const pps_launch *l, uint64_t i) {
    bool sun = sources_of(kind_of(l, i)) & (PPS_SUN | PPS_SUN_INDIRECT);
    return sun ? PPS_RANDOM_SUN : PPS_RANDOM_SKY;
}

/* A line from direction `to` through the ball: by a point of the disk that faces it. */
static void aim_at_ball(const pps_launch *l, const double to[3], double u, double v,
                        pps_line *line) {
    double x[3], y[3], r = l->radius * sqrt(u), back = l->radius;
    vec_frame(to, x, y);
    vec_along(l->center, r * cos(2 * PI * v), x, line->origin);
    vec_along(line->origin, r * sin(2 * PI * v), y, line->origin);
    double over = line->origin[2] + back * to[2] - l->scene->ground.height;
    if (over_ground(l) && to[2] > 0 && over <= 0) { /* it meets the ground before */
        back += l->radius - over / to[2];
    }
    vec_along(line->origin, back, to, line->origin);
    line->near = 0;
    line->far = INFINITY;
    for (int i = 0; i < 3; i++) {
        line->direction[i] = -to[i];
    }
}

/* A line from direction `to` through the cell's top, or bottom. */
static void aim_at_layer(const pps_launch *l, const double to[3], double u, double v,
                         pps_line *line) {
    double top = over_ground(l) ? fmax(l->cell.high[2], l->scene->ground.height)
                                : l->cell.high[2];
    line->origin[0] = l->cell.low[0] + u * l->scene->period[0];
    line->origin[1] = l->cell.low[1] + v * l->scene->period[1];
    line->origin[2] = to[2] > 0 ? top + l->radius : l->cell.low[2] - l->radius;
    line->near = 0;
    line->far = INFINITY;
    for (int i = 0; i < 3; i++) {
        line->direction[i] = -to[i];
    }
}

/* Does the whole line through a point pass the ball? Then what it brings is launched. */
static bool passes_ball(const pps_launch *l, const double point[3],
                        const double to[3]) {
    double d[3];
    vec_sub(point, l->center, d);
    double along = vec_dot(d, to);
    return vec_dot(d, d) - along * along < l->radius * l->radius;
}

/* Light from the ground around: the ray starts at the ball, or on the ground if that comes
 * later. False where the ground point is not lit from outside. */
static bool start_from_ground(const pps_launch *l, uint64_t i, pps_launch_kind kind,
                              pps_light_ray *ray) {
    pps_line *line = &ray->line;
    double at[3], to[3];
    double behind = (line->origin[2] - l->scene->ground.height) / line->direction[2];
    vec_along(line->origin, -behind, line->direction, at);
    if (kind == PPS_LAUNCH_SUN_GROUND) {
        memcpy(to, l->scene->sun.to, sizeof to);
    } else {
        pps_uniforms r = pps_random(l->seed, PPS_RANDOM_SKY, i, GROUND_LIGHT);
        pps_bounce_lambert(UP, 1, r.u[0], r.u[1], to);
        for (int b = 0; b < l->scene->n_bands; b++) {
            double mean = mean_radiance(&l->scene->sky, b, true);
            ray->q[b] =
                mean > 0 ? pps_sky_radiance(&l->scene->sky, b, to[2]) / mean : 0;
        }
    }
    if (behind < 0) {
        memcpy(line->origin, at, sizeof at);
    }
    return !passes_ball(l, at, to);
}

/* The direction that a ray of the sky comes from, and its share of the mean. */
static void from_sky(const pps_launch *l, pps_launch_kind kind, const pps_uniforms *r,
                     double to[3], pps_light_ray *ray) {
    bool up = kind == PPS_LAUNCH_SKY;
    double z = l->periodic ? sqrt(r->u[2]) : r->u[2], s = sqrt(1 - z * z);
    to[0] = s * cos(2 * PI * r->u[3]);
    to[1] = s * sin(2 * PI * r->u[3]);
    to[2] = up ? z : -z;
    for (int b = 0; b < l->scene->n_bands && up; b++) {
        double mean = mean_radiance(&l->scene->sky, b, l->periodic);
        ray->q[b] = mean > 0 ? pps_sky_radiance(&l->scene->sky, b, z) / mean : 0;
    }
}

void pps_launch_ray(const pps_launch *l, uint64_t i, pps_light_ray *ray) {
    pps_launch_kind kind = kind_of(l, i);
    pps_uniforms r = pps_random(l->seed, pps_launch_stream(l, i), i, START);
    double to[3];
    *ray = (pps_light_ray){.unit = l->unit[kind], .q = {1, 1, 1, 1}};
    ray->source = sources_of(kind) & (PPS_SUN | PPS_SKY);
    if (kind == PPS_LAUNCH_SUN) {
        memcpy(to, l->scene->sun.to, sizeof to);
    } else {
        from_sky(l, kind, &r, to, ray);
    }
    (l->periodic ? aim_at_layer : aim_at_ball)(l, to, r.u[0], r.u[1], &ray->line);
    if (kind == PPS_LAUNCH_SUN_GROUND || kind == PPS_LAUNCH_SKY_GROUND) {
        ray->source = sources_of(kind);
        if (!start_from_ground(l, i, kind, ray)) {
            memset(ray->q, 0, sizeof ray->q);
        }
    }
}
