/* The instances of a scene file: plants one by one, and grids of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/random.h"
#include "tree/scene_read.h"

enum { MOST_INSTANCES = 1000000, MOST_ACROSS = 1000 };

/* The number of a prototype by its name; with a single prototype it need not be named. */
static pps_status read_prototype(const pps_json *at, const pps_scene *scene, int *out) {
    pps_json name = pps_json_key(at, "prototype");
    const char *words[64];
    size_t number = 0, n = scene->n_prototypes < 64 ? scene->n_prototypes : 64;
    *out = 0;
    if (!name.value && scene->n_prototypes == 1) {
        return PPS_OK;
    }
    for (size_t i = 0; i < scene->n_prototypes && json_is_string(name.value); i++) {
        if (strcmp(scene->prototype[i].name, json_string_value(name.value)) == 0) {
            *out = (int)i;
            return PPS_OK;
        }
    }
    for (size_t i = 0; i < n; i++) {
        words[i] = scene->prototype[i].name;
    }
    return pps_json_word(&name, words, n, &number);
}

/* The smallest power of 2 that holds n: the list's room. */
static size_t room_for(size_t n) {
    size_t room = 1;
    while (room < n) {
        room *= 2;
    }
    return room;
}

static pps_status grow_list(const pps_json *at, pps_scene *scene, size_t more) {
    size_t n = scene->n_instances + more;
    if (n > MOST_INSTANCES) {
        return pps_json_fail(at, "makes %zu instances; the most are %d", n,
                             MOST_INSTANCES);
    }
    if (scene->n_instances && n <= room_for(scene->n_instances)) {
        return PPS_OK;
    }
    pps_instance *list = calloc(room_for(n), sizeof *list);
    if (!list) {
        return PPS_ERR_MEMORY;
    }
    if (scene->n_instances) {
        memcpy(list, scene->instance, scene->n_instances * sizeof *list);
    }
    free(scene->instance);
    scene->instance = list;
    return PPS_OK;
}

static pps_status read_one(const pps_json *at, pps_scene *scene) {
    static const char *const KEYS[] = {"prototype", "translation", "yaw", "scale",
                                       NULL};
    pps_json translation = pps_json_key(at, "translation");
    pps_json yaw = pps_json_key(at, "yaw"), scale = pps_json_key(at, "scale");
    pps_instance one = {.scale = 1};
    pps_status status = pps_json_keys(at, KEYS);
    if (!status) {
        status = read_prototype(at, scene, &one.prototype);
    }
    if (!status && translation.value) {
        status = pps_json_numbers(&translation, 3, PPS_ANY, one.translation);
    }
    if (!status && yaw.value) {
        status = pps_json_number(&yaw, PPS_ANY, &one.yaw);
    }
    if (!status && scale.value) {
        status = pps_json_number(&scale, PPS_POSITIVE, &one.scale);
    }
    if (!status) {
        status = grow_list(at, scene, 1);
    }
    if (!status) {
        scene->instance[scene->n_instances++] = one;
    }
    return status;
}

/* ---- grids ---- */

typedef struct {
    int64_t n[2], seed;
    int prototype;
    double spacing[2], jitter, center[3], yaw_step, scale[2];
} grid;

/* One number, or [low, high]. */
static pps_status read_scale(const pps_json *at, double out[2]) {
    pps_status status = pps_json_spread(at, 2, PPS_POSITIVE, out);
    return !status && out[0] > out[1]
               ? pps_json_fail(at, "is [%g, %g]; the lower end comes first", out[0],
                               out[1])
               : status;
}

static pps_status read_count(const pps_json *at, int64_t out[2]) {
    pps_status status = PPS_OK;
    if (!json_is_array(at->value) || json_array_size(at->value) != 2) {
        return pps_json_refuse(at, "an array of 2 whole numbers");
    }
    for (size_t i = 0; !status && i < 2; i++) {
        pps_json element = pps_json_element(at, i);
        status = pps_json_integer(&element, 1, MOST_ACROSS, &out[i]);
    }
    return status;
}

static pps_status read_grid(const pps_json *at, const pps_scene *scene, grid *out) {
    static const char *const KEYS[] = {"grid",   "prototype", "spacing",
                                       "jitter", "seed",      "center",
                                       "scale",  "yaw_step",  NULL};
    pps_json n = pps_json_key(at, "grid"), spacing = pps_json_key(at, "spacing");
    pps_json jitter = pps_json_key(at, "jitter"), seed = pps_json_key(at, "seed");
    pps_json center = pps_json_key(at, "center"), scale = pps_json_key(at, "scale");
    pps_json yaw = pps_json_key(at, "yaw_step");
    pps_status status = pps_json_keys(at, KEYS);
    if (!status) {
        status = read_count(&n, out->n);
    }
    if (!status) {
        status = read_prototype(at, scene, &out->prototype);
    }
    if (!status) {
        status = pps_json_spread(&spacing, 2, PPS_POSITIVE, out->spacing);
    }
    if (!status && jitter.value) {
        status =
            pps_json_number(&jitter, (pps_json_range){0, 0.5, false}, &out->jitter);
    }
    if (!status && seed.value) {
        status = pps_json_integer(&seed, 0, INT64_MAX, &out->seed);
    }
    if (!status && center.value) {
        status = pps_json_numbers(&center, 3, PPS_ANY, out->center);
    }
    if (!status && yaw.value) {
        status = pps_json_number(&yaw, (pps_json_range){0, 360, true}, &out->yaw_step);
    }
    if (!status && scale.value) {
        status = read_scale(&scale, out->scale);
    }
    return status;
}

/* Plant k of a grid: its cell, moved by up to `jitter` spacings each way. */
static pps_instance plant(const grid *g, int64_t k) {
    int64_t cell[2] = {k % g->n[0], k / g->n[0]};
    pps_uniforms place =
        pps_random((uint64_t)g->seed, PPS_RANDOM_SCENE, (uint64_t)k, 0);
    pps_instance one = {.prototype = g->prototype};
    for (int i = 0; i < 2; i++) {
        double offset = (double)cell[i] + 0.5 - (double)g->n[i] / 2 +
                        g->jitter * (2 * place.u[i] - 1);
        one.translation[i] = g->center[i] + g->spacing[i] * offset;
    }
    one.translation[2] = g->center[2];
    one.yaw = g->yaw_step > 0
                  ? g->yaw_step * floor(place.u[2] * floor(360 / g->yaw_step))
                  : 360 * place.u[2];
    one.scale = g->scale[0] + place.u[3] * (g->scale[1] - g->scale[0]);
    return one;
}

static pps_status add_grid(const pps_json *at, pps_scene *scene) {
    grid g = {.scale = {1, 1}};
    pps_status status = read_grid(at, scene, &g);
    if (!status) {
        status = grow_list(at, scene, (size_t)(g.n[0] * g.n[1]));
    }
    for (int64_t k = 0; !status && k < g.n[0] * g.n[1]; k++) {
        scene->instance[scene->n_instances++] = plant(&g, k);
    }
    return status;
}

pps_status pps_scene_read_instances(const pps_json *root, pps_scene *scene) {
    pps_json list = pps_json_key(root, "instances");
    if (!list.value && scene->n_prototypes == 1) { /* the one plant, where it stands */
        pps_status status = grow_list(&list, scene, 1);
        scene->n_instances = status ? 0 : 1;
        if (!status) {
            scene->instance[0].scale = 1;
        }
        return status;
    }
    if (!json_is_array(list.value) || json_array_size(list.value) == 0) {
        return pps_json_refuse(&list, "an array of instances, not empty");
    }
    pps_status status = PPS_OK;
    for (size_t i = 0; !status && i < json_array_size(list.value); i++) {
        pps_json one = pps_json_element(&list, i);
        status = json_object_get(one.value, "grid") ? add_grid(&one, scene)
                                                    : read_one(&one, scene);
    }
    return status;
}
