/* Cells: leaf area, depths and visibilities where they are known exactly.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/cells.h>
#include <ppscat/tree/light.h>

#include "plants.h"
#include "support/support.h"
#include "tree/leafpoint.h"
#include "tree/vec.h"

static pps_cells *make_cells(const pps_scene *scene, int across, int samples,
                             int threads) {
    pps_cells_options options = {
        .across = across, .samples = samples, .seed = 11, .threads = threads};
    pps_cells *cells;
    assert_int_equal(pps_cells_create(scene, &options, &cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(cells, scene, &options), PPS_OK);
    return cells;
}

/* Seven sheets, and a branch that shades the lowest two. */
static void a_stack_of_sheets_has_whole_depths(void **state) {
    (void)state;
    enum { N = 7 };
    square at[N + 1];
    for (int i = 0; i < N; i++) {
        at[i] = (square){0, 0, i, LEAF};
    }
    at[N] = (square){0, 0, 1.5, WOOD};
    pps_scene *scene = scene_of(squares(N + 1, at));
    pps_cells *cells = make_cells(scene, 12, 40, 1);
    for (size_t leaf = 0; leaf < N; leaf++) {
        uint32_t c = cells->cell_of[leaf];
        int above = N - 1 - (int)leaf + (leaf < 2), below = (int)leaf + (leaf >= 2);
        assert_close(cells->sun_depth[c], above, 1e-14, 0);
        assert_close(cells->sun_behind[c], below, 1e-14, 0);
        assert_close(cells->sun_visibility[c], above == 0, 1e-14, 0);
        assert_close((double)cells->leaf_sun[leaf][PPS_FRONT], above == 0, 1e-7, 0);
        assert_close((double)cells->leaf_sun[leaf][PPS_BACK], 0, 0, 0);
        /* directions 0 and 1 are the poles */
        assert_close((double)cells->depth[c * 22], above, 1e-7, 0);
        assert_close((double)cells->depth[c * 22 + 1], below, 1e-7, 0);
        assert_close((double)cells->visibility[c * 22 + 1], below == 0, 1e-7, 0);
    }
    pps_cells_free(cells);
    pps_scene_free(scene);
}

static void grids_cover_the_leaves(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_TALL, 3, 2000, 1);
    scene->instance = realloc(scene->instance, 2 * sizeof *scene->instance);
    scene->n_instances = 2;
    scene->instance[1] = (pps_instance){0, {3, 1, 0.2}, 40, 0.7};
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    for (int periodic = 0; periodic < 2; periodic++) {
        scene->period[0] = periodic ? 4 : 0;
        scene->period[1] = periodic ? 3 : 0;
        pps_cells *cells = make_cells(scene, 0, 1, 0);
        double want = scene->prototype[0].mesh->leaf[0].area * 2000 * (1 + 0.49),
               sum = 0;
        size_t leaves = 0;
        for (size_t c = 0; c < cells->n_cells; c++) {
            sum += cells->area[c];
            leaves += cells->n_leaves[c];
            assert_true(!cells->n_leaves[c] || cells->area[c] > 0);
        }
        assert_close(sum, want, 1e-12, 0);
        assert_int_equal(leaves, scene->n_leaves);
        assert_int_equal(cells->n_cells, cells->n[0] * cells->n[1] * cells->n[2]);
        for (int i = 0; i < 2 && periodic; i++) {
            assert_close(cells->n[i] * cells->size, scene->period[i], 1e-14, 0);
        }
        assert_true(cells->size > 4.0 / 18 && cells->size < 4.0 / 14);
        for (size_t i = 0; i < scene->n_leaves; i++) { /* one point a leaf: near it */
            pps_scene_leaf leaf;
            pps_scene_leaf_at(scene, i, &leaf);
            size_t c = cells->cell_of[i], nx = (size_t)cells->n[0],
                   ny = (size_t)cells->n[1];
            size_t of[3] = {c % nx, c / nx % ny, c / nx / ny};
            for (int k = 0; k < 3; k++) {
                double middle = cells->low[k] + ((double)of[k] + 0.5) * cells->size;
                double off = leaf.center[k] - middle;
                off -= periodic && k < 2
                           ? scene->period[k] * round(off / scene->period[k])
                           : 0;
                assert_close(off, 0, 0, cells->size / 2 + 0.06);
            }
        }
        pps_cells_free(cells);
    }
    pps_scene_free(scene);
}

/* Mean depth and visibility over one level of cells, towards directions of height mu. */
typedef struct {
    double depth, visibility;
    int directions;
} level_mean;

static level_mean mean_of_level(const pps_cells *cells, int z, double mu) {
    size_t layer = (size_t)cells->n[0] * (size_t)cells->n[1];
    level_mean mean = {0, 0, 0};
    double whole = 0;
    for (size_t j = 0; j < 22; j++) {
        if (fabs(cells->directions.to[j][2] - mu) < 1e-9) {
            mean.directions++;
            for (size_t c = (size_t)z * layer; c < ((size_t)z + 1) * layer; c++) {
                whole += cells->area[c];
                mean.depth += cells->area[c] * (double)cells->depth[c * 22 + j];
                mean.visibility +=
                    cells->area[c] * (double)cells->visibility[c * 22 + j];
            }
        }
    }
    mean.depth /= whole;
    mean.visibility /= whole;
    return mean;
}

/* In an endless layer of leaves of random orientation light goes as exp(-L/(2 mu)) where L
 * is the leaf-area index crossed, and the mean count is L/(2 mu). */
static void a_layer_attenuates_as_beer_has_it(void **state) {
    (void)state;
    const double L = 2;
    pps_scene *scene = layer_scene(L, 20000, 3);
    pps_cells *cells = make_cells(scene, 10, 1, 0);
    assert_true(cells->periodic);
    for (int j = 0; j < cells->directions.n; j++) {
        double mu = cells->directions.to[j][2], k = L / (2 * fabs(mu));
        for (int z = 0; z < cells->n[2]; z++) {
            level_mean got = mean_of_level(cells, z, mu);
            /* the level's part of the height 0..1, and the heights in front of it */
            double low = fmax(cells->low[2] + z * cells->size, 0);
            double high = fmin(cells->low[2] + (z + 1) * cells->size, 1);
            double from = mu > 0 ? 1 - high : low, to = mu > 0 ? 1 - low : high;
            double beer = (exp(-k * from) - exp(-k * to)) / (k * (to - from));
            /* four standard errors of some 2000 leaves a level */
            double error = 4 * sqrt(0.25 / 2000 / got.directions);
            assert_close(got.visibility, beer, 0, error);
            assert_close(got.depth, k * (from + to) / 2, 0.02, 0.03);
        }
    }
    pps_cells_free(cells);
    pps_scene_free(scene);
}

/* With fewer points a cell the directions get noisier, not different; the sun keeps all. */
static void few_points_a_cell_are_a_fair_sample(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 4, 4000, 8);
    pps_cells_options options = {.across = 4, .samples = 4, .seed = 11};
    pps_cells *few, *all;
    options.most_points = 20;
    assert_int_equal(pps_cells_create(scene, &options, &few), PPS_OK);
    options.most_points = 1000000;
    assert_int_equal(pps_cells_create(scene, &options, &all), PPS_OK);
    assert_int_equal(pps_cells_set_sun(few, scene, NULL), PPS_OK);
    assert_int_equal(pps_cells_set_sun(all, scene, NULL), PPS_OK);
    size_t n = all->n_cells;
    assert_memory_equal(few->sun_depth, all->sun_depth, n * sizeof *few->sun_depth);
    assert_memory_equal(few->area, all->area, n * sizeof *few->area);
    double off = 0, spread = 0, count = 0;
    for (size_t i = 0; i < 22 * n; i++) {
        if (all->n_leaves[i / 22] > 40) {
            double d = (double)few->visibility[i] - (double)all->visibility[i];
            off += d;
            spread += d * d;
            count++;
        }
    }
    assert_true(count > 500);
    /* 20 points: at most sqrt(.25/20) = .11 each; those of a cell share their blockers */
    assert_true(sqrt(spread / count) > 0.02 && sqrt(spread / count) < 0.11);
    assert_close(off / count, 0, 0, 4 * 0.11 / sqrt(count / 22));
    pps_cells_free(few);
    pps_cells_free(all);
    pps_scene_free(scene);
}

/* Leaves whose right half is cut out: every part of the left half has its share of points,
 * whatever fell into the hole before. */
static void points_are_fair_beside_a_hole(void **state) {
    (void)state;
    enum { LEAVES = 3000, POINTS = 8, PARTS = 8 };
    square *at = calloc(LEAVES, sizeof *at);
    for (int i = 0; i < LEAVES; i++) {
        at[i] = (square){0, 0, i, LEAF};
    }
    pps_mesh *mesh = squares(LEAVES, at);
    cut_right_half(mesh);
    pps_scene *scene = scene_of(mesh);
    double share[PARTS] = {0};
    for (size_t leaf = 0; leaf < LEAVES; leaf++) {
        for (uint64_t k = 0; k < POINTS; k++) {
            pps_leaf_point p;
            pps_leaf_point_spread(scene, leaf, 5, PPS_RANDOM_CELLS, k, &p);
            double part = floor(2 * PARTS * 0.9999 * p.point[0]); /* of the texture */
            assert_true(part >= 0 && part < PARTS);
            share[(int)part] += 1.0 / (LEAVES * POINTS);
        }
    }
    for (int i = 0; i < PARTS; i++) { /* 5 standard deviations of free draws */
        assert_close(share[i], 1.0 / PARTS, 0.085, 0);
    }
    pps_scene_free(scene);
    free(at);
}

/* The sun's light that falls on leaves, by their own points and by light tracing. */
static void leaves_own_sunlight_is_what_falls_on_them(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 8, 3000, 4);
    pps_trace_options sun = {.rays = 1000000, .sources = PPS_SUN};
    pps_irradiance *truth;
    double sum[2] = {0, 0}, error = 0, squares_sum = 0;
    memcpy(scene->sun.to, (double[]){0.6, 0, 0.8}, sizeof scene->sun.to);
    pps_cells *cells = make_cells(scene, 0, 0, 0);
    assert_int_equal(pps_trace_light(scene, &sun, &truth, NULL), PPS_OK);
    for (size_t i = 0; i < scene->n_leaves; i++) {
        const double traced[2] = {truth->front[i], truth->back[i]};
        for (int face = 0; face < 2; face++) {
            double own = (double)cells->leaf_sun[i][face];
            sum[0] += own;
            sum[1] += traced[face];
            error += pow(own - traced[face], 2);
            squares_sum += pow(traced[face], 2);
        }
    }
    assert_close(sum[0], sum[1], 0.01, 0);
    assert_true(sqrt(error / squares_sum) < 0.15); /* by cells .4 */
    pps_irradiance_free(truth);
    pps_cells_free(cells);
    pps_scene_free(scene);
}

static void threads_never_change_a_bit(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 4, 1500, 8);
    scene->period[0] = scene->period[1] = 1.8;
    pps_cells *one = make_cells(scene, 8, 2, 1), *four = make_cells(scene, 8, 2, 4);
    size_t n = one->n_cells;
    assert_int_equal(n, four->n_cells);
    assert_memory_equal(one->area, four->area, n * sizeof *one->area);
    assert_memory_equal(one->depth, four->depth, n * 22 * sizeof *one->depth);
    assert_memory_equal(one->visibility, four->visibility, n * 22 * sizeof *one->depth);
    assert_memory_equal(one->sun_depth, four->sun_depth, n * sizeof *one->sun_depth);
    assert_memory_equal(one->leaf_sun, four->leaf_sun, 1500 * sizeof *one->leaf_sun);
    assert_memory_equal(one->cell_of, four->cell_of, 1500 * sizeof *one->cell_of);
    pps_cells_free(one);
    pps_cells_free(four);
    pps_scene_free(scene);
}

static void what_cannot_be_done_is_refused(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 1, 50, 8);
    pps_cells *cells;
    pps_cells_options negative = {.across = -1}, none = {.samples = -1},
                      fine = {.across = 100000}, few = {.most_points = -1};
    assert_int_equal(pps_cells_create(scene, &few, &cells), PPS_ERR_ARGUMENT);
    few = (pps_cells_options){.sun_samples = -1};
    assert_int_equal(pps_cells_create(scene, NULL, &cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(cells, scene, &few), PPS_ERR_ARGUMENT);
    pps_cells_free(cells);
    assert_int_equal(pps_cells_create(scene, &negative, &cells), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_cells_create(scene, &none, &cells), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_cells_create(scene, &fine, &cells), PPS_ERR_ARGUMENT);
    scene->period[0] = 2;
    scene->period[1] = 2 * sqrt(2);
    assert_int_equal(pps_cells_create(scene, NULL, &cells), PPS_ERR_UNSUPPORTED);
    assert_null(cells);
    pps_scene_free(scene);
    square wood[] = {{0, 0, 0, WOOD}};
    scene = scene_of(squares(1, wood));
    assert_int_equal(pps_cells_create(scene, NULL, &cells), PPS_ERR_ARGUMENT);
    pps_scene_free(scene);
    pps_cells_free(NULL);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stack_of_sheets_has_whole_depths),
        cmocka_unit_test(grids_cover_the_leaves),
        cmocka_unit_test(a_layer_attenuates_as_beer_has_it),
        cmocka_unit_test(few_points_a_cell_are_a_fair_sample),
        cmocka_unit_test(points_are_fair_beside_a_hole),
        cmocka_unit_test(leaves_own_sunlight_is_what_falls_on_them),
        cmocka_unit_test(threads_never_change_a_bit),
        cmocka_unit_test(what_cannot_be_done_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
