/* The rendering system over one grid of the scene: any light model that has cells.
 *
 * Depths and visibilities of cells are means over leaves, by the same opacity maps as the
 * sun's: eleven directions and their opposites one after another, of all poses. Rays, as
 * pps_cells_create has them, are slower and a little better.
 * Sky and sun are two fields, for light adds up: what one of them does not move is kept.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/cells_bare.h"
#include "tree/light_model.h"
#include "tree/system_own.h"
#include "tree/vec.h"

enum { SUN_LOOKS = 32, SKY_LOOKS = 16 }; /* leaves of a cell that look there, at most */
enum { DEFAULT_TEXELS = 256 };

/* Over all directions, of one leaf that looks there: how much of it faces them, and how
 * much of that is clear; sums, and sums of squares. */
typedef struct {
    double area, facing, clear, facing_squares, clear_squares;
} outlook;

typedef struct {
    const pps_light_model *model;
    pps_cells *cells;
    pps_light_field *field[2];
    size_t *first, *leaf; /* leaf[first[c]] .. are those of cell c */
    outlook *outlook;     /* [c * SKY_LOOKS + k], while the directions are mapped */
} grid;

static pps_status create(pps_system_own *own) {
    const pps_light_model *model =
        own->options.model ? own->options.model : pps_light_model_at(0);
    pps_light_options checked;
    pps_status status = pps_light_options_check(model, &own->options.light, &checked);
    if (status || !model->ops->solve || model->sources != PPS_ALL_LIGHT) {
        return status ? status : PPS_ERR_UNSUPPORTED;
    }
    own->counts = model->ops->counts;
    own->slab = model->ops->slab;
    grid *g = calloc(1, sizeof *g);
    own->way = g;
    if (!g) {
        return PPS_ERR_MEMORY;
    }
    g->model = model;
    return PPS_OK;
}

static void forget(grid *g) {
    pps_cells_free(g->cells);
    pps_light_field_free(g->field[0]);
    pps_light_field_free(g->field[1]);
    free(g->first);
    free(g->leaf);
    free(g->outlook);
    *g = (grid){.model = g->model};
}

static void free_way(pps_system_own *own) {
    if (own->way) {
        forget(own->way);
        free(own->way);
    }
}

/* ---- step 1 ---- */

/* Leaves in the order of their cells. */
static pps_status sort_leaves(pps_system_own *own) {
    grid *g = own->way;
    size_t n = g->cells->n_cells, n_leaves = own->system.scene->n_leaves;
    const uint32_t *cell_of = g->cells->cell_of;
    g->first = calloc(n + 2, sizeof *g->first);
    g->leaf = malloc((n_leaves + 1) * sizeof *g->leaf);
    if (!g->first || !g->leaf) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < n_leaves; i++) {
        g->first[cell_of[i] + 2]++;
    }
    for (size_t c = 0; c < n; c++) {
        g->first[c + 2] += g->first[c + 1];
    }
    for (size_t i = 0; i < n_leaves; i++) {
        g->leaf[g->first[cell_of[i] + 1]++] = i;
    }
    return PPS_OK;
}

static pps_status construct_cells(pps_system_own *own) {
    pps_system *system = &own->system;
    grid *g = own->way;
    pps_cells_options options = {.across = own->options.across,
                                 .samples =
                                     own->options.samples ? own->options.samples : 1,
                                 .threads = own->threads};
    forget(g);
    pps_status status = own->options.by_rays
                            ? pps_cells_create(system->scene, &options, &g->cells)
                            : pps_cells_create_bare(system->scene, &options, &g->cells);
    if (!status) {
        status = sort_leaves(own);
    }
    if (!status) {
        system->n_cells = g->cells->n_cells;
        system->cell = g->cells->size;
        memcpy(system->cell_of, g->cells->cell_of,
               system->scene->n_leaves * sizeof *system->cell_of);
    }
    return status;
}

/* ---- steps 2 and 3 ---- */

/* Towards a direction and its opposite. */
static void note_outlook(outlook *o, double area, double turned,
                         const pps_opacity_look *look) {
    double ahead = turned * look->visible, behind = turned * look->clear;
    o->area = area;
    o->facing += 2 * turned;
    o->facing_squares += 2 * turned * turned;
    o->clear += ahead + behind;
    o->clear_squares += ahead * ahead + behind * behind;
}

/* Means over at most `most` leaves of a cell, their places their middles: depths by leaf
 * area, visibilities by the area turned that way. False where no leaf counts in the cell;
 * `all`: what each leaf sees is noted there, or NULL. */
static bool look_from_cell(const pps_system_own *own, const pps_lit_way *light,
                           size_t c, size_t most, outlook *all,
                           pps_opacity_look *mean) {
    const grid *g = own->way;
    size_t n = g->first[c + 1] - g->first[c], step = n / most + 1;
    double whole = 0, facing = 0;
    *mean = (pps_opacity_look){0, 0, 0, 0};
    for (size_t k = g->first[c]; k < g->first[c + 1]; k += step) {
        pps_scene_leaf leaf;
        pps_scene_leaf_at(own->system.scene, g->leaf[k], &leaf);
        pps_opacity_look look =
            pps_system_look(own, light, leaf.instance, leaf.center, leaf.normal);
        double turned = fabs(vec_dot(leaf.normal, light->to));
        whole += leaf.area;
        facing += leaf.area * turned;
        mean->depth += leaf.area * look.depth;
        mean->behind += leaf.area * look.behind;
        mean->visible += leaf.area * turned * look.visible;
        mean->clear += leaf.area * turned * look.clear;
        if (all) {
            note_outlook(&all[(k - g->first[c]) / step], leaf.area, turned, &look);
        }
    }
    mean->depth /= whole > 0 ? whole : 1;
    mean->behind /= whole > 0 ? whole : 1;
    mean->visible /= facing > 0 ? facing : 1;
    mean->clear /= facing > 0 ? facing : 1;
    return whole > 0;
}

/* A cell that only has parts of leaves that count elsewhere: the mean of its neighbours
 * where leaves count. */
static pps_opacity_look borrow(const grid *g, const pps_opacity_look *of, size_t c) {
    const pps_cells *cells = g->cells;
    size_t stride[3] = {1, (size_t)cells->n[0],
                        (size_t)cells->n[0] * (size_t)cells->n[1]};
    pps_opacity_look sum = {0, 0, 0, 0};
    double n = 0;
    for (int k = 0; k < 6; k++) {
        int axis = k / 2;
        size_t at = c / stride[axis] % (size_t)cells->n[axis];
        bool inside = k % 2 ? at + 1 < (size_t)cells->n[axis] : at > 0;
        size_t other = k % 2 ? c + stride[axis] : c - stride[axis];
        if (inside && g->first[other + 1] > g->first[other]) {
            sum.depth += of[other].depth;
            sum.behind += of[other].behind;
            sum.visible += of[other].visible;
            sum.clear += of[other].clear;
            n++;
        }
    }
    return n > 0 ? (pps_opacity_look){sum.depth / n, sum.behind / n, sum.visible / n,
                                      sum.clear / n}
                 : (pps_opacity_look){0, 0, 1, 1};
}

/* From every cell with leaves, looks[c]. */
static void look_from_cells(const pps_system_own *own, const pps_lit_way *light,
                            size_t most, pps_opacity_look *looks) {
    const grid *g = own->way;
    size_t n = g->cells->n_cells;
#pragma omp parallel for num_threads(own->threads) schedule(dynamic, 16)
    for (size_t c = 0; c < n; c++) {
        outlook *all = g->outlook ? g->outlook + c * SKY_LOOKS : NULL;
        look_from_cell(own, light, c, most, all, &looks[c]);
    }
    for (size_t c = 0; c < n; c++) {
        if (g->cells->area[c] > 0 && g->first[c + 1] == g->first[c]) {
            looks[c] = borrow(g, looks, c);
        }
    }
}

/* A direction and its opposite, which lies behind on the same lines. */
static void put_directions(pps_cells *cells, size_t j, const pps_opacity_look *looks) {
    size_t n = (size_t)cells->directions.n;
    for (size_t c = 0; c < cells->n_cells; c++) {
        if (cells->area[c] > 0) {
            cells->depth[c * n + j] = (float)looks[c].depth;
            cells->depth[c * n + (j ^ 1)] = (float)looks[c].behind;
            cells->visibility[c * n + j] = (float)looks[c].visible;
            cells->visibility[c * n + (j ^ 1)] = (float)looks[c].clear;
        }
    }
}

/* The mean over pairs of directions of both being clear from a leaf (cells.h), and where
 * no leaf of the cell looked, as if they had nothing to do with each other. */
static double both_clear(const pps_cells *cells, size_t c, const outlook *all) {
    double pairs = 0, clear = 0, sum = 0, squares = 0;
    int n = cells->directions.n;
    for (int k = 0; k < SKY_LOOKS; k++) {
        const outlook *o = &all[k];
        pairs += o->area * (o->facing * o->facing - o->facing_squares);
        clear += o->area * (o->clear * o->clear - o->clear_squares);
    }
    if (pairs > 0) {
        return clear / pairs;
    }
    for (int j = 0; j < n; j++) {
        double v = (double)cells->visibility[c * (size_t)n + (size_t)j];
        sum += v;
        squares += v * v;
    }
    return (sum * sum - squares) / (n * (n - 1.0));
}

static void put_outlooks(grid *g) {
    for (size_t c = 0; c < g->cells->n_cells; c++) {
        if (g->cells->area[c] > 0) {
            g->cells->both_clear[c] =
                both_clear(g->cells, c, g->outlook + c * SKY_LOOKS);
        }
    }
    free(g->outlook);
    g->outlook = NULL;
}

static pps_status look_towards(pps_system_own *own, size_t j, pps_opacity_map **map,
                               pps_opacity_look *looks) {
    grid *g = own->way;
    const double *to = g->cells->directions.to[j];
    int texels = own->options.texels ? own->options.texels : DEFAULT_TEXELS;
    pps_shade shade;
    pps_status status = pps_shade_find(&own->casters, to, true, &shade);
    if (status) {
        return status;
    }
    status = pps_system_map_poses(own, to, texels, map);
    if (!status) {
        pps_lit_way light = {{to[0], to[1], to[2]}, map, &shade};
        look_from_cells(own, &light, SKY_LOOKS, looks);
        put_directions(g->cells, j, looks);
    }
    pps_shade_free(&shade);
    return status;
}

static pps_status map_directions(pps_system_own *own) {
    grid *g = own->way;
    size_t n_poses = own->system.n_poses;
    if (own->options.by_rays) {
        return PPS_OK;
    }
    pps_opacity_map **map = calloc(n_poses + 1, sizeof *map);
    pps_opacity_look *looks = calloc(g->cells->n_cells + 1, sizeof *looks);
    g->outlook = calloc(g->cells->n_cells * SKY_LOOKS + 1, sizeof *g->outlook);
    pps_status status = map && looks && g->outlook ? PPS_OK : PPS_ERR_MEMORY;
    for (size_t j = 0; j < (size_t)g->cells->directions.n && !status; j += 2) {
        status = look_towards(own, j, map, looks);
    }
    if (!status) {
        put_outlooks(g);
    }
    for (size_t p = 0; map && p < n_poses; p++) {
        pps_opacity_map_free(map[p]);
    }
    free(map);
    free(looks);
    return status;
}

static pps_status nothing(pps_system_own *own) {
    (void)own;
    return PPS_OK;
}

/* ---- steps 4 and 5 ---- */

static pps_status solve(pps_system_own *own, int which, unsigned sources) {
    grid *g = own->way;
    pps_light_options light = own->options.light;
    light.sources = sources;
    light.threads = own->threads;
    pps_status status = pps_light_field_solve(g->model, own->system.scene, g->cells,
                                              &light, &g->field[which]);
    if (!status) {
        own->system.diffuse[which] = g->field[which]->diffuse;
        own->system.flux[which] = g->field[which]->flux;
    }
    return status;
}

static pps_status light_sky(pps_system_own *own) {
    grid *g = own->way;
    pps_status status = solve(own, SYSTEM_SKY, PPS_SKY | PPS_SKY_INDIRECT);
    if (!status) {
        own->system.sky = g->field[SYSTEM_SKY]->sky;
    }
    return status;
}

static pps_status light_sun(pps_system_own *own) {
    grid *g = own->way;
    pps_cells *cells = g->cells;
    const double *to = own->system.scene->sun.to;
    pps_lit_way light = {{to[0], to[1], to[2]}, own->sun_map, &own->sun_shade};
    pps_opacity_look *looks = calloc(cells->n_cells + 1, sizeof *looks);
    if (!looks) {
        return PPS_ERR_MEMORY;
    }
    look_from_cells(own, &light, SUN_LOOKS, looks);
    for (size_t c = 0; c < cells->n_cells; c++) {
        if (cells->area[c] > 0) {
            cells->sun_depth[c] = looks[c].depth;
            cells->sun_behind[c] = looks[c].behind;
            cells->sun_visibility[c] = looks[c].visible;
            cells->sun_clear[c] = looks[c].clear;
        }
    }
    free(looks);
    pps_status status = solve(own, SYSTEM_SUN, PPS_SUN | PPS_SUN_INDIRECT);
    if (!status) {
        own->system.sun = g->field[SYSTEM_SUN]->sun;
        own->system.g = g->field[SYSTEM_SUN]->g_factor;
    }
    return status;
}

const pps_system_steps pps_system_grid = {
    create, free_way, construct_cells, map_directions, nothing, light_sky, light_sun};
