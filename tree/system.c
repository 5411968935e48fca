/* The six steps, timed; maps of the sun; leaves lit from cells and maps.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include "tree/grid.h"
#include "tree/light_model.h"
#include "tree/system_own.h"
#include "tree/vec.h"

enum { STEP_CELLS, STEP_MAPS, STEP_G, STEP_SKY, STEP_SUN, STEP_SHADE };
enum { DEFAULT_SUN_TEXELS = 256, MOST_ACROSS = 256 };

static const double PI = 3.14159265358979323846;
static const pps_system_steps *steps_of(const pps_system_own *own) {
    return own->options.way == PPS_SYSTEM_GRID ? &pps_system_grid
                                               : &pps_system_instances;
}

/* ---- poses ---- */

/* Instances of one prototype and yaw see the sun from one side: they share its map. */
static pps_status find_poses(pps_system *system) {
    const pps_scene *scene = system->scene;
    system->pose_of = calloc(scene->n_instances + 1, sizeof *system->pose_of);
    system->pose = calloc(scene->n_instances + 1, sizeof *system->pose);
    if (!system->pose_of || !system->pose) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < scene->n_instances; i++) {
        const pps_instance *at = &scene->instance[i];
        size_t p = 0;
        while (p < system->n_poses &&
               !(system->pose[p].prototype == at->prototype &&
                 fabs(remainder(system->pose[p].yaw - at->yaw, 360)) < 1e-9)) {
            p++;
        }
        if (p == system->n_poses) {
            system->pose[system->n_poses++] = (pps_pose){at->prototype, at->yaw, NULL};
        }
        system->pose_of[i] = p;
    }
    return PPS_OK;
}

static pps_status map_pose(const pps_system *system, const pps_pose *pose,
                           const double to[3], int texels, pps_opacity_map **map) {
    pps_instance back = {.yaw = -pose->yaw, .scale = 1};
    pps_opacity_options options = {.texels = texels};
    double own[3];
    pps_instance_direction(&back, to, own);
    pps_opacity_map_free(*map);
    return pps_opacity_map_create(system->scene->prototype[pose->prototype].mesh, own,
                                  &options, map);
}

pps_status pps_system_map_poses(const pps_system_own *own, const double to[3],
                                int texels, pps_opacity_map **map) {
    const pps_system *system = &own->system;
    pps_status worst = PPS_OK;
#pragma omp parallel for num_threads(own->threads) schedule(dynamic)
    for (size_t p = 0; p < system->n_poses; p++) {
        pps_status status = map_pose(system, &system->pose[p], to, texels, &map[p]);
        if (status) {
#pragma omp atomic write
            worst = status;
        }
    }
    return worst;
}

static pps_status map_sun(pps_system_own *own) {
    pps_system *system = &own->system;
    const double *to = system->scene->sun.to;
    int texels = own->options.sun_texels ? own->options.sun_texels : DEFAULT_SUN_TEXELS;
    pps_status status = pps_system_map_poses(own, to, texels, own->sun_map);
    for (size_t p = 0; p < system->n_poses; p++) {
        system->pose[p].map = own->sun_map[p];
    }
    if (!status) {
        pps_shade_free(&own->sun_shade);
        status = pps_shade_find(&own->casters, to, true, &own->sun_shade);
    }
    system->shade_first = own->sun_shade.first;
    system->shade_list = own->sun_shade.list;
    return status;
}

pps_opacity_look pps_system_look(const pps_system_own *own, const pps_lit_way *light,
                                 size_t i, const double point[3],
                                 const double *normal) {
    const pps_system *system = &own->system;
    const pps_shade *shade = light->shade;
    pps_opacity_look sum = {0, 0, 1, 1};
    for (size_t k = shade->first[i]; k < shade->first[i + 1]; k++) {
        const pps_caster *caster = &own->casters.caster[shade->list[k]];
        const pps_opacity_map *map = light->map[system->pose_of[caster->instance]];
        /* The casters begin with the instances at their own places. */
        bool itself = normal && shade->list[k] == i;
        double at[3], facing[3];
        pps_opacity_look look;
        pps_caster_own(system->scene, caster, point, at);
        if (itself) {
            pps_caster_own_direction(system->scene, caster, normal, facing);
        }
        if (pps_opacity_look_at(map, at, itself ? facing : NULL, &look)) {
            sum.depth += look.depth;
            sum.behind += look.behind;
            sum.visible *= look.visible;
            sum.clear *= look.clear;
        }
    }
    return sum;
}

pps_sun_look pps_system_look_at_sun(const pps_system_own *own, size_t i,
                                    const double point[3], const double *normal) {
    const double *to = own->system.scene->sun.to;
    pps_lit_way light = {{to[0], to[1], to[2]}, own->sun_map, &own->sun_shade};
    return pps_system_look(own, &light, i, point, normal);
}

/* ---- life ---- */

pps_status pps_system_create(const pps_scene *scene, const pps_system_options *options,
                             pps_system **out) {
    *out = NULL;
    if (!scene || !scene->first_leaf || !scene->n_leaves ||
        (options && (options->across < 0 || options->across > MOST_ACROSS ||
                     options->samples < 0 || options->threads < 0))) {
        return PPS_ERR_ARGUMENT;
    }
    pps_system_own *own = calloc(1, sizeof *own);
    if (!own) {
        return PPS_ERR_MEMORY;
    }
    own->options = options ? *options : (pps_system_options){0};
    own->threads = pps_thread_count(own->options.threads);
    own->system.scene = scene;
    own->system.directions = pps_directions_22();
    own->system.cell_of = calloc(scene->n_leaves, sizeof *own->system.cell_of);
    own->sun_map = calloc(scene->n_instances + 1, sizeof(pps_opacity_map *));
    pps_status status =
        own->system.cell_of && own->sun_map ? find_poses(&own->system) : PPS_ERR_MEMORY;
    if (!status) {
        status = pps_casters_create(scene, &own->casters);
        own->system.n_casters = own->casters.n;
    }
    if (!status) {
        status = steps_of(own)->create(own);
        own->system.by_count = own->counts;
        bool by_point = own->options.by_point && own->counts;
        own->system.slab_m = pps_slab_m(own->slab);
        own->system.slab_kappa = by_point ? pps_slab_kappa(own->slab) : 0;
    }
    if (status) {
        pps_system_free(&own->system);
        return status;
    }
    *out = &own->system;
    return PPS_OK;
}

void pps_system_free(pps_system *system) {
    if (!system) {
        return;
    }
    pps_system_own *own = (pps_system_own *)system;
    steps_of(own)->free(own);
    for (size_t p = 0; own->sun_map && p < system->n_poses; p++) {
        pps_opacity_map_free(own->sun_map[p]);
    }
    free(own->sun_map);
    free(system->pose);
    free(system->pose_of);
    free(system->cell_of);
    pps_casters_free(&own->casters);
    pps_shade_free(&own->sun_shade);
    free(own);
}

size_t pps_system_caster(const pps_system *system, size_t k, double offset[2]) {
    const pps_system_own *own = (const pps_system_own *)system;
    const pps_caster *caster = &own->casters.caster[k];
    const pps_instance *home = &system->scene->instance[caster->instance];
    for (int i = 0; i < 2; i++) {
        offset[i] = caster->translation[i] - home->translation[i];
    }
    return caster->instance;
}

/* ---- steps ---- */

/* Run a step that needs step `before` (-1: none), and note its time. */
static pps_status run(pps_system *system, int step, int before,
                      pps_status (*work)(pps_system_own *own)) {
    pps_system_own *own = (pps_system_own *)system;
    if (before >= 0 && !own->done[before]) {
        return PPS_ERR_ARGUMENT;
    }
    double start = omp_get_wtime();
    pps_status status = work(own);
    system->seconds[step] = omp_get_wtime() - start;
    own->done[step] = !status;
    return status;
}

pps_status pps_system_construct_cells(pps_system *system) {
    return run(system, STEP_CELLS, -1,
               steps_of((pps_system_own *)system)->construct_cells);
}

pps_status pps_system_map_directions(pps_system *system) {
    return run(system, STEP_MAPS, STEP_CELLS,
               steps_of((pps_system_own *)system)->map_directions);
}

pps_status pps_system_find_g(pps_system *system) {
    return run(system, STEP_G, STEP_MAPS, steps_of((pps_system_own *)system)->find_g);
}

pps_status pps_system_light_sky(pps_system *system) {
    return run(system, STEP_SKY, STEP_G, steps_of((pps_system_own *)system)->light_sky);
}

static pps_status light_sun(pps_system_own *own) {
    if (!(fabs(vec_length(own->system.scene->sun.to) - 1) < 1e-9)) {
        return PPS_ERR_ARGUMENT;
    }
    pps_status status = map_sun(own);
    return status ? status : steps_of(own)->light_sun(own);
}

pps_status pps_system_light_sun(pps_system *system) {
    return run(system, STEP_SUN, STEP_G, light_sun);
}

/* ---- leaves ---- */

/* The system, and the parts of the sky as irradiance, [direction]. */
typedef struct {
    const pps_system_own *own;
    unsigned sources;
    double part[SYSTEM_DIRECTIONS_MAX][PPS_BANDS_MAX];
} shader;

/* A place on a leaf. */
typedef struct {
    size_t leaf, instance;
    double point[3], normal[3];
} place;

/* Light of the cells that is scattered, of the kinds asked for: of both faces, and more of
 * the front. */
static void scattered_in_cell(const shader *s, const place *at, bool sun, size_t b,
                              double *even, double *odd) {
    static const unsigned kind[] = {PPS_SKY_INDIRECT, PPS_SUN_INDIRECT};
    const pps_system *system = &s->own->system;
    size_t c = system->cell_of[at->leaf] * (size_t)system->scene->n_bands + b;
    *even = *odd = 0;
    for (int k = 0; k < (sun ? 2 : 1); k++) {
        if (s->sources & kind[k]) {
            const float *flux = system->flux[k] + 3 * c;
            *even += (double)system->diffuse[k][c] / 4;
            *odd += (at->normal[0] * (double)flux[0] + at->normal[1] * (double)flux[1] +
                     at->normal[2] * (double)flux[2]) /
                    2;
        }
    }
}

/* The sun's, by the depths at the place itself and the cell's G. */
static void scattered_here(const shader *s, const place *at, const pps_sun_look *look,
                           size_t b, double *even, double *odd) {
    const pps_system *system = &s->own->system;
    const pps_scene *scene = system->scene;
    const pps_prototype *prototype =
        &scene->prototype[scene->instance[at->instance].prototype];
    double e = scene->sun.irradiance[b] * (double)system->g[system->cell_of[at->leaf]];
    pps_slab_light light;
    pps_slab_light_init(&light, s->own->slab,
                        pps_leaf_albedo(&prototype->optics, (int)b),
                        look->depth + look->behind);
    *even += e * pps_slab_light_sum(&light, look->depth) / 4;
    *odd += e * pps_slab_light_net(&light, look->depth) / 4 *
            vec_dot(at->normal, scene->sun.to);
}

/* Irradiance of both faces by the sun, and by all that is scattered. */
static void shade_by_sun(const shader *s, const place *at, double *front,
                         double *back) {
    const pps_system *system = &s->own->system;
    const pps_sun *sun = &system->scene->sun;
    bool here = system->slab_kappa > 0 && s->sources & PPS_SUN_INDIRECT;
    pps_sun_look look = {0, 0, 1, 1};
    if (here || s->sources & PPS_SUN) {
        look = pps_system_look_at_sun(s->own, at->instance, at->point, at->normal);
    }
    double share = s->sources & PPS_SUN ? vec_dot(at->normal, sun->to) : 0;
    share *= s->own->counts ? exp(-look.depth) : look.visible;
    for (size_t b = 0; b < (size_t)system->scene->n_bands; b++) {
        double even, odd;
        scattered_in_cell(s, at, !here, b, &even, &odd);
        if (here) {
            scattered_here(s, at, &look, b, &even, &odd);
        }
        front[b] = sun->irradiance[b] * fmax(share, 0) + fmax(even + odd, 0);
        back[b] = sun->irradiance[b] * fmax(-share, 0) + fmax(even - odd, 0);
    }
}

static void add_sky(const shader *s, const place *at, double *front, double *back) {
    const pps_system *system = &s->own->system;
    size_t n = (size_t)system->directions.n, c = system->cell_of[at->leaf];
    for (size_t j = 0; j < n; j++) {
        double through = vec_dot(at->normal, system->directions.to[j]) *
                         (double)system->sky[c * n + j];
        for (size_t b = 0; b < (size_t)system->scene->n_bands; b++) {
            front[b] += fmax(through, 0) * s->part[j][b];
            back[b] += fmax(-through, 0) * s->part[j][b];
        }
    }
}

static void shade_place(const shader *s, const place *at, double *front, double *back) {
    shade_by_sun(s, at, front, back);
    if (s->sources & PPS_SKY) {
        add_sky(s, at, front, back);
    }
}

static void shade_leaf(const shader *s, size_t i, double *front, double *back) {
    pps_scene_leaf leaf;
    pps_scene_leaf_at(s->own->system.scene, i, &leaf);
    place at = {.leaf = i, .instance = leaf.instance};
    memcpy(at.point, leaf.center, sizeof at.point);
    memcpy(at.normal, leaf.normal, sizeof at.normal);
    shade_place(s, &at, front, back);
}

/* ARGUMENT: a step is missing, or there are no such sources. */
static pps_status shader_init(const pps_system *system, unsigned sources, shader *s) {
    const pps_system_own *own = (const pps_system_own *)system;
    const pps_scene *scene = system->scene;
    if (!own->done[STEP_SKY] || !own->done[STEP_SUN] || sources > PPS_ALL_LIGHT) {
        return PPS_ERR_ARGUMENT;
    }
    *s = (shader){.own = own, .sources = sources ? sources : PPS_ALL_LIGHT};
    for (int j = 0; j < system->directions.n; j++) {
        double z = system->directions.to[j][2];
        for (int b = 0; b < scene->n_bands && !(z < 0 && scene->ground.present); b++) {
            s->part[j][b] =
                4 * PI / system->directions.n * pps_sky_radiance(&scene->sky, b, z);
        }
    }
    return PPS_OK;
}

pps_status pps_system_shade(pps_system *system, unsigned sources,
                            pps_irradiance **out) {
    const pps_scene *scene = system->scene;
    shader s;
    *out = NULL;
    double start = omp_get_wtime();
    pps_status status = shader_init(system, sources, &s);
    if (!status) {
        status = pps_irradiance_create(scene, false, out);
    }
    if (status) {
        return status;
    }
#pragma omp parallel for num_threads(s.own->threads) schedule(static)
    for (size_t i = 0; i < scene->n_leaves; i++) {
        size_t at = i * (size_t)scene->n_bands;
        shade_leaf(&s, i, (*out)->front + at, (*out)->back + at);
    }
    system->seconds[STEP_SHADE] = omp_get_wtime() - start;
    return PPS_OK;
}

pps_status pps_system_shade_point(const pps_system *system, unsigned sources, size_t i,
                                  const double point[3], const double normal[3],
                                  double *front, double *back) {
    shader s;
    pps_scene_leaf leaf;
    pps_status status = i < system->scene->n_leaves ? shader_init(system, sources, &s)
                                                    : PPS_ERR_ARGUMENT;
    if (!status) {
        pps_scene_leaf_at(system->scene, i, &leaf);
        place at = {.leaf = i, .instance = leaf.instance};
        memcpy(at.point, point, sizeof at.point);
        memcpy(at.normal, normal, sizeof at.normal);
        shade_place(&s, &at, front, back);
    }
    return status;
}
