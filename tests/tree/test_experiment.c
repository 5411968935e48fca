/* Scores of light models where the score is known: Monte Carlo against itself.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/experiment.h>

#include "plants.h"
#include "support/support.h"

/* A crown, its cells and a reference of so many rays. */
typedef struct {
    pps_scene *scene;
    pps_cells *cells;
    pps_irradiance *truth;
} stage;

static stage make_stage(uint64_t rays) {
    stage s = {.scene = crown_scene(PPS_CROWN_UNIFORM, 2, 400, 5)};
    pps_trace_options trace = {.rays = rays, .seed = 1};
    assert_int_equal(pps_cells_create(s.scene, NULL, &s.cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(s.cells, s.scene, NULL), PPS_OK);
    assert_int_equal(pps_trace_light(s.scene, &trace, &s.truth, NULL), PPS_OK);
    return s;
}

static void stage_free(stage *s) {
    pps_irradiance_free(s->truth);
    pps_cells_free(s->cells);
    pps_scene_free(s->scene);
}

static pps_score score_rays(const stage *s, uint64_t rays) {
    pps_contender c = {.label = "mc", .rays = rays};
    pps_score score;
    assert_int_equal(
        pps_score_models(s->scene, s->cells, s->truth, 0, 1, &c, 2, &score), PPS_OK);
    return score;
}

/* A hundred times the rays: a tenth of the error, and a hundred times the time. */
static void the_error_of_monte_carlo_falls_with_its_rays(void **state) {
    (void)state;
    stage s = make_stage(1000000);
    pps_score few = score_rays(&s, 2000), many = score_rays(&s, 200000);
    print_message("error of a leaf %.3f and %.4f\n", few.leaves, many.leaves);
    assert_in_range((int)(100 * few.leaves / many.leaves), 700, 1400);
    assert_true(many.category[0] < few.category[0]);
    assert_close(many.brightness, 1, 0.01, 0);
    assert_true(many.seconds_per_leaf > 10 * few.seconds_per_leaf);
    assert_close(many.seconds_per_leaf * (double)s.scene->n_leaves,
                 many.seconds_per_cell * (double)few.seconds_per_leaf /
                     few.seconds_per_cell * (double)s.scene->n_leaves,
                 1e-9, 0);
    stage_free(&s);
}

/* A reference of few rays is noisy; that noise is no error of what it judges. */
static void the_noise_of_the_reference_is_taken_off(void **state) {
    (void)state;
    stage fine = make_stage(1000000), rough = make_stage(20000);
    double want = score_rays(&fine, 200000).leaves,
           got = score_rays(&rough, 200000).leaves,
           noise = score_rays(&fine, 20000).leaves;
    print_message("%.4f of %.4f, noise %.3f\n", got, want, noise);
    assert_true(noise > 2.5 * want);
    assert_true(got < 0.5 * noise);
    stage_free(&fine);
    stage_free(&rough);
}

/* All contenders answer, are timed, and are told apart by their labels. */
static void every_contender_is_scored(void **state) {
    (void)state;
    size_t n;
    const pps_contender *contender = pps_contender_table(&n);
    stage s = make_stage(200000);
    pps_score *score = calloc(n, sizeof *score);
    double ss = 0, lattice = 0, radiosity = 1;
    assert_int_equal(
        pps_score_models(s.scene, s.cells, s.truth, 0, n, contender, 2, score), PPS_OK);
    for (size_t i = 0; i < n; i++) {
        assert_true(score[i].leaves > 0.01 && score[i].leaves < 1);
        assert_true(score[i].category[0] > 0 && score[i].category[0] < 1);
        assert_true(score[i].seconds_per_cell > 0 && score[i].seconds_per_cell < 1e-2);
        assert_true(score[i].seconds_per_leaf > 0 && score[i].seconds_per_leaf < 1e-2);
        for (size_t j = 0; j < i; j++) {
            assert_string_not_equal(contender[i].label, contender[j].label);
        }
        ss = strcmp(contender[i].label, "SS") == 0 ? score[i].leaves : ss;
        lattice =
            strcmp(contender[i].label, "lattice") == 0 ? score[i].leaves : lattice;
        radiosity =
            strcmp(contender[i].label, "radiosity") == 0 ? score[i].leaves : radiosity;
    }
    assert_true(lattice < 0.8 * ss);
    assert_true(radiosity < 0.9 * lattice);
    free(score);
    stage_free(&s);
}

static void a_reference_must_know_its_noise(void **state) {
    (void)state;
    stage s = make_stage(1000);
    pps_score score;
    pps_irradiance *plain;
    size_t n;
    assert_int_equal(pps_irradiance_create(s.scene, false, &plain), PPS_OK);
    assert_int_equal(pps_score_models(s.scene, s.cells, plain, 0, 1,
                                      pps_contender_paths(&n), 2, &score),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_score_models(s.scene, s.cells, s.truth, -1, 1,
                                      pps_contender_paths(&n), 2, &score),
                     PPS_ERR_ARGUMENT);
    pps_irradiance_free(plain);
    stage_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_error_of_monte_carlo_falls_with_its_rays),
        cmocka_unit_test(the_noise_of_the_reference_is_taken_off),
        cmocka_unit_test(every_contender_is_scored),
        cmocka_unit_test(a_reference_must_know_its_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
