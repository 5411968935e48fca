/* The rendering system over one grid of the scene: any light model that has cells.
 *
 * Steps 1 to 3 are one, pps_cells_create, which finds depths by rays: step 1 has its time.
 * Sky and sun are two fields, for light adds up: what one of them does not move is kept.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/light_model.h"
#include "tree/system_own.h"
#include "tree/vec.h"

enum { MOST_LOOKS = 32 }; /* leaves of a cell that look at the sun */

typedef struct {
    const pps_light_model *model;
    pps_cells *cells;
    pps_light_field *field[2];
    size_t *first, *leaf; /* leaf[first[c]] .. are those of cell c */
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
    pps_status status = pps_cells_create(system->scene, &options, &g->cells);
    if (!status) {
        status = sort_leaves(own);
    }
    if (!status) {
        system->n_cells = g->cells->n_cells;
        memcpy(system->cell_of, g->cells->cell_of,
               system->scene->n_leaves * sizeof *system->cell_of);
    }
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

/* Means over leaves of the cell, by area; the places of leaves are their middles. */
static void look_from_cell(const pps_system_own *own, size_t c) {
    const grid *g = own->way;
    size_t n = g->first[c + 1] - g->first[c], step = n / MOST_LOOKS + 1;
    double whole = 0;
    pps_sun_look sum = {0, 0, 0, 0};
    for (size_t k = g->first[c]; k < g->first[c + 1]; k += step) {
        pps_scene_leaf leaf;
        pps_scene_leaf_at(own->system.scene, g->leaf[k], &leaf);
        pps_sun_look look =
            pps_system_look_at_sun(own, leaf.instance, leaf.center, leaf.normal);
        whole += leaf.area;
        sum.depth += leaf.area * look.depth;
        sum.behind += leaf.area * look.behind;
        sum.visible += leaf.area * look.visible;
        sum.clear += leaf.area * look.clear;
    }
    if (whole > 0) {
        g->cells->sun_depth[c] = sum.depth / whole;
        g->cells->sun_behind[c] = sum.behind / whole;
        g->cells->sun_visibility[c] = sum.visible / whole;
        g->cells->sun_clear[c] = sum.clear / whole;
    }
}

/* A cell that only has parts of leaves that count elsewhere: the mean of its neighbours. */
static void borrow(pps_cells *cells, const size_t *first, size_t c) {
    size_t stride[3] = {1, (size_t)cells->n[0],
                        (size_t)cells->n[0] * (size_t)cells->n[1]};
    double n = 0, sum[4] = {0, 0, 0, 0};
    for (int k = 0; k < 6; k++) {
        int axis = k / 2;
        size_t at = c / stride[axis] % (size_t)cells->n[axis];
        bool inside = k % 2 ? at + 1 < (size_t)cells->n[axis] : at > 0;
        size_t other = k % 2 ? c + stride[axis] : c - stride[axis];
        if (inside && first[other + 1] > first[other]) {
            sum[0] += cells->sun_depth[other];
            sum[1] += cells->sun_behind[other];
            sum[2] += cells->sun_visibility[other];
            sum[3] += cells->sun_clear[other];
            n++;
        }
    }
    cells->sun_depth[c] = n > 0 ? sum[0] / n : 0;
    cells->sun_behind[c] = n > 0 ? sum[1] / n : 0;
    cells->sun_visibility[c] = n > 0 ? sum[2] / n : 1;
    cells->sun_clear[c] = n > 0 ? sum[3] / n : 1;
}

static pps_status light_sun(pps_system_own *own) {
    grid *g = own->way;
    pps_cells *cells = g->cells;
#pragma omp parallel for num_threads(own->threads) schedule(dynamic, 16)
    for (size_t c = 0; c < cells->n_cells; c++) {
        look_from_cell(own, c);
    }
    for (size_t c = 0; c < cells->n_cells; c++) {
        if (cells->area[c] > 0 && g->first[c + 1] == g->first[c]) {
            borrow(cells, g->first, c);
        }
    }
    pps_status status = solve(own, SYSTEM_SUN, PPS_SUN | PPS_SUN_INDIRECT);
    if (!status) {
        own->system.sun = g->field[SYSTEM_SUN]->sun;
    }
    return status;
}

const pps_system_steps pps_system_grid = {create,  free_way,  construct_cells, nothing,
                                          nothing, light_sky, light_sun};
