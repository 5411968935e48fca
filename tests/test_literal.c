/* SPP evaluated as printed in shape: right where it can be, refused where it is no
 * number, and visibly short of digits in between.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/method.h>

#include "support/support.h"

enum { N_DEPTHS = 3, N_MU = 2 };

typedef struct {
    pps_flux flux[N_DEPTHS];
    double radiance[N_DEPTHS * N_MU];
} answer;

static pps_status evaluate(const char *method, pps_slab slab, double mu0, answer *a) {
    static const double mus[N_MU] = {-0.5, 0.5}, phi = 0;
    double w = slab.thickness, end = isinf(w) ? 9 : w;
    double tau[N_DEPTHS] = {0, 0.3 * end, end};
    pps_grid at = {N_DEPTHS, N_MU, 1, tau, mus, &phi};
    pps_model *model;
    assert_int_equal(pps_model_create(pps_method_find(method), &slab, NULL, &model),
                     PPS_OK);
    pps_status status = pps_model_solve(model, w, mu0);
    if (!status) {
        status = pps_model_flux(model, N_DEPTHS, tau, a->flux);
    }
    if (!status) {
        status = pps_model_radiance(model, &at, a->radiance);
    }
    pps_model_free(model);
    return status;
}

/* The largest difference from `spp`, relative to the largest flux. */
static double error(pps_slab slab, double mu0) {
    answer got, want;
    double worst = 0, size = 0;
    assert_int_equal(evaluate("spp-literal", slab, mu0, &got), PPS_OK);
    assert_int_equal(evaluate("spp", slab, mu0, &want), PPS_OK);
    for (int k = 0; k < N_DEPTHS; k++) {
        worst = fmax(worst, fabs(got.flux[k].up - want.flux[k].up));
        worst = fmax(worst, fabs(got.flux[k].down - want.flux[k].down));
        worst = fmax(worst, fabs(got.flux[k].mean - want.flux[k].mean));
        size = fmax(size, fmax(fabs(want.flux[k].up), fabs(want.flux[k].down)));
    }
    for (int i = 0; i < N_DEPTHS * N_MU; i++) {
        worst = fmax(worst, fabs(got.radiance[i] - want.radiance[i]));
    }
    return worst / size;
}

static void in_fair_weather_it_is_spp(void **state) {
    (void)state;
    uint64_t seed = 3;
    for (int i = 0; i < 500; i++) {
        pps_slab slab = {0.2 + 0.75 * support_random(&seed),
                         1.4 * support_random(&seed) - 0.7,
                         0.3 + 10 * support_random(&seed)};
        double mu0 = 0.2 + 0.8 * support_random(&seed);
        assert_true(error(slab, mu0) < 1e-11);
    }
}

static void what_is_no_number_is_refused(void **state) {
    (void)state;
    static const struct {
        pps_slab slab;
        double mu0;
    } cases[] = {
        {{0, 0, 1}, 0.5},            /* alpha is 0/0 */
        {{1, 0.5, 1}, 0.5},          /* c1 is 0/0 */
        {{0.5, 0, 1000}, 0.5},       /* e^(lambda w) overflows */
        {{0.9, 0, 1e9}, 1},          /* the same */
        {{0.9, 0.5, INFINITY}, 0.5}, /* a half-space */
        {{0.999, 0.999, 1e9}, 1e-4}, /* overflow */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        answer a;
        assert_int_equal(evaluate("spp-literal", cases[i].slab, cases[i].mu0, &a),
                         PPS_ERR_UNSUPPORTED);
        assert_int_equal(evaluate("spp", cases[i].slab, cases[i].mu0, &a), PPS_OK);
    }
}

/* Half the digits go as albedo -> 1, all of them as albedo -> 0. */
static void digits_are_lost_towards_the_ends(void **state) {
    (void)state;
    double here = error((pps_slab){0.5, 0, 1}, 0.5);
    assert_true(here < 1e-13);
    assert_true(error((pps_slab){1 - 1e-10, 0, 1}, 0.5) > 1e3 * here);
    assert_true(error((pps_slab){1e-6, 0, 1}, 0.5) > 1e3 * here);
}

static void there_is_no_light_but_the_beam(void **state) {
    (void)state;
    pps_slab slab = {0.5, 0, 1};
    pps_options opts = {.light = {.sky = 1}};
    pps_model *model;
    assert_int_equal(
        pps_model_create(pps_method_find("spp-literal"), &slab, &opts, &model),
        PPS_ERR_UNSUPPORTED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_fair_weather_it_is_spp),
        cmocka_unit_test(what_is_no_number_is_refused),
        cmocka_unit_test(digits_are_lost_towards_the_ends),
        cmocka_unit_test(there_is_no_light_but_the_beam),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
