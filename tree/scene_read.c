/* Scene files: bands, plants, sun, sky and ground, as docs/tree-files.md has them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/scene_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tree/builtin.h"
#include "tree/path.h"
#include "tree/problem.h"
#include "tree/sun.h"
#include "tree/text.h"
#include "tree/vec.h"

/* ---- bands ---- */

static pps_status add_band(const pps_json *at, pps_scene *scene, const char *name) {
    for (int b = 0; b < scene->n_bands; b++) {
        if (strcmp(scene->band[b], name) == 0) {
            return pps_json_fail(at, "is \"%.40s\", which comes twice", name);
        }
    }
    char *copy = text_copy(name);
    if (!copy) {
        return PPS_ERR_MEMORY;
    }
    scene->band[scene->n_bands++] = copy;
    return PPS_OK;
}

static pps_status read_bands(const pps_json *root, pps_scene *scene) {
    static const char *const COLORS[] = {"red", "green", "blue"};
    pps_json bands = pps_json_key(root, "bands");
    size_t n = bands.value ? json_array_size(bands.value) : 3;
    pps_status status = PPS_OK;
    if (n < 1 || n > PPS_BANDS_MAX) {
        return pps_json_refuse(&bands, "an array of 1 to 4 names");
    }
    for (size_t i = 0; !status && i < n; i++) {
        pps_json one = pps_json_element(&bands, i);
        const char *name = COLORS[i % 3];
        status = bands.value ? pps_json_string(&one, &name) : PPS_OK;
        if (!status) {
            status = add_band(&one, scene, name);
        }
    }
    return status;
}

/* ---- sun ---- */

static pps_status read_direction(const pps_json *at, double to[3]) {
    pps_status status = pps_json_numbers(at, 3, PPS_ANY, to);
    if (!status && !(vec_length(to) > 0 && isfinite(vec_length(to)))) {
        status =
            pps_json_fail(at, "has no direction: its length is %g", vec_length(to));
    }
    if (!status) {
        vec_normalize(to);
    }
    return status;
}

/* From place and time; a sun below the horizon is an error, as night is seldom meant. */
static pps_status read_place(const pps_json *sun, double to[3]) {
    pps_json latitude = pps_json_key(sun, "latitude");
    pps_json longitude = pps_json_key(sun, "longitude");
    pps_json time = pps_json_key(sun, "time");
    double north = 0, east = 0, julian;
    const char *text = json_string_value(time.value);
    pps_status status =
        pps_json_number(&latitude, (pps_json_range){-90, 90, false}, &north);
    if (!status) {
        status = pps_json_number(&longitude, (pps_json_range){-180, 360, false}, &east);
    }
    if (!status && !(text && pps_sun_julian(text, &julian))) {
        status = pps_json_refuse(&time, PPS_SUN_TIME);
    }
    if (!status) {
        status = pps_sun_direction(north, east, text, to, sun->file->problem);
    }
    if (!status && to[2] <= 0) {
        status = pps_json_fail(&time, "the sun is %.2f degrees below the horizon then",
                               -asin(to[2]) * 180 / 3.14159265358979323846);
    }
    return status;
}

static pps_status read_sun(const pps_json *root, pps_scene *scene) {
    static const char *const BY_DIRECTION[] = {"direction", "irradiance", NULL};
    static const char *const BY_PLACE[] = {"latitude", "longitude", "time",
                                           "irradiance", NULL};
    static const char *const ANY[] = {"direction", "latitude",   "longitude",
                                      "time",      "irradiance", NULL};
    pps_json sun = pps_json_key(root, "sun");
    pps_json direction = pps_json_key(&sun, "direction");
    pps_json irradiance = pps_json_key(&sun, "irradiance");
    bool place = json_object_get(sun.value, "latitude") ||
                 json_object_get(sun.value, "longitude") ||
                 json_object_get(sun.value, "time");
    scene->sun.to[2] = 1;
    if (!sun.value) {
        return PPS_OK;
    }
    pps_status status = pps_json_keys(&sun, ANY);
    if (!status && place && direction.value) {
        return pps_json_fail(&sun,
                             "has both a direction and a place or time; give one");
    }
    if (!status) {
        status = pps_json_keys(&sun, place ? BY_PLACE : BY_DIRECTION);
    }
    if (!status) {
        status = place ? read_place(&sun, scene->sun.to)
                       : read_direction(&direction, scene->sun.to);
    }
    for (int b = 0; b < scene->n_bands; b++) {
        scene->sun.irradiance[b] = 1;
    }
    return !status && irradiance.value
               ? pps_json_spread(&irradiance, (size_t)scene->n_bands, PPS_NOT_NEGATIVE,
                                 scene->sun.irradiance)
               : status;
}

/* ---- sky, ground, period ---- */

/* A radiance for the whole dome, or one each for zenith, horizon and below. */
static pps_status read_sky(const pps_json *root, pps_scene *scene) {
    static const char *const KEYS[] = {"zenith", "horizon", "below", NULL};
    pps_json sky = pps_json_key(root, "sky");
    double *const to[] = {scene->sky.zenith, scene->sky.horizon, scene->sky.below};
    size_t n = (size_t)scene->n_bands;
    if (!sky.value) {
        return PPS_OK;
    }
    if (!json_is_object(sky.value)) {
        pps_status status = pps_json_spread(&sky, n, PPS_NOT_NEGATIVE, to[0]);
        memcpy(to[1], to[0], n * sizeof **to);
        return status;
    }
    pps_status status = pps_json_keys(&sky, KEYS);
    for (int i = 0; !status && i < 3; i++) {
        pps_json part = pps_json_key(&sky, KEYS[i]);
        bool needed = i < 2;
        status = part.value || needed
                     ? pps_json_spread(&part, n, PPS_NOT_NEGATIVE, to[i])
                     : PPS_OK;
    }
    return status;
}

static pps_status read_ground(const pps_json *root, pps_scene *scene) {
    static const char *const KEYS[] = {"height", "reflectance", NULL};
    pps_json ground = pps_json_key(root, "ground");
    pps_json height = pps_json_key(&ground, "height");
    pps_json reflectance = pps_json_key(&ground, "reflectance");
    if (!ground.value) {
        return PPS_OK;
    }
    scene->ground.present = true;
    pps_status status = pps_json_keys(&ground, KEYS);
    if (!status && height.value) {
        status = pps_json_number(&height, PPS_ANY, &scene->ground.height);
    }
    if (!status) {
        status = pps_json_spread(&reflectance, (size_t)scene->n_bands, PPS_SHARE,
                                 scene->ground.reflectance);
    }
    return status;
}

static pps_status read_period(const pps_json *root, pps_scene *scene) {
    pps_json period = pps_json_key(root, "period");
    return period.value ? pps_json_spread(&period, 2, PPS_POSITIVE, scene->period)
                        : PPS_OK;
}

/* What would light nothing. */
static pps_status check_light(const pps_json *root, const pps_scene *scene) {
    pps_json sun = pps_json_key(root, "sun"),
             direction = pps_json_key(&sun, "direction");
    if (!sun.value && !json_object_get(root->value, "sky")) {
        return pps_json_fail(root, "there is no light: give \"sun\", \"sky\" or both");
    }
    return sun.value && scene->ground.present && scene->sun.to[2] <= 0
               ? pps_json_fail(&direction, "is from below the ground")
               : PPS_OK;
}

/* ---- the document ---- */

static pps_status read_document(const pps_json *root, pps_scene *scene) {
    static const char *const KEYS[] = {"bands", "prototypes", "instances", "sun",
                                       "sky",   "ground",     "period",    NULL};
    pps_status (*const part[])(const pps_json *, pps_scene *) = {
        read_bands,
        read_sun,
        read_sky,
        read_ground,
        read_period,
        pps_scene_read_prototypes,
        pps_scene_read_instances}; /* plants last: they take time */
    pps_status status = pps_json_keys(root, KEYS);
    for (size_t i = 0; !status && i < sizeof part / sizeof *part; i++) {
        status = part[i](root, scene);
        if (!status && part[i] == read_period) {
            status = check_light(root, scene);
        }
    }
    return status ? status : pps_scene_index(scene);
}

/* text: that of a scene that comes with the library; NULL: a file's. */
static pps_status read_json(const char *path, const char *text, pps_scene **out,
                            pps_problem *problem) {
    pps_json_file file = {path, problem};
    pps_json root;
    pps_status status = text ? pps_json_parse(&file, text, strlen(text), &root)
                             : pps_json_load(&file, &root);
    if (status) {
        return status;
    }
    pps_scene *scene = calloc(1, sizeof *scene);
    status = scene ? read_document(&root, scene) : PPS_ERR_MEMORY;
    json_decref(root.value);
    if (status) {
        pps_scene_free(scene);
        return status;
    }
    *out = scene;
    return PPS_OK;
}

static pps_status read_mesh(const char *path, pps_scene **out, pps_problem *problem) {
    pps_mesh *mesh;
    pps_status status = pps_mesh_read(path, NULL, &mesh, problem);
    return status ? status : pps_scene_of_mesh(mesh, out);
}

pps_status pps_scene_read(const char *name, pps_scene **out, pps_problem *problem) {
    bool file = strpbrk(name, "./");
    const char *text = file ? NULL : pps_builtin_find(pps_builtin_scenes, name);
    pps_status status;
    *out = NULL;
    if (text || pps_path_ends(name, ".json")) {
        status = read_json(name, text, out, problem);
    } else if (file) {
        status = read_mesh(name, out, problem);
    } else {
        return pps_builtin_missing(pps_builtin_scenes, "scene", name, problem);
    }
    if (status == PPS_ERR_MEMORY) {
        pps_complain(problem, status, "%s: out of memory", name);
    }
    return status;
}

/* ---- a bare mesh ---- */

/* Sun and sky of a clear day: the sky gives a fifth of the light, and is blue. */
static void light_of_day(pps_scene *scene) {
    static const double SUN[3] = {1, 0.95, 0.87}, ZENITH[3] = {0.030, 0.045, 0.080};
    static const double HORIZON[3] = {0.095, 0.105, 0.120};
    static const double GROUND[3] = {0.13, 0.14, 0.07};
    const double to[3] = {-0.45, -0.45, 0.77};
    memcpy(scene->sun.to, to, sizeof to);
    vec_normalize(scene->sun.to);
    memcpy(scene->sun.irradiance, SUN, sizeof SUN);
    memcpy(scene->sky.zenith, ZENITH, sizeof ZENITH);
    memcpy(scene->sky.horizon, HORIZON, sizeof HORIZON);
    memcpy(scene->ground.reflectance, GROUND, sizeof GROUND);
    scene->ground.present = true;
}

pps_status pps_scene_of_mesh(pps_mesh *mesh, pps_scene **out) {
    static const char *const COLORS[] = {"red", "green", "blue"};
    pps_scene *scene;
    pps_status status = pps_scene_single(mesh, 0, &scene);
    *out = NULL;
    if (status) {
        return status;
    }
    for (int b = 0; b < 3; b++) {
        free(scene->band[b]);
        scene->band[b] = text_copy(COLORS[b]);
        status = scene->band[b] ? status : PPS_ERR_MEMORY;
    }
    if (status) {
        pps_scene_free(scene);
        return status;
    }
    pps_mesh_size size;
    pps_mesh_measure(mesh, &size);
    scene->n_bands = 3;
    light_of_day(scene);
    scene->ground.height = size.low[2];
    pps_mesh_optics(mesh, &scene->prototype[0].optics);
    *out = scene;
    return PPS_OK;
}
