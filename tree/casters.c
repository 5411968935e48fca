/* Balls about plants, and which of them a light meets before others.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/casters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;
enum { PERIODS = 3 }; /* neighbouring periods looked at, to each side */

/* ---- places ---- */

static void set_ball(const pps_scene *scene, pps_caster *c) {
    const pps_instance *instance = &scene->instance[c->instance];
    const pps_mesh *mesh = scene->prototype[instance->prototype].mesh;
    pps_mesh_size size;
    double middle[3], half[3];
    pps_mesh_measure(mesh, &size);
    for (int i = 0; i < 3; i++) {
        middle[i] = (size.low[i] + size.high[i]) / 2;
        half[i] = (size.high[i] - size.low[i]) / 2;
    }
    pps_instance_point(instance, middle, c->center);
    for (int i = 0; i < 3; i++) {
        c->center[i] += c->translation[i] - instance->translation[i];
    }
    c->radius = instance->scale * vec_length(half);
}

pps_status pps_casters_create(const pps_scene *scene, pps_casters *out) {
    bool repeats = scene->period[0] > 0;
    int reach = repeats ? PERIODS : 0;
    size_t side = (size_t)(2 * reach + 1), n = scene->n_instances;
    *out = (pps_casters){.n_instances = n};
    out->caster = calloc(n * side * side, sizeof *out->caster);
    if (!out->caster) {
        return PPS_ERR_MEMORY;
    }
    for (int pass = 0; pass < 2; pass++) { /* those at their own places come first */
        for (int k = 0; k < (int)(side * side); k++) {
            int x = k % (int)side - reach, y = k / (int)side - reach;
            bool home = x == 0 && y == 0;
            for (size_t i = 0; home == (pass == 0) && i < n; i++) {
                pps_caster *c = &out->caster[out->n++];
                c->instance = i;
                memcpy(c->translation, scene->instance[i].translation,
                       sizeof c->translation);
                c->translation[0] += x * scene->period[0];
                c->translation[1] += y * scene->period[1];
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        set_ball(scene, &out->caster[i]);
    }
    for (size_t i = n; i < out->n; i++) { /* the same ball, moved */
        pps_caster *c = &out->caster[i];
        const pps_caster *home = &out->caster[c->instance];
        c->radius = home->radius;
        for (int k = 0; k < 3; k++) {
            c->center[k] = home->center[k] + c->translation[k] - home->translation[k];
        }
    }
    return PPS_OK;
}

void pps_casters_free(pps_casters *casters) {
    free(casters->caster);
    *casters = (pps_casters){0};
}

void pps_caster_own(const pps_scene *scene, const pps_caster *caster,
                    const double point[3], double own[3]) {
    const pps_instance *instance = &scene->instance[caster->instance];
    double c = cos(instance->yaw * DEGREE), s = sin(instance->yaw * DEGREE), off[3];
    vec_sub(point, caster->translation, off);
    own[0] = (c * off[0] + s * off[1]) / instance->scale;
    own[1] = (c * off[1] - s * off[0]) / instance->scale;
    own[2] = off[2] / instance->scale;
}

void pps_caster_own_direction(const pps_scene *scene, const pps_caster *caster,
                              const double direction[3], double own[3]) {
    pps_instance back = {.yaw = -scene->instance[caster->instance].yaw, .scale = 1};
    pps_instance_direction(&back, direction, own);
}

/* ---- who shades whom ---- */

static bool may_shade(const pps_caster *by, const pps_caster *of, const double to[3],
                      bool both) {
    double off[3], beside[3], reach = by->radius + of->radius;
    vec_sub(by->center, of->center, off);
    double ahead = vec_dot(off, to);
    vec_along(off, -ahead, to, beside);
    return (both || ahead > -reach) && vec_length(beside) < reach;
}

pps_status pps_shade_find(const pps_casters *casters, const double to[3], bool both,
                          pps_shade *out) {
    size_t n = casters->n_instances, total = 0;
    *out = (pps_shade){.first = calloc(n + 1, sizeof *out->first)};
    for (int pass = 0; pass < 2 && out->first; pass++) { /* count, then write down */
        total = 0;
        for (size_t i = 0; i < n; i++) {
            out->first[i] = total;
            for (size_t k = 0; k < casters->n; k++) {
                if (may_shade(&casters->caster[k], &casters->caster[i], to, both)) {
                    if (pass == 1) {
                        out->list[total] = (uint32_t)k;
                    }
                    total++;
                }
            }
        }
        out->first[n] = total;
        if (pass == 0) {
            out->list = malloc((total + 1) * sizeof *out->list);
            if (!out->list) {
                break;
            }
        }
    }
    if (!out->first || !out->list) {
        pps_shade_free(out);
        return PPS_ERR_MEMORY;
    }
    return PPS_OK;
}

void pps_shade_free(pps_shade *shade) {
    free(shade->first);
    free(shade->list);
    *shade = (pps_shade){0};
}
