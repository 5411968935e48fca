/* Closed forms in batches against the methods they stand for.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>

#include <ppscat/ppscat.h>

enum { N = 43 };
static const double PI = 3.14159265358979323846;

static void check(const pps_slab *slab, double mu0, unsigned *kinds) {
    double tau[N], fluence[N], in_place[N], end = fmin(slab->thickness, 60);
    pps_flux flux[N];
    pps_hemispheric h;
    pps_model *model;
    for (int i = 0; i < N; i++) {
        tau[i] = in_place[i] = end * pow((double)i / (N - 1), 3);
    }
    assert_int_equal(pps_hemispheric_init(&h, slab, mu0), PPS_OK);
    pps_hemispheric_fluence(&h, N, tau, fluence);
    assert_int_equal(
        pps_model_create(pps_method_find("hemispheric"), slab, NULL, &model), PPS_OK);
    assert_int_equal(pps_model_solve(model, slab->thickness, mu0), PPS_OK);
    assert_int_equal(pps_model_flux(model, N, tau, flux), PPS_OK);
    pps_model_free(model);
    for (int i = 0; i < N; i++) {
        /* rounding of the exponents and of psi + beam, which may differ in sign */
        double size = fmax(4 * PI * flux[i].mean, exp(-tau[i] / mu0));
        assert_close(fluence[i], 4 * PI * flux[i].mean, 3e-14, 2e-14 * size + 1e-307);
    }
    pps_hemispheric_fluence(&h, N, in_place, in_place);
    assert_memory_equal(in_place, fluence, sizeof fluence);
    for (size_t n = 0; n < 9; n++) { /* a number does not depend on its place */
        double some[9];
        pps_hemispheric_fluence(&h, n, tau + 11, some);
        assert_memory_equal(some, fluence + 11, n * sizeof *some);
    }
    *kinds |= 1U << h.kind;
}

static void fluence_is_that_of_the_method(void **state) {
    (void)state;
    static const double albedo[] = {0, 0.3, 0.9, 0.999, 1}, g[] = {-0.5, 0, 0.7};
    static const double w[] = {1e-3, 0.2, 1, 3, 30, 1e3, INFINITY};
    static const double mu0[] = {0.002, 0.1, 0.4, 0.55, 0.9, 1};
    unsigned kinds = 0;
    for (size_t i = 0; i < 5 * 3 * 7 * 6; i++) {
        pps_slab slab = {albedo[i / 126], g[i / 42 % 3], w[i / 6 % 7]};
        check(&slab, mu0[i % 6], &kinds);
    }
    assert_int_equal(kinds, 15); /* every form was met */
}

static void bad_cases_are_refused(void **state) {
    (void)state;
    pps_hemispheric h;
    pps_slab slab = {0.5, 0, 1}, bad = {1.5, 0, 1};
    assert_int_equal(pps_hemispheric_init(&h, &bad, 0.5), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_hemispheric_init(&h, &slab, 0), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_hemispheric_init(&h, NULL, 0.5), PPS_ERR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fluence_is_that_of_the_method),
        cmocka_unit_test(bad_cases_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
