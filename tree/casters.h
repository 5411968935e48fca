/* What may stand between a plant and a distant light: the plants of the scene, as balls.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_CASTERS_H
#define PPS_TREE_CASTERS_H

#include <ppscat/tree/scene.h>

/* An instance at its place, or in a neighbouring period of a scene that repeats. */
typedef struct {
    size_t instance;
    double translation[3], center[3], radius;
} pps_caster;

/* The first of them are the instances at their own places, in order. */
typedef struct {
    size_t n_instances, n;
    pps_caster *caster;
} pps_casters;

/* For one light: the casters numbered list[first[i]] .. list[first[i + 1] - 1] may shade
 * something of instance i; it is one of them. */
typedef struct {
    size_t *first;
    uint32_t *list;
} pps_shade;

pps_status pps_casters_create(const pps_scene *scene, pps_casters *out);
void pps_casters_free(pps_casters *casters);

/* both: those on the far side count too, which lie on the light's way on. */
pps_status pps_shade_find(const pps_casters *casters, const double to[3], bool both,
                          pps_shade *out);
void pps_shade_free(pps_shade *shade);

/* From the scene into the own space of a caster. */
void pps_caster_own(const pps_scene *scene, const pps_caster *caster,
                    const double point[3], double own[3]);

/* The same for a direction. */
void pps_caster_own_direction(const pps_scene *scene, const pps_caster *caster,
                              const double direction[3], double own[3]);

#endif
