/* Species from JSON: every member by its pointer, within its range, none unknown.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/species.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "tree/builtin.h"

/* ---- numbers by pointer ---- */

typedef struct {
    const char *pointer;
    size_t offset;
    double low, high;
} number;

static const number NUMBERS[] = {
#define X(pointer, member, low, high)                                                  \
    {pointer, offsetof(pps_species, member), low, high},
#include "tree/species.def"
#undef X
};
enum { N_NUMBERS = sizeof NUMBERS / sizeof *NUMBERS };

/* Counts, which must be whole. */
static const char *const WHOLE[] = {"/triangles",     "/stems/count",  "/stems/forks",
                                    "/crown/limbs",   "/crown/points", "/tiers/count",
                                    "/tiers/levels",  "/wood/sides",   "/leaves/whorl",
                                    "/leaves/cluster"};

/* Members that are no single number. */
static const char *const OTHERS[] = {
    "/summary",        "/crown/profile",      "/wood/color",
    "/leaves/outline", "/leaves/reflectance", "/leaves/transmittance"};

typedef struct {
    const char *name; /* of the file or the species, for messages */
    const json_t *root;
    pps_problem *problem;
} reader;

__attribute__((format(printf, 2, 3))) static pps_status
refuse(const reader *r, const char *format, ...) {
    if (r->problem) {
        char what[400];
        va_list args;
        va_start(args, format);
        vsnprintf(what, sizeof what, format, args);
        va_end(args);
        snprintf(r->problem->text, sizeof r->problem->text, "%.100s: %s", r->name,
                 what);
    }
    return PPS_ERR_FORMAT;
}

/* The value at "/group/member" or "/member"; NULL: there is none. */
static const json_t *find(const reader *r, const char *pointer) {
    const char *slash = strchr(pointer + 1, '/');
    if (!slash) {
        return json_object_get(r->root, pointer + 1);
    }
    return json_object_get(
        json_object_getn(r->root, pointer + 1, (size_t)(slash - pointer - 1)),
        slash + 1);
}

static bool listed(const char *const *list, size_t n, const char *pointer) {
    for (size_t i = 0; i < n; i++) {
        if (strcmp(list[i], pointer) == 0) {
            return true;
        }
    }
    return false;
}

static pps_status read_number(const reader *r, const number *n, pps_species *out) {
    const json_t *value = find(r, n->pointer);
    bool whole = listed(WHOLE, sizeof WHOLE / sizeof *WHOLE, n->pointer);
    double x = json_number_value(value);
    if (!value) {
        return refuse(r, "%s is missing", n->pointer);
    }
    if (!json_is_number(value) || !(x >= n->low && x <= n->high) ||
        (whole && x != floor(x))) {
        char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6));
        refuse(r, "%s: %.60s is not %s from %g to %g", n->pointer, text ? text : "",
               whole ? "a whole number" : "a number", n->low, n->high);
        free(text);
        return PPS_ERR_FORMAT;
    }
    memcpy((char *)out + n->offset, &x, sizeof x);
    return PPS_OK;
}

/* A list of pairs, `least` to `most` of them, each number at most `limit` in size. */
static pps_status read_pairs(const reader *r, const char *pointer, size_t least,
                             size_t most, double limit, double (*out)[2], size_t *n) {
    const json_t *list = find(r, pointer);
    *n = json_array_size(list);
    if (*n < least || *n > most) {
        return refuse(r, "%s is not a list of %zu to %zu pairs", pointer, least, most);
    }
    for (size_t i = 0; i < *n; i++) {
        const json_t *pair = json_array_get(list, i);
        for (size_t k = 0; k < 2; k++) {
            const json_t *value = json_array_get(pair, k);
            out[i][k] = json_number_value(value);
            if (json_array_size(pair) != 2 || !json_is_number(value) ||
                !(fabs(out[i][k]) <= limit)) {
                return refuse(r, "%s/%zu is not two numbers of at most %g", pointer, i,
                              limit);
            }
        }
    }
    return PPS_OK;
}

static pps_status read_color(const reader *r, const char *pointer, double out[3]) {
    const json_t *list = find(r, pointer);
    for (size_t i = 0; i < 3; i++) {
        const json_t *value = json_array_get(list, i);
        out[i] = json_number_value(value);
        if (json_array_size(list) != 3 || !json_is_number(value) ||
            !(out[i] >= 0 && out[i] <= 1)) {
            return refuse(r, "%s is not three numbers from 0 to 1", pointer);
        }
    }
    return PPS_OK;
}

/* ---- what must hold between them ---- */

static pps_status check_profile(const reader *r, const pps_species *s) {
    for (size_t i = 0; i < s->crown.n_profile; i++) {
        const double *at = s->crown.profile[i];
        if (!(at[0] >= 0 && at[1] >= 0.01) ||
            (i && !(at[0] > s->crown.profile[i - 1][0]))) {
            return refuse(r,
                          "/crown/profile/%zu: heights start at 0 or above and ascend, "
                          "radii are 0.01 or more",
                          i);
        }
    }
    return PPS_OK;
}

/* The blade is a fan about its base: seen from there the outline must turn one way. */
static pps_status check_outline(const reader *r, const pps_species *s) {
    for (size_t i = 1; i < s->leaves.n_outline; i++) {
        const double *a = s->leaves.outline[i - 1], *b = s->leaves.outline[i];
        if (!(a[0] * b[1] - a[1] * b[0] > 1e-6)) {
            return refuse(r,
                          "/leaves/outline/%zu does not lie counter-clockwise of the "
                          "point before it, seen from the base (0, 0)",
                          i);
        }
    }
    return PPS_OK;
}

static pps_status check_pairs_of_numbers(const reader *r, const pps_species *s) {
    const struct {
        const char *low, *high;
        bool good;
    } order[] = {
        {"/growth/step", "/growth/kill", s->growth.step <= s->growth.kill},
        {"/tiers/least_radius", "/tiers/most_radius",
         s->tiers.radius[0] <= s->tiers.radius[1]},
        {"/leaves/least_forward", "/leaves/most_forward",
         s->leaves.forward[0] <= s->leaves.forward[1]},
        {"/leaves/least_stalk", "/leaves/most_stalk",
         s->leaves.stalk[0] <= s->leaves.stalk[1]},
        {"/wood/twig_radius", "/wood/trunk_radius",
         s->wood.twig_radius <= s->wood.trunk_radius},
        {"/wood/twig_radius", "/leaves/wood_below",
         s->wood.twig_radius <= s->leaves.wood_below},
    };
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        if (!order[i].good) {
            return refuse(r, "%s must not be above %s", order[i].low, order[i].high);
        }
    }
    for (int i = 0; i < 3; i++) {
        if (s->leaves.reflectance[i] + s->leaves.transmittance[i] > 1) {
            return refuse(r,
                          "/leaves/transmittance/%d: with the reflectance it is more "
                          "than 1",
                          i);
        }
    }
    return PPS_OK;
}

static bool known(const char *pointer) {
    for (size_t i = 0; i < N_NUMBERS; i++) {
        if (strcmp(NUMBERS[i].pointer, pointer) == 0) {
            return true;
        }
    }
    return listed(OTHERS, sizeof OTHERS / sizeof *OTHERS, pointer);
}

/* Members of no meaning are spelling mistakes. */
static pps_status check_members(const reader *r, const json_t *object,
                                const char *prefix) {
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value) {
        char pointer[128];
        snprintf(pointer, sizeof pointer, "%s/%.60s", prefix, key);
        bool group = !*prefix && json_is_object(value);
        pps_status status = group ? check_members(r, value, pointer) : PPS_OK;
        if (status) {
            return status;
        }
        if (!group && !known(pointer)) {
            return refuse(r, "%s is not a member of a species", pointer);
        }
    }
    return PPS_OK;
}

static pps_status read_species(const reader *r, pps_species *out) {
    if (!json_is_object(r->root)) {
        return refuse(r, "not a JSON object");
    }
    pps_status status = check_members(r, r->root, "");
    for (size_t i = 0; i < N_NUMBERS && !status; i++) {
        status = read_number(r, &NUMBERS[i], out);
    }
    if (!status) {
        status = read_pairs(r, "/crown/profile", 2, PPS_PROFILE_POINTS, 100,
                            out->crown.profile, &out->crown.n_profile);
    }
    if (!status) {
        status = read_pairs(r, "/leaves/outline", 2, PPS_OUTLINE_POINTS, 10,
                            out->leaves.outline, &out->leaves.n_outline);
    }
    const struct {
        const char *pointer;
        double *at;
    } colors[] = {{"/wood/color", out->wood.color},
                  {"/leaves/reflectance", out->leaves.reflectance},
                  {"/leaves/transmittance", out->leaves.transmittance}};
    for (size_t i = 0; i < 3 && !status; i++) {
        status = read_color(r, colors[i].pointer, colors[i].at);
    }
    status = status ? status : check_profile(r, out);
    status = status ? status : check_outline(r, out);
    return status ? status : check_pairs_of_numbers(r, out);
}

/* ---- where it comes from ---- */

static bool is_file(const char *name) {
    size_t n = strlen(name);
    return strchr(name, '/') || (n > 5 && strcmp(name + n - 5, ".json") == 0);
}

/* json is NULL when it could not be read, and error says why. */
static pps_status from_json(json_t *json, const json_error_t *error, reader *r,
                            pps_species *out) {
    if (!json) {
        bool file = json_error_code(error) == json_error_cannot_open_file;
        if (file) {
            refuse(r, "cannot be read");
            return PPS_ERR_FILE;
        }
        return refuse(r, "line %d: %s", error->line, error->text);
    }
    r->root = json;
    pps_status status = read_species(r, out);
    json_decref(json);
    return status;
}

pps_status pps_species_read(const char *name, pps_species *out, pps_problem *problem) {
    reader r = {name, NULL, problem};
    json_error_t error;
    memset(out, 0, sizeof *out);
    if (is_file(name)) {
        json_t *json = json_load_file(name, JSON_REJECT_DUPLICATES, &error);
        return from_json(json, &error, &r, out);
    }
    const char *text = pps_builtin_find(pps_builtin_species, name);
    if (!text) {
        return pps_builtin_missing(pps_builtin_species, "species", name, problem);
    }
    return from_json(json_loads(text, JSON_REJECT_DUPLICATES, &error), &error, &r, out);
}
