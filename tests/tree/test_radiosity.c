/* Radiosity from leaf to leaf: enclosures, Monte Carlo, trees made by others.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <ppscat/tree/experiment.h>

#include "plants.h"
#include "support/support.h"

static const pps_light_model *radiosity(void) {
    return pps_light_model_find("radiosity");
}

/* A scene with its cells; of the sun as it stands. */
typedef struct {
    pps_scene *scene;
    pps_cells *cells;
} stage;

static stage stage_of(pps_scene *scene) {
    stage s = {.scene = scene};
    assert_int_equal(pps_cells_create(scene, NULL, &s.cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(s.cells, scene, NULL), PPS_OK);
    return s;
}

static void stage_free(stage *s) {
    pps_cells_free(s->cells);
    pps_scene_free(s->scene);
}

static pps_irradiance *light_of(const stage *s, const char *model, unsigned sources) {
    pps_light_options options = {.sources = sources};
    pps_irradiance *light;
    assert_int_equal(pps_light_model_run(pps_light_model_find(model), s->scene,
                                         s->cells, &options, &light),
                     PPS_OK);
    return light;
}

/* Mean of both faces over the leaves, by area. */
static double mean_of(const stage *s, const pps_irradiance *light, int band) {
    double sum = 0, area = 0;
    for (size_t i = 0; i < s->scene->n_leaves; i++) {
        pps_scene_leaf at;
        size_t k = i * (size_t)light->n_bands + (size_t)band;
        pps_scene_leaf_at(s->scene, i, &at);
        sum += at.area * (light->front[k] + light->back[k]) / 2;
        area += at.area;
    }
    return sum / area;
}

/* Light of one radiance from all sides stays what it is among leaves that do not absorb. */
static void white_leaves_change_nothing_under_an_even_sky(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 5, 2000, 3);
    pps_leaf_optics *o = &scene->prototype[0].optics;
    for (int face = 0; face < 2; face++) {
        o->reflectance[face][0] = 0.3;
        o->transmittance[face][0] = 0.7;
    }
    scene->sun.irradiance[0] = 0;
    scene->sky.zenith[0] = scene->sky.horizon[0] = scene->sky.below[0] = 1 / acos(-1);
    stage s = stage_of(scene);
    pps_irradiance *light = light_of(&s, "radiosity", 0);
    for (size_t i = 0; i < light->n_leaves; i++) {
        assert_close(light->front[i], 1, 0, 5e-3);
        assert_close(light->back[i], 1, 0, 5e-3);
    }
    pps_irradiance_free(light);
    stage_free(&s);
}

/* Root mean square of a leaf's error, over its root mean square; without the reference's
 * noise. */
static double leaf_error(const stage *s, const pps_irradiance *light,
                         const pps_irradiance *truth, int band) {
    double error = 0, size = 0;
    for (size_t i = 0; i < light->n_leaves; i++) {
        size_t k = i * (size_t)light->n_bands + (size_t)band;
        double want = truth->front[k] + truth->back[k];
        double noise = pow(truth->front_error[k], 2) + pow(truth->back_error[k], 2);
        pps_scene_leaf at;
        pps_scene_leaf_at(s->scene, i, &at);
        error += at.area * (pow(light->front[k] + light->back[k] - want, 2) - noise);
        size += at.area * (want * want - noise);
    }
    return sqrt(fmax(error, 0) / size);
}

/* Turned and scaled instances, wood, bands that differ in all optics, sun and sky; open or
 * repeating, over a ground or not. */
static void it_agrees_with_monte_carlo_everywhere(void **state) {
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        stage s = stage_of(three_bands(kind & 1, kind & 2));
        const unsigned indirect = PPS_SUN_INDIRECT | PPS_SKY_INDIRECT;
        pps_trace_options trace = {.rays = 250000, .seed = 5};
        pps_irradiance *truth, *light = light_of(&s, "radiosity", 0),
                               *lattice = light_of(&s, "lattice", 0),
                               *scattered = light_of(&s, "radiosity", indirect);
        assert_int_equal(pps_trace_light(s.scene, &trace, &truth, NULL), PPS_OK);
        for (int b = 0; b < 3; b++) {
            double ratio = mean_of(&s, light, b) / mean_of(&s, truth, b);
            double error = leaf_error(&s, light, truth, b),
                   cells = leaf_error(&s, lattice, truth, b);
            print_message(
                "%s, %s, band %d: mean %.3f (%.3f), leaf %.3f, lattice %.3f\n",
                kind & 1 ? "repeating" : "open", kind & 2 ? "ground" : "none", b, ratio,
                mean_of(&s, lattice, b) / mean_of(&s, truth, b), error, cells);
            assert_close(ratio, 1, 0, 0.02);
            assert_true(error < cells);
        }
        for (size_t i = 0; i < 3 * light->n_leaves; i++) {
            assert_true(light->front[i] >= scattered->front[i]);
        }
        pps_irradiance_free(truth);
        pps_irradiance_free(light);
        pps_irradiance_free(lattice);
        pps_irradiance_free(scattered);
        stage_free(&s);
    }
}

/* ez-tree's oaks: cut-out cards on twigs, and opaque cards longer than a mean free path. */
static void it_holds_on_trees_made_by_others(void **state) {
    (void)state;
    static const struct {
        const char *file;
        double by_count, mean;
    } trees[] = {{"/trees/oak_small.obj", 0.04, 0.02},
                 {"/trees/oak_medium.glb", 0.12, 0.07}};
    static const double albedo[3] = {0.5, 0.8, 0.95};
    const pps_contender contender = {.label = "radiosity", .model = radiosity()};
    for (int t = 0; t < 2; t++) {
        char path[512];
        pps_mesh *mesh;
        pps_scene *scene;
        pps_irradiance *truth;
        pps_score score[3];
        snprintf(path, sizeof path, "%s%s", PPS_DATA_DIR, trees[t].file);
        assert_int_equal(pps_mesh_read(path, NULL, &mesh, NULL), PPS_OK);
        assert_int_equal(pps_scene_single(mesh, 0.5, &scene), PPS_OK);
        set_albedos(scene, 3, albedo);
        stage s = stage_of(scene);
        pps_trace_options trace = {.rays = 250000, .seed = 88001};
        assert_int_equal(pps_trace_light(scene, &trace, &truth, NULL), PPS_OK);
        assert_int_equal(
            pps_score_models(scene, s.cells, truth, 0, 1, &contender, 1, score),
            PPS_OK);
        for (int b = 0; b < 3; b++) {
            print_message("%s, albedo %g: category %.1f, by count %.1f, mean %.3f\n",
                          trees[t].file, albedo[b], 100 * score[b].category[0],
                          100 * score[b].by_count[0], score[b].brightness);
            assert_true(score[b].by_count[0] <= trees[t].by_count);
            assert_close(score[b].brightness, 1, 0, trees[t].mean);
        }
        pps_irradiance_free(truth);
        stage_free(&s);
    }
}

static pps_light_field *solved(const stage *s, int threads, pps_light_field *field) {
    pps_light_options options = {.threads = threads};
    assert_int_equal(
        pps_light_field_solve(radiosity(), s->scene, s->cells, &options, &field),
        PPS_OK);
    return field;
}

static void threads_do_not_change_the_answer(void **state) {
    (void)state;
    stage s = stage_of(three_bands(false, true));
    pps_light_field *one = solved(&s, 1, NULL), *three = solved(&s, 3, NULL);
    size_t n = 2 * s.scene->n_leaves * 3;
    assert_memory_equal(one->leaf_scattered, three->leaf_scattered, n * sizeof(float));
    assert_memory_equal(one->leaf_sun, three->leaf_sun,
                        2 * s.scene->n_leaves * sizeof(float));
    pps_light_field_free(one);
    pps_light_field_free(three);
    stage_free(&s);
}

/* From the last answer to that of a moved sun, which is the one from none. */
static void a_moved_sun_finds_the_same_answer(void **state) {
    (void)state;
    stage s = stage_of(three_bands(true, true));
    pps_light_field *moved = solved(&s, 1, NULL);
    memcpy(s.scene->sun.to, (double[3]){-0.6, 0, 0.8}, sizeof s.scene->sun.to);
    assert_int_equal(pps_cells_set_sun(s.cells, s.scene, NULL), PPS_OK);
    moved = solved(&s, 1, moved);
    pps_light_field *fresh = solved(&s, 1, NULL);
    size_t n = 2 * s.scene->n_leaves * 3;
    double off = 0, sum = 0;
    for (size_t i = 0; i < n; i++) {
        off +=
            fabs((double)moved->leaf_scattered[i] - (double)fresh->leaf_scattered[i]);
        sum += (double)fresh->leaf_scattered[i];
    }
    assert_true(off < 2e-3 * sum);
    pps_light_field_forget(moved);
    moved = solved(&s, 1, moved);
    assert_memory_equal(moved->leaf_scattered, fresh->leaf_scattered,
                        n * sizeof(float));
    pps_light_field_free(moved);
    pps_light_field_free(fresh);
    stage_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_leaves_change_nothing_under_an_even_sky),
        cmocka_unit_test(it_agrees_with_monte_carlo_everywhere),
        cmocka_unit_test(it_holds_on_trees_made_by_others),
        cmocka_unit_test(threads_do_not_change_the_answer),
        cmocka_unit_test(a_moved_sun_finds_the_same_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
