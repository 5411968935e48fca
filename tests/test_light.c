/* Sky and ground: identities, the spherical albedo tables, and the sky as a sum of beams.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/method.h>

#include "core/quadrature.h"
#include "support/support.h"

static const double PI = 3.14159265358979323846;

static pps_model *solve(const char *method, pps_slab slab, double mu0,
                        pps_options opts) {
    pps_model *model;
    assert_int_equal(pps_model_create(pps_method_find(method), &slab, &opts, &model),
                     PPS_OK);
    assert_int_equal(pps_model_solve(model, slab.thickness, mu0), PPS_OK);
    return model;
}

static const char *const with_sky[] = {"exact", "spp", "spp-refined", "hemispheric",
                                       "eddington"};
enum { N_WITH_SKY = sizeof with_sky / sizeof with_sky[0] };

/* A conservative slab between a sky of radiance 1 and a white ground has radiance 1
 * everywhere, in every method that conserves energy. */
static void white_furnace_is_white(void **state) {
    (void)state;
    static const double mus[] = {-1, -0.3, -0.01, 0.01, 0.5, 1}, phi = 50;
    static const double ws[] = {1e-4, 0.5, 20, 1e4}, gs[] = {0, 0.5, -0.5, 0.9};
    for (int i = 0; i < N_WITH_SKY * 16; i++) {
        double w = ws[i / N_WITH_SKY % 4], g = gs[i / N_WITH_SKY / 4];
        double tau[3] = {0, 0.3 * w, w}, radiance[18];
        pps_options opts = {.streams = 16, .light = {.sky = 1, .ground = 1}};
        pps_model *model =
            solve(with_sky[i % N_WITH_SKY], (pps_slab){1, g, w}, 1, opts);
        pps_grid at = {3, 6, 1, tau, mus, &phi};
        pps_flux flux[3];
        assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
        assert_int_equal(pps_model_flux(model, 3, tau, flux), PPS_OK);
        for (int k = 0; k < 18; k++) {
            assert_close(radiance[k], 1, 1e-10, 0);
        }
        for (int k = 0; k < 3; k++) {
            assert_close(flux[k].down, PI, 1e-10, 0);
            assert_close(flux[k].up, PI, 1e-10, 0);
            assert_close(flux[k].mean, 1, 1e-10, 0);
        }
        pps_model_free(model);
    }
}

/* Columns 9 and 10 of the table: R and diffuse T of isotropic illumination, over pi. What
 * comes through uncollided is 2 E3(w) = 2 int mu e^(-w/mu) dmu of it. */
static void spherical_albedos_match_the_table(void **state) {
    (void)state;
    double x[200], weight[200];
    pps_hemisphere_nodes(PPS_NODES_GRADED, 200, x, weight);
    support_table t = support_read("slab_hg_flux.csv");
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        double w = row[2], tau[2] = {0, w}, through = 0;
        for (int k = 0; k < 200; k++) {
            through += 2 * weight[k] * x[k] * exp(-w / x[k]);
        }
        pps_options opts = {.streams = 128, .light = {.sky = 1}};
        pps_model *model = solve("exact", (pps_slab){row[1], row[0], w}, 1, opts);
        pps_flux flux[2];
        assert_int_equal(pps_model_flux(model, 2, tau, flux), PPS_OK);
        assert_close(flux[0].up / PI, row[9], 1e-11, 0);
        assert_close(flux[1].down / PI, row[10] + through, 1e-11, 0);
        pps_model_free(model);
    }
    support_table_free(&t);
}

/* An isotropic sky is 2 pi int dmu0 of beams; the azimuthal mean of each beam's field is
 * all that counts, taken here by the trapezoidal rule. */
static void sky_is_a_sum_of_beams(void **state) {
    (void)state;
    enum { BEAMS = 40, PHIS = 32 };
    double mu0[BEAMS], weight[BEAMS], phis[PHIS], tau[2] = {0, 0.7},
                                                  mu[2] = {-0.4, 0.6};
    double sum[4] = {0}, radiance[4 * PHIS], sky[4], phi = 0;
    pps_slab slab = {0.9, 0.4, 1.5};
    pps_hemisphere_nodes(PPS_NODES_MAPPED, BEAMS, mu0, weight);
    for (int i = 0; i < PHIS; i++) {
        phis[i] = i * 360.0 / PHIS;
    }
    for (int b = 0; b < BEAMS; b++) {
        pps_model *model = solve("exact", slab, mu0[b], (pps_options){.streams = 48});
        pps_grid at = {2, 2, PHIS, tau, mu, phis};
        assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
        for (int i = 0; i < 4 * PHIS; i++) {
            sum[i / PHIS] += 2 * PI * weight[b] * radiance[i] / PHIS;
        }
        pps_model_free(model);
    }
    pps_model *model =
        solve("exact", slab, 1, (pps_options){.streams = 48, .light = {.sky = 1}});
    pps_grid at = {2, 2, 1, tau, mu, &phi};
    assert_int_equal(pps_model_radiance(model, &at, sky), PPS_OK);
    for (int i = 0; i < 4; i++) {
        double uncollided = i % 2 ? exp(-tau[i / 2] / mu[1]) : 0;
        assert_close(sum[i] + uncollided, sky[i], 1e-8, 0);
    }
    pps_model_free(model);
}

/* A white ground under a conservative slab sends everything back; a ground adds what it
 * should by energy: what is absorbed is (1 - A) of what reaches it. */
static void ground_takes_what_it_does_not_reflect(void **state) {
    (void)state;
    for (int i = 0; i < N_WITH_SKY - 1; i++) { /* refined SPP does not conserve */
        const char *name = with_sky[i < 2 ? i : i + 1];
        for (double ground = 0; ground <= 1; ground += 0.25) {
            double w = 3, mu0 = 0.6, tau[2] = {0, w};
            pps_options opts = {.streams = 16, .light = {2, 0.7, ground}};
            pps_model *model = solve(name, (pps_slab){1, 0.5, w}, mu0, opts);
            pps_flux f[2];
            assert_int_equal(pps_model_flux(model, 2, tau, f), PPS_OK);
            double in = 2 * mu0 + 0.7 * PI, reaches = f[1].down + f[1].direct;
            assert_close(f[1].up, ground * reaches, 1e-12, 0);
            assert_close(in - f[0].up, (1 - ground) * reaches, 1e-11, 1e-12);
            pps_model_free(model);
        }
    }
}

static void light_is_linear(void **state) {
    (void)state;
    double tau = 1, single[3];
    static const pps_light lights[] = {{1, 0, 0.3}, {0, 1, 0.3}, {2, 3, 0.3}};
    for (int i = 0; i < 3; i++) {
        pps_flux flux;
        pps_model *model = solve("exact", (pps_slab){0.9, 0.2, 3}, 0.5,
                                 (pps_options){.streams = 16, .light = lights[i]});
        assert_int_equal(pps_model_flux(model, 1, &tau, &flux), PPS_OK);
        single[i] = flux.mean;
        pps_model_free(model);
    }
    assert_close(single[2], 2 * single[0] + 3 * single[1], 1e-14, 0);
}

static void bad_light_is_refused(void **state) {
    (void)state;
    static const pps_light lights[] = {{-1, 0, 0},          {1, -1, 0},
                                       {1, 0, 1.1},         {1, 0, -0.1},
                                       {(double)NAN, 0, 0}, {1, (double)INFINITY, 0}};
    pps_slab slab = {0.9, 0, 1};
    for (int i = 0; i < 6; i++) {
        pps_model *model;
        assert_int_equal(pps_model_create(pps_method_find("spp"), &slab,
                                          &(pps_options){.light = lights[i]}, &model),
                         PPS_ERR_ARGUMENT);
    }
    pps_model *model;
    assert_int_equal(pps_model_create(pps_method_find("single"), &slab,
                                      &(pps_options){.light = {.sky = 1}}, &model),
                     PPS_ERR_UNSUPPORTED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_is_white),
        cmocka_unit_test(spherical_albedos_match_the_table),
        cmocka_unit_test(sky_is_a_sum_of_beams),
        cmocka_unit_test(ground_takes_what_it_does_not_reflect),
        cmocka_unit_test(light_is_linear),
        cmocka_unit_test(bad_light_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
