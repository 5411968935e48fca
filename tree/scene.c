/* Scenes: instances, their leaves in one row, sun, sky and ground.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/scene.h>

#include "tree/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;

void pps_scene_free(pps_scene *scene) {
    if (!scene) {
        return;
    }
    for (size_t i = 0; scene->prototype && i < scene->n_prototypes; i++) {
        free(scene->prototype[i].name);
        pps_mesh_free(scene->prototype[i].mesh);
    }
    for (int b = 0; b < PPS_BANDS_MAX; b++) {
        free(scene->band[b]);
    }
    free(scene->prototype);
    free(scene->instance);
    free(scene->first_leaf);
    free(scene);
}

static char *copy_string(const char *s) {
    char *copy = malloc(strlen(s) + 1);
    return copy ? strcpy(copy, s) : NULL;
}

pps_status pps_scene_single(pps_mesh *mesh, double albedo, pps_scene **out) {
    *out = NULL;
    pps_scene *scene = calloc(1, sizeof *scene);
    if (!scene || !mesh || !(albedo >= 0 && albedo <= 1)) {
        bool memory = !scene;
        free(scene);
        pps_mesh_free(mesh);
        return memory ? PPS_ERR_MEMORY : PPS_ERR_ARGUMENT;
    }
    scene->n_bands = 1;
    scene->band[0] = copy_string("all");
    scene->n_prototypes = scene->n_instances = 1;
    scene->prototype = calloc(1, sizeof *scene->prototype);
    scene->instance = calloc(1, sizeof *scene->instance);
    if (!scene->prototype || !scene->instance || !scene->band[0]) {
        pps_mesh_free(mesh);
        pps_scene_free(scene);
        return PPS_ERR_MEMORY;
    }
    scene->prototype[0].mesh = mesh;
    scene->prototype[0].name = copy_string("plant");
    for (int face = 0; face < 2; face++) {
        scene->prototype[0].optics.reflectance[face][0] = albedo / 2;
        scene->prototype[0].optics.transmittance[face][0] = albedo / 2;
    }
    scene->instance[0].scale = 1;
    scene->sun.to[2] = 1;
    scene->sun.irradiance[0] = 1;
    pps_status status =
        scene->prototype[0].name ? pps_scene_index(scene) : PPS_ERR_MEMORY;
    if (status) {
        pps_scene_free(scene);
        return status;
    }
    *out = scene;
    return PPS_OK;
}

static bool shares_hold(const pps_leaf_optics *o, int n_bands) {
    for (int face = 0; face < 2; face++) {
        for (int b = 0; b < n_bands; b++) {
            double r = o->reflectance[face][b], t = o->transmittance[face][b];
            if (!(r >= 0) || !(t >= 0) || !(r + t <= 1 + 1e-12)) {
                return false;
            }
        }
    }
    return true;
}

static bool scene_holds(const pps_scene *scene) {
    bool good = scene->n_bands >= 1 && scene->n_bands <= PPS_BANDS_MAX &&
                scene->n_instances >= 1 && scene->period[0] >= 0 &&
                (scene->period[0] > 0) == (scene->period[1] > 0) &&
                fabs(vec_length(scene->sun.to) - 1) < 1e-9;
    for (size_t i = 0; i < scene->n_prototypes; i++) {
        good = good && shares_hold(&scene->prototype[i].optics, scene->n_bands);
    }
    for (size_t i = 0; i < scene->n_instances; i++) {
        const pps_instance *at = &scene->instance[i];
        good = good && at->prototype >= 0 &&
               (size_t)at->prototype < scene->n_prototypes && at->scale > 0 &&
               isfinite(at->scale) && isfinite(at->yaw);
    }
    return good;
}

pps_status pps_scene_index(pps_scene *scene) {
    if (!scene || !scene_holds(scene)) {
        return PPS_ERR_ARGUMENT;
    }
    free(scene->first_leaf);
    scene->n_leaves = 0;
    scene->first_leaf = malloc(scene->n_instances * sizeof *scene->first_leaf);
    if (!scene->first_leaf) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < scene->n_instances; i++) {
        scene->first_leaf[i] = scene->n_leaves;
        scene->n_leaves +=
            scene->prototype[scene->instance[i].prototype].mesh->n_leaves;
    }
    return PPS_OK;
}

void pps_instance_direction(const pps_instance *instance, const double own[3],
                            double out[3]) {
    double c = cos(instance->yaw * DEGREE), s = sin(instance->yaw * DEGREE);
    double x = c * own[0] - s * own[1], y = s * own[0] + c * own[1], z = own[2];
    out[0] = x;
    out[1] = y;
    out[2] = z;
}

void pps_instance_point(const pps_instance *instance, const double own[3],
                        double out[3]) {
    double turned[3];
    pps_instance_direction(instance, own, turned);
    vec_along(instance->translation, instance->scale, turned, out);
}

/* The instance that leaf i belongs to: the last that starts at or before it. */
static size_t instance_of(const pps_scene *scene, size_t i) {
    size_t low = 0, high = scene->n_instances;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(scene->first_leaf[middle] <= i ? &low : &high) = middle;
    }
    return low;
}

void pps_scene_leaf_at(const pps_scene *scene, size_t i, pps_scene_leaf *out) {
    size_t k = instance_of(scene, i);
    const pps_instance *instance = &scene->instance[k];
    const pps_mesh *mesh = scene->prototype[instance->prototype].mesh;
    out->instance = k;
    out->leaf = i - scene->first_leaf[k];
    const pps_leaf *leaf = &mesh->leaf[out->leaf];
    pps_instance_point(instance, leaf->center, out->center);
    pps_instance_direction(instance, leaf->normal, out->normal);
    out->area = leaf->area * instance->scale * instance->scale;
}

void pps_scene_box(const pps_scene *scene, pps_box *all, pps_box *leaves) {
    for (int i = 0; i < 3; i++) {
        all->low[i] = leaves->low[i] = INFINITY;
        all->high[i] = leaves->high[i] = -INFINITY;
    }
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_instance *at = &scene->instance[k];
        const pps_mesh *mesh = scene->prototype[at->prototype].mesh;
        double c = cos(at->yaw * DEGREE), s = sin(at->yaw * DEGREE);
        for (size_t t = 0; t < 3 * mesh->n_triangles; t++) {
            const double *own = mesh->position[mesh->triangle[t / 3][t % 3]];
            double turned[3] = {c * own[0] - s * own[1], s * own[0] + c * own[1],
                                own[2]};
            double p[3];
            vec_along(at->translation, at->scale, turned, p);
            bool leaf = mesh->leaf_of[t / 3] != PPS_NO_LEAF;
            for (int i = 0; i < 3; i++) {
                all->low[i] = fmin(all->low[i], p[i]);
                all->high[i] = fmax(all->high[i], p[i]);
                leaves->low[i] = leaf ? fmin(leaves->low[i], p[i]) : leaves->low[i];
                leaves->high[i] = leaf ? fmax(leaves->high[i], p[i]) : leaves->high[i];
            }
        }
    }
}

double pps_sky_radiance(const pps_sky *sky, int band, double z) {
    return z < 0 ? sky->below[band]
                 : sky->horizon[band] + (sky->zenith[band] - sky->horizon[band]) * z;
}
