/* The two-stream schemes: the published values, and what holds everywhere.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/method.h>

#include "support/support.h"

static const double PI = 3.14159265358979323846;

/* The order of the table of values: 300 rows each. */
static const char *const schemes[] = {"twostream-eddington",
                                      "twostream-eddington-delta",
                                      "twostream-quadrature",
                                      "twostream-quadrature-delta",
                                      "twostream-hemispheric-mean",
                                      "twostream-hemispheric-mean-delta",
                                      "twostream-pifm",
                                      "twostream-pifm-delta"};
enum { N_SCHEMES = sizeof schemes / sizeof schemes[0], ROWS_EACH = 300 };

static pps_model *solve(const char *method, pps_slab slab, double mu0,
                        const pps_options *opts) {
    pps_model *model;
    assert_int_equal(pps_model_create(pps_method_find(method), &slab, opts, &model),
                     PPS_OK);
    assert_int_equal(pps_model_solve(model, slab.thickness, mu0), PPS_OK);
    return model;
}

/* Columns: scheme, delta, omega, g, w, mu0, R, Tdif, Tdir, Ttot. Tdir is of the scaled
 * beam. Nonphysical rows are among them. */
static void fluxes_match_the_published_schemes(void **state) {
    (void)state;
    support_table t = support_read("twostream_values.csv");
    assert_int_equal(t.n_rows, N_SCHEMES * ROWS_EACH);
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        double w = row[4], mu0 = row[5], tau[2] = {0, w};
        pps_flux flux[2];
        pps_slab slab = {row[2], row[3], w};
        pps_model *model = solve(schemes[i / ROWS_EACH], slab, mu0, NULL);
        assert_int_equal(pps_model_flux(model, 2, tau, flux), PPS_OK);
        assert_true(row[1] == (double)(i / ROWS_EACH % 2));
        double total = (flux[1].down + flux[1].direct) / mu0;
        assert_close(flux[0].up / mu0, row[6], 1e-12, 1e-15);
        assert_close(total - row[8], row[7], 1e-12, 1e-15);
        assert_close(total, row[9], 1e-12, 1e-15);
        pps_model_free(model);
    }
    support_table_free(&t);
}

static const double gs[] = {-0.9, -0.5, 0, 0.5, 0.99};
static const double thicknesses[] = {1e-9, 1e-3, 1, 50, 1e9};
static const double beams[] = {1e-4, 0.5, 1};

static void conservative_slabs_return_all_energy(void **state) {
    (void)state;
    pps_options sky = {.light = {.sky = 1}};
    for (int i = 0; i < N_SCHEMES * 75; i++) {
        double w = thicknesses[i / 8 % 5], mu0 = beams[i / 8 / 25], tau[2] = {0, w};
        pps_slab slab = {1, gs[i / 8 / 5 % 5], w};
        pps_flux flux[2];
        pps_model *model = solve(schemes[i % 8], slab, mu0, NULL);
        assert_int_equal(pps_model_flux(model, 2, tau, flux), PPS_OK);
        /* Where the closure makes fluxes many times larger than the beam, so is the
         * rounding. */
        double size = fabs(flux[0].up) + fabs(flux[1].down);
        assert_close(flux[0].up + flux[1].down, -mu0 * expm1(-w / mu0), 1e-12,
                     1e-15 * size);
        pps_model_free(model);
        model = solve(schemes[i % 8], slab, mu0, &sky);
        assert_int_equal(pps_model_flux(model, 2, tau, flux), PPS_OK);
        assert_close(flux[0].up + flux[1].down, PI, 1e-12, 0);
        pps_model_free(model);
    }
}

static void conservative_half_spaces_return_all_energy(void **state) {
    (void)state;
    for (int i = 0; i < N_SCHEMES * 15; i++) {
        double tau = 0, mu0 = beams[i / 8 % 3];
        pps_flux flux;
        pps_slab slab = {1, gs[i / 24], INFINITY};
        pps_model *model = solve(schemes[i % 8], slab, mu0, NULL);
        assert_int_equal(pps_model_flux(model, 1, &tau, &flux), PPS_OK);
        assert_close(flux.up, mu0, 1e-12, 0);
        pps_model_free(model);
    }
}

/* k = 1/mu0 at g = 0: k^2 = e f is 3 (1 - albedo) for Eddington and quadrature and
 * 4 (1 - albedo) for hemispheric means; PIFM 2 (1 - albedo) (2 - albedo/2). */
static void fluxes_are_smooth_on_resonance(void **state) {
    (void)state;
    static const double k2[] = {1.5, 1.5, 2, 1.75}, ws[] = {0.3, 3, 30, INFINITY};
    const double step = 1e-6;
    for (int i = 0; i < N_SCHEMES * 4; i++) {
        double tau[2] = {0, 0.2}, mu0 = 1 / sqrt(k2[i % 8 / 2]);
        pps_flux flux[3][2];
        for (int side = 0; side < 3; side++) {
            pps_slab slab = {0.5, 0, ws[i / 8]};
            pps_model *model =
                solve(schemes[i % 8], slab, mu0 * (1 + (side - 1) * step), NULL);
            assert_int_equal(pps_model_flux(model, 2, tau, flux[side]), PPS_OK);
            pps_model_free(model);
        }
        for (int k = 0; k < 2; k++) {
            double mean = (flux[0][k].mean + flux[2][k].mean) / 2;
            double up = (flux[0][k].up + flux[2][k].up) / 2;
            assert_close(flux[1][k].mean, mean, 1e-11, 0);
            assert_close(flux[1][k].up, up, 1e-11, 0);
        }
    }
}

static void fluxes_are_finite_everywhere(void **state) {
    (void)state;
    static const double albedos[] = {0, 1e-12, 0.5, 1 - 1e-15, 1};
    static const double ws[] = {1e-9, 1, 1e4, 1e9, INFINITY};
    static const double all_g[] = {-0.999, -0.5, 0, 0.5, 0.999};
    for (int i = 0; i < N_SCHEMES * 125 * 3; i++) {
        pps_slab slab = {albedos[i / 8 % 5], all_g[i / 40 % 5], ws[i / 200 % 5]};
        double mu0 = beams[i / 1000];
        double tau[3] = {0, fmin(slab.thickness, 60) / 2, fmin(slab.thickness, 60)};
        pps_flux flux[3];
        pps_model *model = solve(schemes[i % 8], slab, mu0, NULL);
        assert_int_equal(pps_model_flux(model, 3, tau, flux), PPS_OK);
        for (int k = 0; k < 3; k++) {
            assert_true(isfinite(flux[k].up) && isfinite(flux[k].down));
            assert_true(isfinite(flux[k].mean));
            double beam = exp(-tau[k] / mu0);
            assert_close(flux[k].direct, mu0 * beam, 1e-12, 1e-300);
        }
        pps_model_free(model);
    }
}

static void radiances_are_refused(void **state) {
    (void)state;
    double tau = 0, mu = -1, phi = 0, radiance;
    pps_grid at = {1, 1, 1, &tau, &mu, &phi};
    for (int i = 0; i < N_SCHEMES; i++) {
        pps_model *model = solve(schemes[i], (pps_slab){0.9, 0.5, 1}, 0.5, NULL);
        assert_int_equal(pps_model_radiance(model, &at, &radiance),
                         PPS_ERR_UNSUPPORTED);
        pps_model_free(model);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fluxes_match_the_published_schemes),
        cmocka_unit_test(conservative_slabs_return_all_energy),
        cmocka_unit_test(conservative_half_spaces_return_all_energy),
        cmocka_unit_test(fluxes_are_smooth_on_resonance),
        cmocka_unit_test(fluxes_are_finite_everywhere),
        cmocka_unit_test(radiances_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
