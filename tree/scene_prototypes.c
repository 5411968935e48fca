/* The prototypes of a scene file: meshes, species and crowns, and their leaves' optics.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>

#include "tree/path.h"
#include "tree/problem.h"
#include "tree/scene_read.h"
#include "tree/text.h"

/* ---- optics ---- */

bool pps_scene_in_color(const pps_scene *scene) {
    return scene->n_bands == 3 && strcmp(scene->band[0], "red") == 0 &&
           strcmp(scene->band[1], "green") == 0 && strcmp(scene->band[2], "blue") == 0;
}

/* What a face does not absorb is at most what falls on it. */
static pps_status check_shares(const pps_json *at, const pps_scene *scene,
                               const double *reflectance, const double *transmittance) {
    for (int b = 0; b < scene->n_bands; b++) {
        double sum = reflectance[b] + transmittance[b];
        if (sum > 1 + 1e-12) {
            return pps_json_fail(at,
                                 "reflectance + transmittance of band \"%s\" is %g; it "
                                 "must be <= 1",
                                 scene->band[b], sum);
        }
    }
    return PPS_OK;
}

static pps_status read_face(const pps_json *at, const pps_scene *scene,
                            double *reflectance, double *transmittance) {
    size_t n = (size_t)scene->n_bands;
    pps_json r = pps_json_key(at, "reflectance"), t = pps_json_key(at, "transmittance");
    pps_status status = pps_json_spread(&r, n, PPS_SHARE, reflectance);
    if (!status) {
        status = pps_json_spread(&t, n, PPS_SHARE, transmittance);
    }
    return status ? status : check_shares(at, scene, reflectance, transmittance);
}

/* Both faces alike, or each for itself. */
static pps_status read_optics(const pps_json *at, const pps_scene *scene,
                              pps_leaf_optics *out) {
    static const char *const ALIKE[] = {"reflectance", "transmittance", "front", "back",
                                        NULL};
    static const char *const *const APART = ALIKE + 2, *const FACE[] = {"front",
                                                                        "back"};
    bool apart =
        json_object_get(at->value, "front") || json_object_get(at->value, "back");
    pps_status status = pps_json_keys(at, apart ? APART : ALIKE);
    for (int face = 0; !status && face < 2; face++) {
        pps_json own = pps_json_key(at, FACE[face]);
        const pps_json *from = apart ? &own : at;
        static const char *const KEYS[] = {"reflectance", "transmittance", NULL};
        status = apart ? pps_json_keys(&own, KEYS) : PPS_OK;
        if (!status) {
            status = read_face(from, scene, out->reflectance[face],
                               out->transmittance[face]);
        }
    }
    return status;
}

/* ---- the three kinds of plants: their meshes, and optics unless NULL ---- */

static const char *const KIND[] = {"mesh", "species", "crown"};
enum { KINDS = 3 };

/* What a file's own reader says is wrong, with the place in the scene that names it. */
static pps_status pass_on(const pps_json *at, pps_status status,
                          const pps_problem *inner) {
    if (!status || status == PPS_ERR_MEMORY) {
        return status;
    }
    pps_json_fail(at, "%s", inner->text);
    return status == PPS_ERR_FILE ? status : PPS_ERR_FORMAT;
}

static pps_status read_seed(const pps_json *at, uint64_t *out) {
    pps_json seed = pps_json_key(at, "seed");
    int64_t value = 0;
    pps_status status =
        seed.value ? pps_json_integer(&seed, 0, INT64_MAX, &value) : PPS_OK;
    *out = (uint64_t)value;
    return status;
}

/* The string at a key as a path beside the scene; NULL if the key is absent. */
static pps_status read_path(const pps_json *at, char **out) {
    const char *name;
    *out = NULL;
    if (!at->value) {
        return PPS_OK;
    }
    pps_status status = pps_json_string(at, &name);
    if (!status) {
        *out = pps_path_beside(at->file->path, name);
        status = *out ? PPS_OK : PPS_ERR_MEMORY;
    }
    return status;
}

static pps_status read_mesh_options(const pps_json *at, pps_mesh_read_options *out) {
    static const char *const AXIS[] = {"x", "y", "z"};
    static const pps_up UP[] = {PPS_UP_X, PPS_UP_Y, PPS_UP_Z};
    pps_json leaf = pps_json_key(at, "leaf"), up = pps_json_key(at, "up");
    pps_json unit = pps_json_key(at, "unit");
    size_t axis = 0;
    pps_status status = leaf.value ? pps_json_string(&leaf, &out->leaf) : PPS_OK;
    if (!status && up.value) {
        status = pps_json_word(&up, AXIS, 3, &axis);
        out->up = UP[axis];
    }
    if (!status && unit.value) {
        status = pps_json_number(&unit, PPS_POSITIVE, &out->unit);
    }
    return status;
}

static pps_status read_mesh(const pps_json *at, pps_mesh **out,
                            pps_leaf_optics *optics) {
    static const char *const KEYS[] = {"mesh", "leaf",   "leaf_image", "up",
                                       "unit", "optics", NULL};
    pps_json file = pps_json_key(at, "mesh"), image = pps_json_key(at, "leaf_image");
    pps_mesh_read_options options = {.leaf = NULL};
    char *path = NULL, *leaf_image = NULL;
    pps_problem inner = {""};
    pps_status status = pps_json_keys(at, KEYS);
    if (!status) {
        status = read_mesh_options(at, &options);
    }
    if (!status) {
        status = read_path(&image, &leaf_image);
        options.leaf_image = leaf_image;
    }
    if (!status) {
        status = read_path(&file, &path);
    }
    if (!status) {
        status = pass_on(&file, pps_mesh_read(path, &options, out, &inner), &inner);
    }
    if (!status && optics) {
        pps_mesh_optics(*out, optics);
    }
    free(path);
    free(leaf_image);
    return status;
}

/* A name of a species, or a path: that has a '/' or ends in .json. */
static pps_status read_species(const pps_json *at, pps_mesh **out,
                               pps_leaf_optics *optics) {
    static const char *const KEYS[] = {"species", "seed", "optics", NULL};
    pps_json species = pps_json_key(at, "species");
    const char *name = NULL;
    char *path = NULL;
    uint64_t seed = 0;
    pps_problem inner = {""};
    pps_status status = pps_json_keys(at, KEYS);
    if (!status) {
        status = pps_json_string(&species, &name);
    }
    if (!status && (strchr(name, '/') || pps_path_ends(name, ".json"))) {
        status = read_path(&species, &path);
    }
    if (!status) {
        status = read_seed(at, &seed);
    }
    name = path ? path : name;
    if (!status) {
        status = pass_on(&species, pps_species_grow(name, seed, out, &inner), &inner);
    }
    if (!status && optics) {
        status = pass_on(&species, pps_species_optics(name, optics, &inner), &inner);
    }
    free(path);
    return status;
}

static pps_status read_crown(const pps_json *at, pps_mesh **out,
                             pps_leaf_optics *optics) {
    static const char *const KEYS[] = {"crown", "leaf_area_index", "leaves",
                                       "seed",  "optics",          NULL};
    static const char *const SHAPE[] = {"uniform", "clumped", "tall", "hollow"};
    static const pps_crown_shape VALUE[] = {PPS_CROWN_UNIFORM, PPS_CROWN_CLUMPED,
                                            PPS_CROWN_TALL, PPS_CROWN_HOLLOW};
    pps_json shape = pps_json_key(at, "crown"), leaves = pps_json_key(at, "leaves");
    pps_json index = pps_json_key(at, "leaf_area_index");
    pps_crown crown = {.n_leaves = 0};
    size_t word = 0;
    int64_t n = 0;
    pps_status status = pps_json_keys(at, KEYS);
    if (!status) {
        status = pps_json_word(&shape, SHAPE, 4, &word);
        crown.shape = VALUE[word];
    }
    if (!status) {
        status = pps_json_number(&index, PPS_POSITIVE, &crown.leaf_area_index);
    }
    if (!status && leaves.value) {
        status = pps_json_integer(&leaves, 1, 10000000, &n);
        crown.n_leaves = (uint32_t)n;
    }
    if (!status) {
        status = read_seed(at, &crown.seed);
    }
    if (!status) {
        status = pps_crown_grow(&crown, out);
    }
    if (!status && optics) {
        pps_mesh_optics(*out, optics);
    }
    return status;
}

/* ---- all of them ---- */

static pps_status read_prototype(const pps_json *at, const pps_scene *scene,
                                 pps_prototype *out) {
    static const char *const OPTICS_WANTED =
        "given where the bands are not \"red\", \"green\", \"blue\"";
    pps_status (*const read[KINDS])(const pps_json *, pps_mesh **,
                                    pps_leaf_optics *) = {read_mesh, read_species,
                                                          read_crown};
    pps_json optics = pps_json_key(at, "optics");
    int kind = -1, kinds = 0;
    if (!json_is_object(at->value)) {
        return pps_json_refuse(at, "an object");
    }
    for (int i = 0; i < KINDS; i++) {
        bool here = json_object_get(at->value, KIND[i]) != NULL;
        kind = here ? i : kind;
        kinds += here;
    }
    if (kinds != 1) {
        return pps_json_fail(
            at, "must have one of the keys \"mesh\", \"species\" and \"crown\"");
    }
    if (!optics.value && !pps_scene_in_color(scene)) {
        return pps_json_refuse(&optics, OPTICS_WANTED);
    }
    pps_status status =
        optics.value ? read_optics(&optics, scene, &out->optics) : PPS_OK;
    return status ? status
                  : read[kind](at, &out->mesh, optics.value ? NULL : &out->optics);
}

pps_status pps_scene_read_prototypes(const pps_json *root, pps_scene *scene) {
    pps_json all = pps_json_key(root, "prototypes");
    const char *name;
    json_t *value;
    size_t n = json_object_size(all.value);
    if (n == 0) {
        return pps_json_refuse(&all, "an object of prototypes by name, not empty");
    }
    scene->prototype = calloc(n, sizeof *scene->prototype);
    if (!scene->prototype) {
        return PPS_ERR_MEMORY;
    }
    json_object_foreach(all.value, name, value) {
        pps_json at = pps_json_key(&all, name);
        pps_prototype *out = &scene->prototype[scene->n_prototypes++];
        out->name = text_copy(name);
        pps_status status =
            out->name ? read_prototype(&at, scene, out) : PPS_ERR_MEMORY;
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}
