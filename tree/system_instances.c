/* The rendering system as the paper has it: a coarse grid in every plant, its depths from
 * the maps of the plants around (SPP Eq. 31), and SPP with the G-factor.
 *
 * Grids and maps are laid in a prototype's own space, where counts of surfaces do not
 * depend on scale. A plant turned by k steps of 72 degrees sees direction j as another
 * direction of the set, so that one set of maps serves all.
 *
 * The sky is 22 suns, each with its own depths and G (SPP section 5.4 stores one G; but G
 * depends on where light comes from). Ground: black.
 *
 * Reference: SPP section 5.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/gfactor.h"
#include "tree/slab_light.h"
#include "tree/system_own.h"
#include "tree/vec.h"

enum { TURNS = 5, DEFAULT_ACROSS = 10, DEFAULT_TEXELS = 64 };
static const double PI = 3.14159265358979323846;
static const double TURN = 72; /* degrees */

/* The cells of a prototype, in its own space. */
typedef struct {
    int n[3];
    double low[3], size;
    size_t n_cells;
    bool *leafy;           /* [cell] */
    uint32_t *cell_of;     /* [leaf] */
    pps_opacity_map **map; /* [direction] */
} coarse;

typedef struct {
    coarse *prototype;
    size_t *first;                             /* [instance] its first cell */
    int seen_as[TURNS][SYSTEM_DIRECTIONS_MAX]; /* direction j, by a plant turned k */
    float *depth, *g;                          /* [c * n_directions + j] */
    float *diffuse[2], *flux[2], *sky, *sun, *sun_g;
} instances;

/* ---- create ---- */

/* In steps of 72 degrees; -1: not in steps. */
static int turn_of(const pps_instance *at) {
    double k = at->yaw / TURN, whole = round(k);
    return fabs(k - whole) < 1e-9 ? (int)(whole - TURNS * floor(whole / TURNS)) : -1;
}

/* Which direction of the set a turned plant sees direction j in; false: none. */
static bool find_turned(const pps_directions *directions, instances *way) {
    for (int k = 0; k < TURNS; k++) {
        pps_instance back = {.yaw = -TURN * k, .scale = 1};
        for (int j = 0; j < directions->n; j++) {
            double own[3];
            pps_instance_direction(&back, directions->to[j], own);
            way->seen_as[k][j] = -1;
            for (int i = 0; i < directions->n; i++) {
                if (vec_dot(own, directions->to[i]) > 1 - 1e-9) {
                    way->seen_as[k][j] = i;
                }
            }
            if (way->seen_as[k][j] < 0) {
                return false;
            }
        }
    }
    return true;
}

static pps_status create(pps_system_own *own) {
    const pps_scene *scene = own->system.scene;
    for (size_t i = 0; i < scene->n_instances; i++) {
        if (turn_of(&scene->instance[i]) < 0) {
            return PPS_ERR_UNSUPPORTED;
        }
    }
    if (scene->period[0] > 0 || own->options.model) {
        return PPS_ERR_UNSUPPORTED;
    }
    instances *way = own->way = calloc(1, sizeof *way);
    if (!way) {
        return PPS_ERR_MEMORY;
    }
    own->counts = true;
    own->slab = own->options.kappa_printed ? PPS_SLAB_SPP_PRINTED : PPS_SLAB_SPP;
    way->prototype = calloc(scene->n_prototypes, sizeof *way->prototype);
    way->first = calloc(scene->n_instances + 1, sizeof *way->first);
    if (!way->prototype || !way->first) {
        return PPS_ERR_MEMORY;
    }
    return find_turned(&own->system.directions, way) ? PPS_OK : PPS_ERR_UNSUPPORTED;
}

static void forget_coarse(coarse *at, int n_directions) {
    for (int j = 0; at->map && j < n_directions; j++) {
        pps_opacity_map_free(at->map[j]);
    }
    free(at->map);
    free(at->leafy);
    free(at->cell_of);
    *at = (coarse){0};
}

static void forget_cells(instances *way) {
    free(way->depth);
    free(way->g);
    free(way->sky);
    free(way->sun);
    free(way->sun_g);
    for (int k = 0; k < 2; k++) {
        free(way->diffuse[k]);
        free(way->flux[k]);
        way->diffuse[k] = way->flux[k] = NULL;
    }
    way->depth = way->g = way->sky = way->sun = way->sun_g = NULL;
}

static void free_way(pps_system_own *own) {
    instances *way = own->way;
    if (!way) {
        return;
    }
    for (size_t p = 0; way->prototype && p < own->system.scene->n_prototypes; p++) {
        forget_coarse(&way->prototype[p], own->system.directions.n);
    }
    forget_cells(way);
    free(way->prototype);
    free(way->first);
    free(way);
}

/* ---- step 1 ---- */

static void lay_grid(const pps_mesh *mesh, int across, coarse *at) {
    pps_mesh_size size;
    double longest = 0;
    pps_mesh_measure(mesh, &size);
    for (int i = 0; i < 3; i++) {
        longest = fmax(longest, size.leaf_high[i] - size.leaf_low[i]);
    }
    at->size = longest > 0 ? longest / across : 1;
    at->n_cells = 1;
    for (int i = 0; i < 3; i++) {
        double extent = size.leaf_high[i] - size.leaf_low[i];
        at->n[i] = (int)fmax(ceil(extent / at->size * (1 - 1e-12)), 1);
        at->low[i] = (size.leaf_high[i] + size.leaf_low[i] - at->n[i] * at->size) / 2;
        at->n_cells *= (size_t)at->n[i];
    }
}

static uint32_t cell_at(const coarse *at, const double point[3]) {
    size_t k[3];
    for (int i = 0; i < 3; i++) {
        double x = floor((point[i] - at->low[i]) / at->size);
        k[i] = (size_t)fmin(fmax(x, 0), at->n[i] - 1);
    }
    return (uint32_t)((k[2] * (size_t)at->n[1] + k[1]) * (size_t)at->n[0] + k[0]);
}

static pps_status construct_coarse(const pps_prototype *prototype, int across,
                                   coarse *at) {
    const pps_mesh *mesh = prototype->mesh;
    lay_grid(mesh, across, at);
    at->leafy = calloc(at->n_cells, sizeof *at->leafy);
    at->cell_of = calloc(mesh->n_leaves + 1, sizeof *at->cell_of);
    if (!at->leafy || !at->cell_of) {
        return PPS_ERR_MEMORY;
    }
    for (size_t l = 0; l < mesh->n_leaves; l++) {
        at->cell_of[l] = cell_at(at, mesh->leaf[l].center);
        at->leafy[at->cell_of[l]] = true;
    }
    return PPS_OK;
}

static pps_status reserve(pps_system_own *own) {
    instances *way = own->way;
    size_t n = own->system.n_cells + 1, bands = (size_t)own->system.scene->n_bands,
           directions = (size_t)own->system.directions.n;
    forget_cells(way);
    way->depth = calloc(n * directions, sizeof *way->depth);
    way->g = calloc(n * directions, sizeof *way->g);
    way->sky = calloc(n * directions, sizeof *way->sky);
    way->sun = calloc(n, sizeof *way->sun);
    way->sun_g = calloc(n, sizeof *way->sun_g);
    bool all = way->depth && way->g && way->sky && way->sun && way->sun_g;
    for (int k = 0; k < 2; k++) {
        own->system.diffuse[k] = way->diffuse[k] =
            calloc(n * bands, sizeof *way->diffuse[k]);
        own->system.flux[k] = way->flux[k] =
            calloc(3 * n * bands, sizeof *way->flux[k]);
        all = all && way->diffuse[k] && way->flux[k];
    }
    own->system.sky = way->sky;
    own->system.sun = way->sun;
    own->system.g = way->sun_g;
    return all ? PPS_OK : PPS_ERR_MEMORY;
}

static pps_status construct_cells(pps_system_own *own) {
    pps_system *system = &own->system;
    const pps_scene *scene = system->scene;
    instances *way = own->way;
    int across = own->options.across ? own->options.across : DEFAULT_ACROSS;
    for (size_t p = 0; p < scene->n_prototypes; p++) {
        forget_coarse(&way->prototype[p], system->directions.n);
        pps_status status =
            construct_coarse(&scene->prototype[p], across, &way->prototype[p]);
        if (status) {
            return status;
        }
    }
    system->n_cells = 0;
    system->cell = INFINITY;
    for (size_t i = 0; i < scene->n_instances; i++) {
        int p = scene->instance[i].prototype;
        way->first[i] = system->n_cells;
        for (size_t l = 0; l < scene->prototype[p].mesh->n_leaves; l++) {
            system->cell_of[scene->first_leaf[i] + l] =
                (uint32_t)system->n_cells + way->prototype[p].cell_of[l];
        }
        system->n_cells += way->prototype[p].n_cells;
        system->cell =
            fmin(system->cell, way->prototype[p].size * scene->instance[i].scale);
    }
    way->first[scene->n_instances] = system->n_cells;
    return reserve(own);
}

/* ---- step 2 ---- */

static pps_status map_directions(pps_system_own *own) {
    const pps_system *system = &own->system;
    instances *way = own->way;
    size_t n = (size_t)system->directions.n;
    pps_opacity_options options = {.texels = own->options.texels ? own->options.texels
                                                                 : DEFAULT_TEXELS};
    pps_status worst = PPS_OK;
    for (size_t p = 0; p < system->scene->n_prototypes; p++) {
        coarse *at = &way->prototype[p];
        at->map = at->map ? at->map : calloc(n, sizeof *at->map);
        if (!at->map) {
            return PPS_ERR_MEMORY;
        }
    }
#pragma omp parallel for num_threads(own->threads) schedule(dynamic)
    for (size_t k = 0; k < n * system->scene->n_prototypes; k++) {
        coarse *at = &way->prototype[k / n];
        pps_opacity_map_free(at->map[k % n]);
        pps_status status = pps_opacity_map_create(system->scene->prototype[k / n].mesh,
                                                   system->directions.to[k % n],
                                                   &options, &at->map[k % n]);
        if (status) {
#pragma omp atomic write
            worst = status;
        }
    }
    return worst;
}

/* ---- step 3 ---- */

/* Points of a cell that depths are means over. One would do for a smooth crown; a count
 * along one line is no optical depth, and e^-count of many lines is more than e^-mean. */
enum { POINTS = 8 };
static void cell_point(const pps_system_own *own, size_t i, size_t c, int point,
                       double out[3]) {
    static const double corner[8][3] = {{1, 1, 1},   {1, -1, -1},  {-1, 1, -1},
                                        {-1, -1, 1}, {-1, -1, -1}, {-1, 1, 1},
                                        {1, -1, 1},  {1, 1, -1}};
    const instances *way = own->way;
    const pps_instance *instance = &own->system.scene->instance[i];
    const coarse *at = &way->prototype[instance->prototype];
    size_t k = c - way->first[i], x = (size_t)at->n[0], y = (size_t)at->n[1];
    const size_t of[3] = {k % x, k / x % y, k / x / y};
    double place[3];
    for (int a = 0; a < 3; a++) {
        place[a] =
            at->low[a] + ((double)of[a] + 0.5 + 0.25 * corner[point][a]) * at->size;
    }
    pps_instance_point(instance, place, out);
}

static bool leafy(const instances *way, const pps_scene *scene, size_t i, size_t c) {
    return way->prototype[scene->instance[i].prototype].leafy[c - way->first[i]];
}

/* SPP Eq. 31: the depth towards direction j, summed over the plants on the way. */
static double depth_at(const pps_system_own *own, const pps_shade *shade, int j,
                       size_t i, const double point[3]) {
    const pps_scene *scene = own->system.scene;
    const instances *way = own->way;
    double depth = 0;
    for (size_t k = shade->first[i]; k < shade->first[i + 1]; k++) {
        const pps_caster *caster = &own->casters.caster[shade->list[k]];
        const pps_instance *by = &scene->instance[caster->instance];
        double at[3];
        pps_caster_own(scene, caster, point, at);
        depth += pps_opacity_depth(
            way->prototype[by->prototype].map[way->seen_as[turn_of(by)][j]], at);
    }
    return depth;
}

static void sum_depths(const pps_system_own *own, const pps_shade *shade, int j,
                       size_t i) {
    const pps_scene *scene = own->system.scene;
    instances *way = own->way;
    for (size_t c = way->first[i]; c < way->first[i + 1]; c++) {
        double depth = 0;
        if (!leafy(way, scene, i, c)) {
            continue;
        }
        for (int p = 0; p < POINTS; p++) {
            double point[3];
            cell_point(own, i, c, p, point);
            depth += depth_at(own, shade, j, i, point) / POINTS;
        }
        way->depth[c * (size_t)own->system.directions.n + (size_t)j] = (float)depth;
    }
}

/* The G-factor of a cell for light from `to`, at depth d of w. */
static double g_of_cell(const pps_system_own *own, size_t c, const double to[3],
                        double d, double w) {
    const instances *way = own->way;
    const pps_directions *directions = &own->system.directions;
    double mu[SYSTEM_DIRECTIONS_MAX], h[SYSTEM_DIRECTIONS_MAX];
    for (int k = 0; k < directions->n; k++) {
        mu[k] = vec_dot(directions->to[k], to);
        h[k] = (double)way->depth[c * (size_t)directions->n + (size_t)k];
    }
    return pps_g_factor(own->options.light.compensate, d, w, directions->n, mu, h);
}

static void find_gs(const pps_system_own *own, size_t i) {
    instances *way = own->way;
    size_t n = (size_t)own->system.directions.n;
    for (size_t c = way->first[i]; c < way->first[i + 1]; c++) {
        for (size_t j = 0; leafy(way, own->system.scene, i, c) && j < n; j++) {
            double d = (double)way->depth[c * n + j],
                   behind = (double)way->depth[c * n + (j ^ 1)];
            way->g[c * n + j] =
                (float)g_of_cell(own, c, own->system.directions.to[j], d, d + behind);
            way->sky[c * n + j] = (float)exp(-d);
        }
    }
}

static pps_status find_g(pps_system_own *own) {
    const pps_system *system = &own->system;
    size_t n_instances = system->scene->n_instances;
    for (int j = 0; j < system->directions.n; j++) {
        pps_shade shade;
        pps_status status =
            pps_shade_find(&own->casters, system->directions.to[j], false, &shade);
        if (status) {
            return status;
        }
#pragma omp parallel for num_threads(own->threads) schedule(dynamic)
        for (size_t i = 0; i < n_instances; i++) {
            sum_depths(own, &shade, j, i);
        }
        pps_shade_free(&shade);
    }
#pragma omp parallel for num_threads(own->threads) schedule(dynamic)
    for (size_t i = 0; i < n_instances; i++) {
        find_gs(own, i);
    }
    return PPS_OK;
}

/* ---- steps 4 and 5 ---- */

/* Add the scattered light of one distant light of irradiance e[band] in a cell. */
static void add_light(pps_system_own *own, int which, size_t c,
                      const pps_prototype *prototype, const double to[3], double d,
                      double w, double g, const double *e) {
    instances *way = own->way;
    size_t bands = (size_t)own->system.scene->n_bands;
    for (size_t b = 0; b < bands; b++) {
        pps_slab_light light;
        pps_slab_light_init(&light, own->slab,
                            pps_leaf_albedo(&prototype->optics, (int)b), w);
        float net = (float)(e[b] * g * pps_slab_light_net(&light, d) / 2);
        way->diffuse[which][c * bands + b] +=
            (float)(e[b] * g * pps_slab_light_sum(&light, d));
        for (size_t k = 0; k < 3; k++) {
            way->flux[which][3 * (c * bands + b) + k] += net * (float)to[k];
        }
    }
}

static void clear(pps_system_own *own, int which) {
    instances *way = own->way;
    size_t n = own->system.n_cells * (size_t)own->system.scene->n_bands;
    memset(way->diffuse[which], 0, n * sizeof *way->diffuse[which]);
    memset(way->flux[which], 0, 3 * n * sizeof *way->flux[which]);
}

static void light_instance_by_sky(pps_system_own *own, size_t i, int j,
                                  const double *e) {
    const pps_scene *scene = own->system.scene;
    instances *way = own->way;
    size_t n = (size_t)own->system.directions.n;
    const pps_prototype *prototype = &scene->prototype[scene->instance[i].prototype];
    for (size_t c = way->first[i]; c < way->first[i + 1]; c++) {
        if (leafy(way, scene, i, c)) {
            size_t at = c * n + (size_t)j;
            double d = (double)way->depth[at], behind = (double)way->depth[at ^ 1];
            add_light(own, SYSTEM_SKY, c, prototype, own->system.directions.to[j], d,
                      d + behind, (double)way->g[at], e);
        }
    }
}

static pps_status light_sky(pps_system_own *own) {
    const pps_scene *scene = own->system.scene;
    const pps_directions *directions = &own->system.directions;
    clear(own, SYSTEM_SKY);
#pragma omp parallel for num_threads(own->threads) schedule(dynamic)
    for (size_t i = 0; i < scene->n_instances; i++) {
        for (int j = 0; j < directions->n; j++) {
            double e[PPS_BANDS_MAX], z = directions->to[j][2], most = 0;
            for (int b = 0; b < scene->n_bands; b++) {
                e[b] =
                    z < 0 && scene->ground.present
                        ? 0
                        : 4 * PI / directions->n * pps_sky_radiance(&scene->sky, b, z);
                most = fmax(most, e[b]);
            }
            if (most > 0) {
                light_instance_by_sky(own, i, j, e);
            }
        }
    }
    return PPS_OK;
}

static pps_status light_sun(pps_system_own *own) {
    const pps_scene *scene = own->system.scene;
    const pps_sun *sun = &scene->sun;
    instances *way = own->way;
    clear(own, SYSTEM_SUN);
#pragma omp parallel for num_threads(own->threads) schedule(dynamic)
    for (size_t i = 0; i < scene->n_instances; i++) {
        const pps_prototype *prototype =
            &scene->prototype[scene->instance[i].prototype];
        for (size_t c = way->first[i]; c < way->first[i + 1]; c++) {
            if (!leafy(way, scene, i, c)) {
                continue;
            }
            pps_sun_look look = {0, 0, 1, 1};
            for (int p = 0; p < POINTS; p++) {
                double point[3];
                cell_point(own, i, c, p, point);
                pps_sun_look one = pps_system_look_at_sun(own, i, point, NULL);
                look.depth += one.depth / POINTS;
                look.behind += one.behind / POINTS;
            }
            double d = look.depth, w = look.depth + look.behind;
            double g = g_of_cell(own, c, sun->to, d, w);
            way->sun[c] = (float)exp(-d);
            way->sun_g[c] = (float)g;
            add_light(own, SYSTEM_SUN, c, prototype, sun->to, d, w, g, sun->irradiance);
        }
    }
    return PPS_OK;
}

const pps_system_steps pps_system_instances = {
    create, free_way, construct_cells, map_directions, find_g, light_sky, light_sun};
