/* Cells: leaf area and optical depths of a scene on a grid.
 *
 * Everything is averaged over points drawn on the leaves, by leaf area: a leaf that
 * straddles cells gives each its part, and nothing depends on whether light found a leaf.
 * A branch counts as one leaf in depths, and is opaque in visibilities.
 *
 * References: SPP Eq. 29 for the depths.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/tree/cells.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include "tree/cells_bare.h"
#include "tree/leafpoint.h"
#include "tree/rays.h"
#include "tree/vec.h"
#include "tree/wood.h"

enum {
    DEFAULT_ACROSS = 16,
    DEFAULT_SAMPLES = 8,
    DEFAULT_POINTS = 64,
    SUN_SAMPLES = 32,
    SUN_POINTS = 1 << 20,
    MOST_DIRECTIONS = 22
};
static const double MOST_CELLS = 1e9;

/* The public struct, and what it takes to trace more rays from the same points. */
typedef struct {
    pps_cells cells;
    pps_rays *rays;
    const pps_scene *scene;
    uint64_t seed;
    size_t samples, most_points, n_points;
    uint64_t *point; /* leaf * samples + sample, sorted by cell */
    size_t *first;   /* of each cell's points; n_cells + 1 */
} pps_cells_own;

/* ---- the grid ---- */

/* The longest side of the box of one plant's leaves, the largest plant's. */
static double longest_side(const pps_scene *scene) {
    double most = 0;
    for (size_t p = 0; p < scene->n_prototypes; p++) {
        double scale = 0;
        for (size_t k = 0; k < scene->n_instances; k++) {
            const pps_instance *instance = &scene->instance[k];
            scale =
                (size_t)instance->prototype == p ? fmax(scale, instance->scale) : scale;
        }
        if (scale > 0 && scene->prototype[p].mesh->n_leaves > 0) {
            pps_mesh_size size;
            pps_mesh_measure(scene->prototype[p].mesh, &size);
            for (int i = 0; i < 3; i++) {
                most = fmax(most, scale * (size.leaf_high[i] - size.leaf_low[i]));
            }
        }
    }
    return most;
}

/* The size nearest to `want` that divides both periods; 0 if none does. */
static double size_that_divides(const double period[2], double want) {
    double target = fmax(round(period[0] / want), 1);
    for (double off = 0; off <= 3 * target + 8; off++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            double n = target + sign * off;
            double size = n >= 1 ? period[0] / n : 0;
            double other = size > 0 ? period[1] / size : 0;
            if (other > 0.5 && fabs(other - round(other)) < 1e-9 * other) {
                return size;
            }
        }
    }
    return 0;
}

/* Low corner, size and numbers of the cells: whole cells about the middle of the leaves,
 * or along a period the walls of the central cell. */
static pps_status lay_grid(pps_cells_own *own, int across) {
    pps_cells *c = &own->cells;
    const pps_scene *scene = own->scene;
    pps_box all, leaves;
    pps_scene_box(scene, &all, &leaves);
    double side = longest_side(scene) / (across ? across : DEFAULT_ACROSS), total = 1;
    if (across < 0 || !(side > 0)) {
        return PPS_ERR_ARGUMENT;
    }
    c->periodic = scene->period[0] > 0;
    c->size = c->periodic ? size_that_divides(scene->period, side) : side;
    if (!(c->size > 0)) {
        return PPS_ERR_UNSUPPORTED;
    }
    for (int i = 0; i < 3; i++) {
        bool walls = c->periodic && i < 2;
        double extent = walls ? scene->period[i] : leaves.high[i] - leaves.low[i];
        double n = walls ? round(extent / c->size)
                         : fmax(ceil(extent / c->size * (1 - 1e-12)), 1);
        double middle = (leaves.high[i] + leaves.low[i]) / 2;
        c->low[i] = walls ? pps_rays_cell(own->rays)->low[i] : middle - n * c->size / 2;
        total *= n;
        if (total > MOST_CELLS) {
            return PPS_ERR_ARGUMENT;
        }
        c->n[i] = (int)n;
    }
    c->n_cells = (size_t)total;
    return PPS_OK;
}

static uint32_t cell_at(const pps_cells *c, const double point[3]) {
    size_t at[3];
    for (int i = 0; i < 3; i++) {
        double n = c->n[i], k = floor((point[i] - c->low[i]) / c->size);
        if (c->periodic && i < 2) {
            k -= n * floor(k / n);
        }
        at[i] = (size_t)fmin(fmax(k, 0), n - 1);
    }
    return (uint32_t)((at[2] * (size_t)c->n[1] + at[1]) * (size_t)c->n[0] + at[0]);
}

/* ---- points on leaves ---- */

static pps_leaf_point point_at(const pps_cells_own *own, uint64_t i) {
    pps_leaf_point p;
    pps_leaf_point_spread(own->scene, i / own->samples, own->seed, PPS_RANDOM_CELLS,
                          i % own->samples, &p);
    return p;
}

/* The leaf area that a point stands for. */
static double weight_of(const pps_cells_own *own, uint64_t i) {
    pps_scene_leaf leaf;
    pps_scene_leaf_at(own->scene, i / own->samples, &leaf);
    return leaf.area / (double)own->samples;
}

/* Of a leaf's points, the cell that has the most; the first of equals. */
static uint32_t main_cell(const uint32_t *cell, size_t n) {
    uint32_t best = cell[0];
    size_t most = 0;
    for (size_t i = 0; i < n && n - i > most; i++) {
        size_t same = 0;
        for (size_t j = i; j < n; j++) {
            same += cell[j] == cell[i];
        }
        best = same > most ? cell[i] : best;
        most = same > most ? same : most;
    }
    return best;
}

/* Leaf areas, and the points in order of their cells. */
static pps_status sort_points(pps_cells_own *own, int threads) {
    pps_cells *c = &own->cells;
    size_t n = own->n_points;
    uint32_t *cell = malloc((n + 1) * sizeof *cell);
    if (!cell) {
        return PPS_ERR_MEMORY;
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t i = 0; i < n; i++) {
        pps_leaf_point p = point_at(own, i);
        cell[i] = cell_at(c, p.point);
    }
    for (size_t i = 0; i < n; i++) {
        c->area[cell[i]] += weight_of(own, i);
        own->first[cell[i] + 1]++;
        c->n_points[cell[i]]++;
    }
    for (size_t leaf = 0; leaf < own->scene->n_leaves; leaf++) {
        c->cell_of[leaf] = main_cell(cell + leaf * own->samples, own->samples);
        c->n_leaves[c->cell_of[leaf]]++;
    }
    for (size_t i = 0; i < c->n_cells; i++) {
        own->first[i + 1] += own->first[i];
    }
    for (size_t i = n; i-- > 0;) { /* fills every cell from its end */
        own->point[--own->first[cell[i] + 1]] = i;
    }
    memmove(own->first, own->first + 1, c->n_cells * sizeof *own->first);
    own->first[c->n_cells] = n;
    free(cell);
    return PPS_OK;
}

/* ---- depths ---- */

typedef struct {
    double depth, visibility, facing;
} along;

/* Means over the points of a cell towards n directions: depths by leaf area, visibilities
 * by the area seen from there, as light falls on leaves. Returns the mean over pairs of
 * directions of both being clear, by the areas seen. Of the points it takes at most
 * `most`, at equal steps in the order of leaves. */
static double measure_cell(const pps_cells_own *own, size_t cell, size_t most, int n,
                           const double (*to)[3], along *mean) {
    double whole = 0, pairs = 0, clear_pairs = 0;
    size_t n_points = own->first[cell + 1] - own->first[cell];
    size_t n_used = n_points < most ? n_points : most;
    memset(mean, 0, (size_t)n * sizeof *mean);
    for (size_t k = 0; k < n_used; k++) {
        size_t step = (2 * k + 1) * n_points / (2 * n_used);
        uint64_t i = own->point[own->first[cell] + step];
        pps_leaf_point p = point_at(own, i);
        double weight = weight_of(own, i);
        double seen[2] = {0, 0}, squares[2] = {0, 0}; /* all, clear */
        whole += weight;
        for (int j = 0; j < n; j++) {
            pps_line line = pps_rays_leave(own->rays, p.point, p.normal, to[j]);
            bool wood;
            int count = pps_rays_count(own->rays, &line, &wood);
            mean[j].depth += weight * (count + wood);
            double facing = fabs(vec_dot(p.normal, to[j]));
            double clear = count == 0 && !wood ? facing : 0;
            mean[j].facing += weight * facing;
            mean[j].visibility += weight * clear;
            seen[0] += facing;
            seen[1] += clear;
            squares[0] += facing * facing;
            squares[1] += clear * clear;
        }
        pairs += weight * (seen[0] * seen[0] - squares[0]);
        clear_pairs += weight * (seen[1] * seen[1] - squares[1]);
    }
    for (int j = 0; j < n && whole > 0; j++) {
        mean[j].depth /= whole;
        mean[j].visibility /= fmax(mean[j].facing, 1e-300);
    }
    return pairs > 0 ? clear_pairs / pairs : 0;
}

static void measure_directions(pps_cells_own *own, int threads) {
    pps_cells *c = &own->cells;
    size_t n = (size_t)c->directions.n;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (size_t cell = 0; cell < c->n_cells; cell++) {
        along mean[MOST_DIRECTIONS];
        c->both_clear[cell] =
            measure_cell(own, cell, own->most_points, (int)n, c->directions.to, mean);
        for (size_t j = 0; j < n; j++) {
            c->depth[cell * n + j] = (float)mean[j].depth;
            c->visibility[cell * n + j] = (float)mean[j].visibility;
        }
    }
}

/* ---- the sun ---- */

/* Cells are a third of the light's decay wide in a dense crown, and a leaf may lie in two:
 * so each leaf's own sunlight is seen from its own points. */
static size_t sun_samples(const pps_cells_own *own, const pps_cells_options *options) {
    if (options && options->sun_samples) {
        return (size_t)options->sun_samples;
    }
    size_t n = SUN_POINTS / own->scene->n_leaves;
    n = n < SUN_SAMPLES ? n : SUN_SAMPLES;
    return n > own->samples ? n : own->samples;
}

static void measure_leaf_sun(const pps_cells_own *own, size_t leaf, size_t n,
                             const double to[3], float sun[2]) {
    double face[2] = {0, 0};
    for (size_t k = 0; k < n; k++) {
        pps_leaf_point p;
        pps_leaf_point_spread(own->scene, leaf, own->seed, PPS_RANDOM_CELLS, k, &p);
        pps_line line = pps_rays_leave(own->rays, p.point, p.normal, to);
        if (!pps_rays_occluded(own->rays, &line)) {
            double cosine = vec_dot(p.normal, to);
            face[cosine < 0] += fabs(cosine);
        }
    }
    for (int i = 0; i < 2; i++) {
        sun[i] = (float)(face[i] / (double)n);
    }
}

static int thread_count(const pps_cells_options *options) {
    return options && options->threads > 0 ? options->threads : omp_get_max_threads();
}

pps_status pps_cells_set_sun(pps_cells *cells, const pps_scene *scene,
                             const pps_cells_options *options) {
    const pps_cells_own *own = (const pps_cells_own *)cells;
    const double *s = scene->sun.to;
    const double to[2][3] = {{s[0], s[1], s[2]}, {-s[0], -s[1], -s[2]}};
    size_t n_leaves = own->scene->n_leaves, samples = sun_samples(own, options);
    if (!(fabs(vec_length(s) - 1) < 1e-9) || (options && options->sun_samples < 0)) {
        return PPS_ERR_ARGUMENT;
    }
    if (!cells->leaf_sun) {
        cells->leaf_sun = malloc(n_leaves * sizeof *cells->leaf_sun);
    }
    if (!cells->leaf_sun) {
        return PPS_ERR_MEMORY;
    }
#pragma omp parallel for num_threads(thread_count(options)) schedule(dynamic, 64)
    for (size_t leaf = 0; leaf < n_leaves; leaf++) {
        measure_leaf_sun(own, leaf, samples, s, cells->leaf_sun[leaf]);
    }
#pragma omp parallel for num_threads(thread_count(options)) schedule(dynamic, 16)
    for (size_t cell = 0; cell < cells->n_cells; cell++) {
        along mean[2];
        measure_cell(own, cell, SIZE_MAX, 2, to, mean);
        cells->sun_depth[cell] = mean[0].depth;
        cells->sun_behind[cell] = mean[1].depth;
        cells->sun_visibility[cell] = mean[0].visibility;
        cells->sun_clear[cell] = mean[1].visibility;
    }
    return PPS_OK;
}

/* ---- life ---- */

static pps_status reserve(pps_cells_own *own) {
    pps_cells *c = &own->cells;
    size_t n = c->n_cells, nj = n * (size_t)c->directions.n;
    c->area = calloc(n, sizeof *c->area);
    c->wood = calloc(n, sizeof *c->wood);
    c->cell_of = calloc(own->scene->n_leaves, sizeof *c->cell_of);
    c->n_leaves = calloc(n, sizeof *c->n_leaves);
    c->n_points = calloc(n, sizeof *c->n_points);
    c->sun_depth = calloc(n, sizeof *c->sun_depth);
    c->sun_behind = calloc(n, sizeof *c->sun_behind);
    c->sun_visibility = calloc(n, sizeof *c->sun_visibility);
    c->sun_clear = calloc(n, sizeof *c->sun_clear);
    c->depth = calloc(nj, sizeof *c->depth);
    c->visibility = calloc(nj, sizeof *c->visibility);
    c->both_clear = calloc(n, sizeof *c->both_clear);
    own->point = malloc((own->n_points + 1) * sizeof *own->point);
    own->first = calloc(n + 2, sizeof *own->first);
    bool all = c->area && c->wood && c->cell_of && c->n_leaves && c->n_points &&
               c->sun_depth && c->sun_behind && c->sun_visibility && c->sun_clear &&
               c->depth && c->visibility && own->point && own->first;
    return all ? PPS_OK : PPS_ERR_MEMORY;
}

static pps_status build(pps_cells_own *own, const pps_cells_options *options) {
    int threads = thread_count(options);
    pps_status status = pps_rays_create(own->scene, &own->rays);
    if (!status) {
        status = lay_grid(own, options ? options->across : 0);
    }
    if (!status) {
        status = reserve(own);
    }
    if (!status) {
        pps_wood_measure(own->scene, &own->cells);
        status = sort_points(own, threads);
    }
    return status;
}

pps_status pps_cells_create(const pps_scene *scene, const pps_cells_options *options,
                            pps_cells **out) {
    pps_status status = pps_cells_create_bare(scene, options, out);
    if (!status) {
        measure_directions((pps_cells_own *)*out, thread_count(options));
    }
    return status;
}

pps_status pps_cells_create_bare(const pps_scene *scene,
                                 const pps_cells_options *options, pps_cells **out) {
    *out = NULL;
    if (!scene || !scene->first_leaf ||
        (options && (options->samples < 0 || options->most_points < 0))) {
        return PPS_ERR_ARGUMENT;
    }
    pps_cells_own *own = calloc(1, sizeof *own);
    if (!own) {
        return PPS_ERR_MEMORY;
    }
    own->cells.directions = pps_directions_22();
    own->scene = scene;
    own->seed = options ? options->seed : 0;
    own->samples =
        options && options->samples ? (size_t)options->samples : DEFAULT_SAMPLES;
    own->most_points =
        options && options->most_points ? (size_t)options->most_points : DEFAULT_POINTS;
    own->n_points = scene->n_leaves * own->samples;
    pps_status status = build(own, options);
    if (status) {
        pps_cells_free(&own->cells);
        return status;
    }
    *out = &own->cells;
    return PPS_OK;
}

void pps_cells_free(pps_cells *cells) {
    if (!cells) {
        return;
    }
    pps_cells_own *own = (pps_cells_own *)cells;
    pps_rays_free(own->rays);
    free(own->point);
    free(own->first);
    free(cells->area);
    free(cells->wood);
    free(cells->cell_of);
    free(cells->n_leaves);
    free(cells->n_points);
    free(cells->sun_depth);
    free(cells->sun_behind);
    free(cells->sun_visibility);
    free(cells->sun_clear);
    free(cells->leaf_sun);
    free(cells->depth);
    free(cells->visibility);
    free(cells->both_clear);
    free(own);
}
