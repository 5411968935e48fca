/* The per-leaf models on a crown, against Monte Carlo.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>
#include <ppscat/tree/model.h>
#include <ppscat/tree/seen.h>

#include "support/support.h"
#include "tree/vec.h"

/* A crown under an oblique sun and a sky, and its cells. */
typedef struct {
    pps_scene *scene;
    pps_cells *cells;
} stage;

static stage make_stage(pps_crown crown) {
    pps_mesh *mesh;
    stage s;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    assert_int_equal(pps_scene_single(mesh, 0.7, &s.scene), PPS_OK);
    memcpy(s.scene->sun.to, (double[]){0.5, 0.3, 0.8}, sizeof s.scene->sun.to);
    vec_normalize(s.scene->sun.to);
    s.scene->sky.zenith[0] = s.scene->sky.horizon[0] = 0.1;
    assert_int_equal(pps_cells_create(s.scene, NULL, &s.cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(s.cells, s.scene, NULL), PPS_OK);
    return s;
}

static stage dense_stage(uint64_t seed) {
    return make_stage((pps_crown){PPS_CROWN_UNIFORM, 4, 3000, seed});
}

static void stage_free(stage *s) {
    pps_cells_free(s->cells);
    pps_scene_free(s->scene);
}

static double mean_light(const pps_irradiance *light) {
    double sum = 0;
    for (size_t i = 0; i < light->n_leaves; i++) {
        sum += (light->front[i] + light->back[i]) / (double)light->n_leaves;
    }
    return sum;
}

static double model_mean(const stage *s, const char *name, unsigned sources,
                         pps_sun_mean mean_of) {
    pps_light_options options = {.sources = sources, .sun_mean = mean_of};
    pps_irradiance *light;
    assert_int_equal(pps_light_model_run(pps_light_model_find(name), s->scene, s->cells,
                                         &options, &light),
                     PPS_OK);
    double mean = mean_light(light);
    pps_irradiance_free(light);
    return mean;
}

static double truth_mean(const stage *s, unsigned sources, int bounces) {
    pps_trace_options options = {
        .rays = 300000, .seed = 1, .bounces = bounces, .sources = sources};
    pps_irradiance *light;
    assert_int_equal(pps_trace_light(s->scene, &options, &light, NULL), PPS_OK);
    double mean = mean_light(light);
    pps_irradiance_free(light);
    return mean;
}

/* An independent prototype had on such crowns: sky .94-.99; sun as printed .62-.92,
 * unbiased .90-.99; one bounce as printed .80-.98. */
static void components_of_leaf_have_the_brightness_of_one_bounce(void **state) {
    (void)state;
    stage s = dense_stage(61);
    static const struct {
        unsigned sources;
        pps_sun_mean mean;
        double low, high;
    } parts[] = {{PPS_SKY, PPS_SUN_PRINTED, 0.92, 1.03},
                 {PPS_SUN, PPS_SUN_PRINTED, 0.7, 0.95},
                 {PPS_SUN, PPS_SUN_UNBIASED, 0.88, 1.02},
                 {PPS_SUN_INDIRECT, PPS_SUN_PRINTED, 0.8, 0.98}};
    for (int i = 0; i < 4; i++) {
        double ratio = model_mean(&s, "leaf", parts[i].sources, parts[i].mean) /
                       truth_mean(&s, parts[i].sources, 1);
        print_message("sources %u: %.3f of Monte Carlo\n", parts[i].sources, ratio);
        assert_true(ratio > parts[i].low && ratio < parts[i].high);
    }
    stage_free(&s);
}

/* Weighted by cosines, the octants' mean would be over 1.05 from behind: a leaf in the
 * crown's shade would see past it. */
static void the_unbiased_sun_holds_from_every_side(void **state) {
    (void)state;
    stage s = make_stage((pps_crown){PPS_CROWN_UNIFORM, 6, 1500, 64});
    pps_cells_options points = {.sun_samples = 256};
    pps_light_options options = {.sources = PPS_SUN, .sun_mean = PPS_SUN_UNBIASED};
    pps_irradiance *truth, *light;
    assert_int_equal(pps_cells_set_sun(s.cells, s.scene, &points), PPS_OK);
    assert_int_equal(pps_irradiance_create(s.scene, false, &truth), PPS_OK);
    for (size_t i = 0; i < s.scene->n_leaves; i++) {
        double e = s.scene->sun.irradiance[0];
        truth->front[i] = e * (double)s.cells->leaf_sun[i][PPS_FRONT];
        truth->back[i] = e * (double)s.cells->leaf_sun[i][PPS_BACK];
    }
    assert_int_equal(pps_light_model_run(pps_light_model_find("leaf"), s.scene, NULL,
                                         &options, &light),
                     PPS_OK);
    const double x = 0.5 / hypot(0.5, 0.3), y = 0.3 / hypot(0.5, 0.3);
    const double views[3][3] = {{x, y, 0}, {-x, -y, 0}, {y, -x, 0}};
    for (int i = 0; i < 3; i++) {
        pps_seen_difference seen;
        assert_int_equal(pps_seen_compare(s.scene, truth, light, views[i], 128, &seen),
                         PPS_OK);
        print_message("view %d: mean %.3f, %.1f %% of the brightest\n", i, seen.ratio,
                      100 * seen.over_top);
        assert_true(seen.ratio > 0.88 && seen.ratio < 1.02);
        assert_true(seen.over_top < 0.09);
    }
    pps_irradiance_free(truth);
    pps_irradiance_free(light);
    stage_free(&s);
}

/* All bounces: one is far too dark, the lattice makes up the rest. */
static void the_lattice_continues_where_one_bounce_ends(void **state) {
    (void)state;
    stage s = dense_stage(62);
    double truth = truth_mean(&s, PPS_SUN_INDIRECT, 0);
    double one = model_mean(&s, "leaf", PPS_SUN_INDIRECT, PPS_SUN_UNBIASED) / truth;
    double all =
        model_mean(&s, "leaf-lattice", PPS_SUN_INDIRECT, PPS_SUN_UNBIASED) / truth;
    print_message("indirect sun against all bounces: leaf %.3f, leaf-lattice %.3f\n",
                  one, all);
    assert_true(one < 0.75);
    assert_true(all > 0.93 && all < 1.07);
    double sky = model_mean(&s, "leaf-lattice", PPS_SKY_INDIRECT, PPS_SUN_PRINTED) /
                 truth_mean(&s, PPS_SKY_INDIRECT, 0);
    assert_true(sky > 0.95 && sky < 1.05);
    stage_free(&s);
}

/* In the limit of faint leaves there is one bounce: nothing is added. */
static void faint_leaves_need_no_lattice(void **state) {
    (void)state;
    stage s = dense_stage(63);
    for (int face = 0; face < 2; face++) {
        s.scene->prototype[0].optics.reflectance[face][0] = 1e-3;
        s.scene->prototype[0].optics.transmittance[face][0] = 1e-3;
    }
    double one = model_mean(&s, "leaf", PPS_SUN_INDIRECT, PPS_SUN_PRINTED);
    assert_close(model_mean(&s, "leaf-lattice", PPS_SUN_INDIRECT, PPS_SUN_PRINTED), one,
                 5e-3, 0);
    stage_free(&s);
}

/* Wind: leaves turn, the attenuations stay (B section 7). */
static void leaves_may_turn_without_new_attenuations(void **state) {
    (void)state;
    enum { N = 200 };
    pps_crown crown = {PPS_CROWN_UNIFORM, 2, N, 64};
    pps_mesh *mesh;
    pps_scene *scene;
    pps_irradiance *light;
    float att[8 * N];
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    assert_int_equal(pps_scene_single(mesh, 0.7, &scene), PPS_OK);
    assert_int_equal(pps_leaf_attenuation(scene, NULL, att), PPS_OK);
    assert_int_equal(pps_irradiance_create(scene, false, &light), PPS_OK);
    assert_int_equal(pps_leaf_light(scene, att, PPS_SUN_PRINTED, PPS_SUN, light),
                     PPS_OK);
    for (size_t i = 0; i < N; i++) {
        double before = light->front[i] + light->back[i];
        double cosine = fabs(mesh->leaf[i].normal[2]);
        memcpy(mesh->leaf[i].normal, (double[]){0, 0, -1}, sizeof mesh->leaf[i].normal);
        light->front[i] = before / cosine; /* what it gets face on */
    }
    pps_irradiance *turned;
    assert_int_equal(pps_irradiance_create(scene, false, &turned), PPS_OK);
    assert_int_equal(pps_leaf_light(scene, att, PPS_SUN_PRINTED, PPS_SUN, turned),
                     PPS_OK);
    for (size_t i = 0; i < N; i++) {
        assert_close(turned->back[i], light->front[i], 1e-12, 0);
        assert_true(turned->front[i] == 0);
    }
    pps_irradiance_free(light);
    pps_irradiance_free(turned);
    pps_scene_free(scene);
}

/* Attenuations that the caller has serve as those the models make: the same light, bit by
 * bit; and they are what is used, for other ones give other light. */
static void attenuations_may_be_given(void **state) {
    (void)state;
    stage s = make_stage((pps_crown){PPS_CROWN_UNIFORM, 3, 500, 66});
    static const char *const names[] = {"leaf", "leaf-lattice"};
    float *att = malloc(PPS_OCTANTS * s.scene->n_leaves * sizeof *att);
    assert_int_equal(pps_leaf_attenuation(s.scene, NULL, att), PPS_OK);
    for (int i = 0; i < 2; i++) {
        const pps_light_model *model = pps_light_model_find(names[i]);
        pps_light_options given = {.att = att};
        pps_irradiance *light[2];
        assert_true(model->takes_attenuations);
        assert_int_equal(pps_light_model_run(model, s.scene, s.cells, NULL, &light[0]),
                         PPS_OK);
        assert_int_equal(
            pps_light_model_run(model, s.scene, s.cells, &given, &light[1]), PPS_OK);
        assert_memory_equal(light[0]->front, light[1]->front,
                            s.scene->n_leaves * sizeof *light[0]->front);
        assert_memory_equal(light[0]->back, light[1]->back,
                            s.scene->n_leaves * sizeof *light[0]->back);
        pps_irradiance_free(light[1]);
        given.sources = PPS_SUN; /* all open: |n.s| */
        float *open = malloc(PPS_OCTANTS * s.scene->n_leaves * sizeof *open);
        for (size_t k = 0; k < PPS_OCTANTS * s.scene->n_leaves; k++) {
            open[k] = 1;
        }
        given.att = open;
        assert_int_equal(
            pps_light_model_run(model, s.scene, s.cells, &given, &light[1]), PPS_OK);
        for (size_t k = 0; k < s.scene->n_leaves; k++) {
            const double *normal = s.scene->prototype[0].mesh->leaf[k].normal;
            assert_close(light[1]->front[k] + light[1]->back[k],
                         fabs(vec_dot(normal, s.scene->sun.to)), 1e-12, 1e-15);
        }
        free(open);
        pps_irradiance_free(light[0]);
        pps_irradiance_free(light[1]);
    }
    free(att);
    stage_free(&s);
}

/* To a viewer: B's Figure 7 from the side, with the room that Monte Carlo's noise takes. */
static void a_viewer_sees_the_errors_of_figure_7(void **state) {
    (void)state;
    stage s = make_stage((pps_crown){PPS_CROWN_CLUMPED, 5, 4000, 65});
    static const struct {
        unsigned sources;
        double most;
    } parts[] = {{PPS_SKY, 0.07}, {PPS_SUN, 0.09}};
    double side[3] = {-0.3, 0.5, 0};
    vec_normalize(side);
    for (int i = 0; i < 2; i++) {
        pps_trace_options how = {.seed = 2, .bounces = 1, .sources = parts[i].sources};
        pps_light_options options = {.sources = parts[i].sources};
        pps_irradiance *truth, *light;
        pps_seen_difference seen;
        assert_int_equal(pps_gather_light(s.scene, 0, NULL, 256, &how, &truth), PPS_OK);
        assert_int_equal(pps_light_model_run(pps_light_model_find("leaf"), s.scene,
                                             NULL, &options, &light),
                         PPS_OK);
        assert_int_equal(pps_seen_compare(s.scene, truth, light, side, 128, &seen),
                         PPS_OK);
        print_message("sources %u: %.1f %% of the brightest, ratio %.2f\n",
                      parts[i].sources, 100 * seen.over_top, seen.ratio);
        assert_true(seen.over_top <= parts[i].most);
        assert_true(seen.n_pixels > 1000);
        assert_int_equal(pps_seen_compare(s.scene, truth, truth, side, 128, &seen),
                         PPS_OK);
        assert_true(seen.over_top == 0 && seen.ratio == 1);
        pps_irradiance_free(truth);
        pps_irradiance_free(light);
    }
    stage_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_of_leaf_have_the_brightness_of_one_bounce),
        cmocka_unit_test(the_unbiased_sun_holds_from_every_side),
        cmocka_unit_test(the_lattice_continues_where_one_bounce_ends),
        cmocka_unit_test(faint_leaves_need_no_lattice),
        cmocka_unit_test(leaves_may_turn_without_new_attenuations),
        cmocka_unit_test(attenuations_may_be_given),
        cmocka_unit_test(a_viewer_sees_the_errors_of_figure_7),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
