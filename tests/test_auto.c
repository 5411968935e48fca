/* The method "exact" with streams chosen by itself: it meets the tolerance that it was
 * asked for, against the reference tables and against solutions with many more streams on
 * the other kind of nodes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <ppscat/method.h>

#include "support/support.h"

static pps_model *create(double albedo, double g, double tolerance) {
    pps_slab slab = {albedo, g, 1};
    pps_options opts = {.tolerance = tolerance};
    pps_model *model;
    const pps_method *exact = pps_method_find("exact");
    assert_int_equal(pps_model_create(exact, &slab, &opts, &model), PPS_OK);
    return model;
}

/* The tolerance's own measure: relative to max(value, 1e-3 of the largest). */
static double worst_error(size_t n, const double *got, const double *want,
                          double floor) {
    double largest = 0, worst = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(want[i]));
    }
    for (size_t i = 0; i < n; i++) {
        double scale = fmax(fabs(want[i]), floor * largest);
        if (scale > 0) {
            worst = fmax(worst, fabs(got[i] - want[i]) / scale);
        }
    }
    return worst;
}

enum { N_MU = 10, N_PHI = 5, N_TAU = 3, N_BLOCK = N_TAU * N_MU * N_PHI };
static const double mus[N_MU] = {-1, -0.8, -0.5, -0.2, -0.1, 0.1, 0.2, 0.5, 0.8, 1};
static const double phis[N_PHI] = {0, 60, 90, 120, 180};

/* The reference radiances of one (g, albedo, w, mu0), laid out as a block; NAN where the
 * table has none (it has one azimuth where that does not matter). */
static void reference_block(const support_table *t, const double *key, double *block) {
    for (int i = 0; i < N_BLOCK; i++) {
        block[i] = (double)NAN;
    }
    for (size_t r = 0; r < t->n_rows; r++) {
        const double *row = t->value + r * t->n_columns;
        if (row[0] != key[0] || row[1] != key[1] || row[2] != key[2] ||
            row[3] != key[3]) {
            continue;
        }
        for (int j = 0; j < N_MU; j++) {
            for (int i = 0; i < N_PHI; i++) {
                if (fabs(mus[j]) == row[4] && phis[i] == row[5]) {
                    bool down = mus[j] > 0;
                    block[(0 * N_MU + j) * N_PHI + i] = down ? 0 : row[6];
                    block[(1 * N_MU + j) * N_PHI + i] = down ? row[9] : row[8];
                    block[(2 * N_MU + j) * N_PHI + i] = down ? row[7] : 0;
                }
            }
        }
    }
}

static void check_reference_block(const support_table *t, const double *key,
                                  double tolerance) {
    double want[N_BLOCK], got[N_BLOCK], tau[N_TAU] = {0, key[2] / 2, key[2]};
    reference_block(t, key, want);
    pps_model *model = create(key[1], key[0], tolerance);
    assert_int_equal(pps_model_solve(model, key[2], key[3]), PPS_OK);
    pps_grid at = {N_TAU, N_MU, N_PHI, tau, mus, phis};
    assert_int_equal(pps_model_radiance(model, &at, got), PPS_OK);
    for (int i = 0; i < N_BLOCK; i++) {
        want[i] = isnan(want[i]) ? got[i] : want[i];
    }
    pps_info info;
    pps_model_query(model, &info);
    double error = worst_error(N_BLOCK, got, want, 1e-3);
    if (!(error <= tolerance) || !(info.error_estimate <= tolerance)) {
        fail_msg("g %g albedo %g w %g mu0 %g to %g: error %.2g, estimate %.2g with %d "
                 "streams",
                 key[0], key[1], key[2], key[3], tolerance, error, info.error_estimate,
                 info.streams);
    }
    pps_model_free(model);
}

static void tolerance_is_met_on_the_reference_radiances(void **state) {
    (void)state;
    support_table t = support_read("slab_hg_radiance.csv");
    const double *last = NULL;
    int blocks = 0;
    for (size_t r = 0; r < t.n_rows; r++) {
        const double *row = t.value + r * t.n_columns;
        if (last && row[0] == last[0] && row[1] == last[1] && row[2] == last[2] &&
            row[3] == last[3]) {
            continue;
        }
        check_reference_block(&t, row, 1e-4);
        check_reference_block(&t, row, 1e-6);
        last = row;
        blocks++;
    }
    assert_true(blocks >= 40);
    support_table_free(&t);
}

/* Radiances with many streams on a given kind of nodes. */
static void many_streams(const pps_slab *slab, double mu0, int streams, pps_nodes nodes,
                         const pps_grid *at, double *radiance) {
    pps_dom_opts opts = {.streams = streams, .nodes = nodes, .tolerance = 1e-10};
    pps_dom *dom;
    assert_int_equal(pps_dom_create(slab, &opts, &dom), PPS_OK);
    assert_int_equal(pps_dom_solve(dom, mu0), PPS_OK);
    assert_int_equal(pps_dom_radiance(dom, at, radiance), PPS_OK);
    pps_dom_free(dom);
}

static void check_against_many_streams(double g, double albedo, double w, double mu0) {
    double want[N_BLOCK], got[N_BLOCK], depth = isinf(w) ? 10 : w;
    double tau[N_TAU] = {0, depth / 2, depth};
    pps_grid at = {N_TAU, N_MU, N_PHI, tau, mus, phis};
    pps_slab slab = {albedo, g, w};
    many_streams(&slab, mu0, 256, PPS_NODES_MAPPED, &at, want);
    for (double tolerance = 1e-2; tolerance > 5e-7; tolerance /= 10) {
        pps_model *model = create(albedo, g, tolerance);
        assert_int_equal(pps_model_solve(model, w, mu0), PPS_OK);
        assert_int_equal(pps_model_radiance(model, &at, got), PPS_OK);
        double error = worst_error(N_BLOCK, got, want, 1e-3);
        if (error > tolerance) {
            print_error("g %g albedo %g w %g mu0 %g: %.2e for %.0e\n", g, albedo, w,
                        mu0, error, tolerance);
        }
        assert_true(error <= tolerance);
        pps_model_free(model);
    }
}

static void tolerance_is_met_for_peaked_phase_functions(void **state) {
    (void)state;
    static const double gs[] = {0.75, 0.9, -0.75};
    static const double ws[] = {0.01, 1, 10, (double)INFINITY};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            check_against_many_streams(gs[i], j % 2 ? 0.95 : 1, ws[j], 0.5);
        }
    }
    check_against_many_streams(0.9, 0.5, 1, 0.1);
    check_against_many_streams(0.75, 0.99, 10, 1);
}

static void flux_tolerance_is_met_in_thin_and_thick_slabs(void **state) {
    (void)state;
    static const double gs[] = {0, 0.5, 0.85, -0.5};
    static const double ws[] = {1e-9, 1e-6, 1e-4, 0.01, 0.1, 1, 30, 1e4, 1e9};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 9; j++) {
            double w = ws[j], tau[3] = {0, w / 2, w};
            pps_flux got[3], want[3];
            pps_slab slab = {0.95, gs[i], w};
            pps_dom_opts opts = {
                .streams = 400, .nodes = PPS_NODES_MAPPED, .orders = 1};
            pps_dom *dom;
            assert_int_equal(pps_dom_create(&slab, &opts, &dom), PPS_OK);
            assert_int_equal(pps_dom_solve(dom, 0.4), PPS_OK);
            assert_int_equal(pps_dom_flux(dom, 3, tau, want), PPS_OK);
            pps_model *model = create(0.95, gs[i], 1e-6);
            assert_int_equal(pps_model_solve(model, w, 0.4), PPS_OK);
            assert_int_equal(pps_model_flux(model, 3, tau, got), PPS_OK);
            for (int k = 0; k < 3; k++) {
                assert_close(got[k].up, want[k].up, 1e-6, 1e-290);
                assert_close(got[k].down, want[k].down, 1e-6, 1e-290);
                assert_close(got[k].mean_diffuse, want[k].mean_diffuse, 1e-6, 1e-290);
            }
            pps_model_free(model);
            pps_dom_free(dom);
        }
    }
}

/* A tolerance that no ladder reaches is said, and nothing passed off. */
static void unreachable_tolerance_is_refused(void **state) {
    (void)state;
    pps_model *model = create(0.95, 0.9, 1e-18);
    double tau[3] = {0, 1, 10};
    pps_flux flux[3];
    assert_int_equal(pps_model_solve(model, 10, 0.5), PPS_OK);
    assert_int_equal(pps_model_flux(model, 3, tau, flux), PPS_ERR_TOLERANCE);
    pps_model_free(model);
}

static void a_case_has_one_answer_whatever_came_before(void **state) {
    (void)state;
    double tau = 1, mu = -0.3, phi = 20, fresh, later;
    pps_grid at = {1, 1, 1, &tau, &mu, &phi};
    pps_model *model = create(0.95, 0.7, 1e-5);
    assert_int_equal(pps_model_solve(model, 3, 0.6), PPS_OK);
    assert_int_equal(pps_model_radiance(model, &at, &fresh), PPS_OK);
    pps_flux flux;
    assert_int_equal(pps_model_solve(model, 0.02 + tau, 0.01), PPS_OK);
    assert_int_equal(pps_model_flux(model, 1, &tau, &flux), PPS_OK);
    assert_int_equal(pps_model_radiance(model, &at, &later), PPS_OK);
    assert_int_equal(pps_model_solve(model, 3, 0.6), PPS_OK);
    assert_int_equal(pps_model_radiance(model, &at, &later), PPS_OK);
    assert_true(fresh == later);
    pps_model_free(model);
}

/* Nothing scatters: the beam is all there is, and no stream is spent on it. */
static void albedo_0_takes_no_streams(void **state) {
    (void)state;
    static const double gs[] = {-0.9, 0, 0.95};
    static const double ws[] = {1e-6, 0.05, 10, (double)INFINITY};
    for (int i = 0; i < 12; i++) {
        double w = ws[i % 4], last = fmin(w, 20), tau[N_TAU] = {0, last / 2, last};
        double radiance[N_BLOCK], mu0 = 0.3;
        pps_grid at = {N_TAU, N_MU, N_PHI, tau, mus, phis};
        pps_flux flux[N_TAU];
        pps_info info;
        pps_model *model = create(0, gs[i / 4], 1e-10);
        assert_int_equal(pps_model_solve(model, w, mu0), PPS_OK);
        assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
        pps_model_query(model, &info);
        assert_int_equal(info.streams + info.orders, 0);
        assert_true(info.error_estimate == 0);
        assert_int_equal(pps_model_flux(model, N_TAU, tau, flux), PPS_OK);
        pps_model_query(model, &info);
        assert_int_equal(info.streams + info.orders, 0);
        for (int k = 0; k < N_BLOCK; k++) {
            assert_true(radiance[k] == 0);
        }
        for (int k = 0; k < N_TAU; k++) {
            assert_true(flux[k].up == 0 && flux[k].down == 0);
            assert_true(flux[k].mean_diffuse == 0);
            assert_close(flux[k].direct, mu0 * exp(-tau[k] / mu0), 1e-15, 0);
            assert_close(flux[k].mean, flux[k].direct / mu0 / (16 * atan(1)), 1e-15, 0);
        }
        pps_model_free(model);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tolerance_is_met_on_the_reference_radiances),
        cmocka_unit_test(tolerance_is_met_for_peaked_phase_functions),
        cmocka_unit_test(flux_tolerance_is_met_in_thin_and_thick_slabs),
        cmocka_unit_test(unreachable_tolerance_is_refused),
        cmocka_unit_test(albedo_0_takes_no_streams),
        cmocka_unit_test(a_case_has_one_answer_whatever_came_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
