/* The Runge-Kutta references: rk against discrete ordinates on the same nodes, shooting
 * right where it answers and refusing where it cannot.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>

#include <ppscat/ppscat.h>

#include "reference/plane.h"

enum { N_DEPTHS = 4, N_MU = 10, N_PHI = 3, N_RADIANCES = N_DEPTHS * N_MU * N_PHI };

static const double mus[N_MU] = {1, 0.7, 0.3, 0.05, 1e-4, -1e-4, -0.05, -0.3, -0.7, -1};
static const double phis[N_PHI] = {0, 60, 180};

typedef struct {
    double radiance[N_RADIANCES];
    pps_flux flux[N_DEPTHS];
} answer;

typedef struct {
    pps_slab slab;
    double mu0, tau[N_DEPTHS];
} place;

static place place_of(double albedo, double g, double w, double mu0) {
    return (place){{albedo, g, w}, mu0, {0.5 * w, 0, w, 0.1 * w}};
}

static pps_status produce(const char *method, const place *at, const pps_options *opts,
                          const double *mu, size_t n_mu, answer *out) {
    pps_model *model;
    pps_grid grid = {N_DEPTHS, n_mu, N_PHI, at->tau, mu, phis};
    pps_status status =
        pps_model_create(pps_method_find(method), &at->slab, opts, &model);
    if (status) {
        return status;
    }
    status = pps_model_solve(model, at->slab.thickness, at->mu0);
    status = status ? status : pps_model_radiance(model, &grid, out->radiance);
    status = status ? status : pps_model_flux(model, N_DEPTHS, at->tau, out->flux);
    pps_model_free(model);
    return status;
}

/* The largest error of `got` as options.tolerance measures it. */
static double worst_error(const answer *got, const answer *want, size_t n_mu) {
    size_t n = N_DEPTHS * n_mu * N_PHI;
    double largest = 0, worst = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(want->radiance[i]));
    }
    for (size_t i = 0; i < n; i++) {
        double scale = fmax(fabs(want->radiance[i]), 1e-3 * largest);
        worst = fmax(worst, fabs(got->radiance[i] - want->radiance[i]) / scale);
    }
    for (int k = 0; k < N_DEPTHS; k++) {
        const pps_flux *x = &got->flux[k], *y = &want->flux[k];
        worst = fmax(worst, support_relative_error(x->up, y->up));
        worst = fmax(worst, support_relative_error(x->down, y->down));
        worst = fmax(worst, support_relative_error(x->mean, y->mean));
    }
    return worst;
}

/* `exact` on the same Gauss nodes with the same moments, to rounding. */
static answer discrete(const place *at, int streams, const double *mu, size_t n_mu) {
    answer out;
    pps_options opts = {.streams = streams, .delta_m = PPS_DELTA_M_OFF};
    assert_int_equal(produce("exact", at, &opts, mu, n_mu, &out), PPS_OK);
    return out;
}

static void rk_meets_its_tolerance_on_its_nodes(void **state) {
    (void)state;
    static const double albedos[] = {0.3, 0.9, 1}, g[] = {-0.5, 0, 0.7};
    static const double w[] = {1e-6, 0.01, 1, 10}, mu0[] = {0.1, 1};
    static const double tolerances[] = {1e-4, 1e-7, 1e-10};
    double worst[3] = {0};
    for (int i = 0; i < 3 * 3 * 4 * 2; i++) {
        place at = place_of(albedos[i % 3], g[i / 3 % 3], w[i / 9 % 4], mu0[i / 36]);
        answer want = discrete(&at, 8, mus, N_MU), got;
        for (int t = 0; t < 3; t++) {
            pps_options opts = {
                .streams = 8, .delta_m = PPS_DELTA_M_OFF, .tolerance = tolerances[t]};
            assert_int_equal(produce("rk", &at, &opts, mus, N_MU, &got), PPS_OK);
            double error = worst_error(&got, &want, N_MU) / tolerances[t];
            worst[t] = fmax(worst[t], error);
        }
    }
    print_message("errors in tolerances: %.2g %.2g %.2g\n", worst[0], worst[1],
                  worst[2]);
    for (int t = 0; t < 3; t++) {
        assert_true(worst[t] <= 1);
    }
}

static void sixteen_streams_and_single_scattering_are_the_default(void **state) {
    (void)state;
    place at = place_of(0.8, 0, 1, 0.6);
    /* Isotropic: nothing to correct. */
    answer want = discrete(&at, 16, mus, N_MU), got;
    assert_int_equal(produce("rk", &at, &(pps_options){0}, mus, N_MU, &got), PPS_OK);
    assert_true(worst_error(&got, &want, N_MU) < 1e-6);
    /* Weak scattering: all there is to correct. */
    place weak = place_of(1e-9, 0.9, 1, 0.6);
    answer single;
    assert_int_equal(produce("single", &weak, NULL, mus, N_MU, &single), PPS_OK);
    assert_int_equal(produce("rk", &weak, &(pps_options){0}, mus, N_MU, &got), PPS_OK);
    for (int i = 0; i < N_RADIANCES; i++) {
        assert_close(got.radiance[i], single.radiance[i], 1e-6,
                     1e-9 * single.radiance[0]);
    }
}

static const double steep[] = {1, 0.5, 0.3, -0.3, -0.5, -1};
enum { N_STEEP = 6 };

static void shooting_is_right_in_thin_slabs(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        place at = place_of(i % 2 ? 1 : 0.5, i / 2 ? 0.5 : 0, 0.02, 0.6);
        pps_options opts = {.streams = 8, .delta_m = PPS_DELTA_M_OFF};
        answer got, want = discrete(&at, 8, steep, N_STEEP);
        assert_int_equal(produce("rk-shooting", &at, &opts, steep, N_STEEP, &got),
                         PPS_OK);
        assert_true(worst_error(&got, &want, N_STEEP) < 1e-6);
    }
}

static void shooting_refuses_thick_slabs(void **state) {
    (void)state;
    static const double w[] = {10, 100, 1e9};
    for (int i = 0; i < 9; i++) {
        place at = place_of(i / 3 * 0.5, 0, w[i % 3], 0.6);
        pps_options opts = {.streams = 8, .delta_m = PPS_DELTA_M_OFF};
        answer got;
        pps_status status = produce("rk-shooting", &at, &opts, steep, N_STEEP, &got);
        assert_int_equal(status, i < 3 ? PPS_OK : PPS_ERR_UNSUPPORTED);
    }
}

/* Over thickness, albedo, streams and tolerance: right to the tolerance, or refused. */
static void shooting_is_never_silently_wrong(void **state) {
    (void)state;
    int answered = 0, refused = 0;
    double worst = 0;
    for (int step = 0; step <= 40; step++) {
        for (int i = 0; i < 4 * 3 * 2; i++) {
            static const double albedos[] = {0.01, 0.5, 0.99, 1}, g[] = {0, 0.5, 0.8};
            double tolerance = i / 12 ? 1e-9 : 1e-3;
            int streams = 4 + 4 * (i % 2);
            place at = place_of(albedos[i % 4], g[i / 4 % 3],
                                0.01 * pow(1e4, step / 40.0), 0.5);
            pps_options opts = {
                .streams = streams, .delta_m = PPS_DELTA_M_OFF, .tolerance = tolerance};
            answer got;
            pps_status status =
                produce("rk-shooting", &at, &opts, steep, N_STEEP, &got);
            if (status == PPS_OK) {
                answer want = discrete(&at, streams, steep, N_STEEP);
                worst = fmax(worst, worst_error(&got, &want, N_STEEP) / tolerance);
                answered++;
            } else {
                assert_true(status == PPS_ERR_UNSUPPORTED ||
                            status == PPS_ERR_INDEFINITE);
                refused++;
            }
        }
    }
    print_message("%d answered, %d refused, worst error %.2g tolerances\n", answered,
                  refused, worst);
    assert_true(answered > 100 && refused > 100);
    assert_true(worst <= 1);
}

static void both_refuse_what_they_cannot(void **state) {
    (void)state;
    static const char *const methods[] = {"rk", "rk-shooting"};
    for (int i = 0; i < 2; i++) {
        pps_slab slab = {0.9, 0.5, 1}, peaked = {1, 0.999, 1};
        const pps_method *method = pps_method_find(methods[i]);
        pps_options scaled = {.delta_m = PPS_DELTA_M_ON}, sky = {.light = {.sky = 1}};
        pps_model *model;
        assert_int_equal(pps_model_create(method, &slab, &scaled, &model),
                         PPS_ERR_UNSUPPORTED);
        assert_int_equal(pps_model_create(method, &slab, &sky, &model),
                         PPS_ERR_UNSUPPORTED);
        assert_int_equal(pps_model_create(method, &peaked, NULL, &model),
                         PPS_ERR_INDEFINITE);
        assert_int_equal(pps_model_create(method, &slab, NULL, &model), PPS_OK);
        assert_int_equal(pps_model_solve(model, INFINITY, 1), PPS_ERR_UNSUPPORTED);
        assert_int_equal(pps_model_solve(model, 1e9, 1), PPS_OK);
        double tau = 1;
        pps_flux flux;
        assert_int_equal(pps_model_flux(model, 1, &tau, &flux), PPS_ERR_UNSUPPORTED);
        pps_model_free(model);
    }
}

static void elimination_solves_and_finds_the_singular(void **state) {
    (void)state;
    double a[9] = {0, 2, 1, 1, 0, 3, 4, 1, 0}, x[3] = {7, 10, 6};
    assert_true(pps_plane_eliminate(3, a, 1, x));
    assert_close(x[0], 1, 1e-14, 0);
    assert_close(x[1], 2, 1e-14, 0);
    assert_close(x[2], 3, 1e-14, 0);
    double flat[4] = {1, 2, 2, 4}, y[2] = {1, 1};
    assert_false(pps_plane_eliminate(2, flat, 1, y));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rk_meets_its_tolerance_on_its_nodes),
        cmocka_unit_test(sixteen_streams_and_single_scattering_are_the_default),
        cmocka_unit_test(shooting_is_right_in_thin_slabs),
        cmocka_unit_test(shooting_refuses_thick_slabs),
        cmocka_unit_test(shooting_is_never_silently_wrong),
        cmocka_unit_test(both_refuse_what_they_cannot),
        cmocka_unit_test(elimination_solves_and_finds_the_singular),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
