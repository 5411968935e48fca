/* The method "adding": identities, reference tables, sky and ground. Its agreement with
 * `exact` is in test_adding_random.c.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include <ppscat/method.h>

#include "core/quadrature.h"
#include "reference/layers.h"
#include "reference/linear.h"
#include "support/support.h"

static const double PI = 3.14159265358979323846;

static pps_model *create(double albedo, double g, double w, double mu0,
                         double tolerance, pps_light light) {
    pps_slab slab = {albedo, g, w};
    pps_options opts = {.tolerance = tolerance, .light = light};
    pps_model *model;
    assert_int_equal(pps_model_create(pps_method_find("adding"), &slab, &opts, &model),
                     PPS_OK);
    assert_int_equal(pps_model_solve(model, w, mu0), PPS_OK);
    return model;
}

static void fluxes(double albedo, double g, double w, double mu0, pps_light light,
                   size_t n, const double *tau, pps_flux *flux) {
    pps_model *model = create(albedo, g, w, mu0, 1e-11, light);
    assert_int_equal(pps_model_flux(model, n, tau, flux), PPS_OK);
    pps_model_free(model);
}

static const pps_light beam = {.beam = 1}, sky = {.sky = 1};

/* Columns: w, omega, mu0, R, Tdif, Tdir. A sample. */
static void isotropic_fluxes_to_12_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_isotropic_flux.csv");
    for (size_t i = 0; i < t.n_rows; i += 9) {
        const double *row = t.value + i * t.n_columns;
        double w = row[0], mu0 = row[2], tau[2] = {0, w};
        pps_flux flux[2];
        fluxes(row[1], 0, w, mu0, beam, 2, tau, flux);
        assert_close(flux[0].up / mu0, row[3], 1e-12, 0);
        assert_close(flux[1].down / mu0, row[4], 1e-12, 0);
        assert_close(flux[1].direct / mu0, row[5], 1e-14, 0);
    }
    support_table_free(&t);
}

/* Columns: g, omega, w, mu0, R, Tdif, Tdir, Umid, Dmid, R_sph, Tdif_sph. A sample. */
static void anisotropic_fluxes_to_12_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_hg_flux.csv");
    for (size_t i = 0; i < t.n_rows; i += 4) {
        const double *row = t.value + i * t.n_columns;
        double w = row[2], mu0 = row[3], tau[3] = {0, w / 2, w};
        pps_flux flux[3];
        fluxes(row[1], row[0], w, mu0, beam, 3, tau, flux);
        assert_close(flux[0].up / mu0, row[4], 1e-12, 0);
        assert_close(flux[2].down / mu0, row[5], 1e-12, 0);
        assert_close(flux[1].up / mu0, row[7], 1e-12, 0);
        assert_close(flux[1].down / mu0, row[8], 1e-12, 0);
    }
    support_table_free(&t);
}

/* int_0^1 2 mu e^(-w/mu) dmu = 2 E3(w). */
static double uncollided(double w) {
    double sum = 0;
    enum { N = 20000 }; /* in y = -log mu, trapezoid: exponentially accurate */
    for (int i = -N; i <= N; i++) {
        double s = 4.0 * i / N, y = exp(PI / 2 * sinh(s)); /* y in (0, inf) */
        double mu = exp(-y);
        sum += 4.0 / N * PI / 2 * cosh(s) * y * 2 * mu * mu * exp(-w / mu);
    }
    return sum;
}

/* Isotropic light of radiance 1 brings in pi. T_sph of the table is without the light that
 * is not scattered. */
static void sky_response_to_12_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_hg_flux.csv");
    for (size_t i = 0; i < t.n_rows; i += 6) { /* three mu0 a slab */
        const double *row = t.value + i * t.n_columns;
        double w = row[2], tau[2] = {0, w};
        pps_flux flux[2];
        fluxes(row[1], row[0], w, 0.5, sky, 2, tau, flux);
        assert_close(flux[0].up / PI, row[9], 1e-12, 0);
        assert_close(flux[1].down / PI, row[10] + uncollided(w), 1e-12, 0);
        assert_close(flux[0].down, PI, 1e-14, 0);
        assert_close(flux[0].direct, 0, 0, 0);
        assert_close(flux[1].mean, flux[1].mean_diffuse, 0, 0);
    }
    support_table_free(&t);
}

/* Columns: g, omega, w, mu0, mu, phi, top up, bottom down, mid up, mid down. A sample. */
static void radiances_to_12_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_hg_radiance.csv");
    for (size_t i = 0; i < t.n_rows; i += 37) {
        const double *row = t.value + i * t.n_columns;
        double w = row[2], tau[3] = {0, w / 2, w}, mu[2] = {-row[4], row[4]};
        pps_grid at = {3, 2, 1, tau, mu, &row[5]};
        double radiance[6];
        pps_model *model = create(row[1], row[0], w, row[3], 1e-11, beam);
        assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
        pps_model_free(model);
        assert_close(radiance[0], row[6], 1e-12, 0);
        assert_close(radiance[5], row[7], 1e-12, 0);
        assert_close(radiance[2], row[8], 1e-12, 0);
        assert_close(radiance[3], row[9], 1e-12, 0);
    }
    support_table_free(&t);
}

static void conservative_slab_returns_all_energy(void **state) {
    (void)state;
    static const double cases[][3] = {/* g, w, mu0 */
                                      {0, 1e-6, 0.01},
                                      {0.8, 0.1, 0.3},
                                      {-0.6, 3, 1},
                                      {0.5, 1e3, 0.5},
                                      {0, 1e9, 0.05}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double g = cases[i][0], w = cases[i][1], mu0 = cases[i][2];
        double tau[3] = {0, w / 3, w}, scattered = -mu0 * expm1(-w / mu0);
        pps_flux f[3];
        fluxes(1, g, w, mu0, beam, 3, tau, f);
        assert_close(f[0].up + f[2].down, scattered, 1e-11, 0);
        assert_close(f[1].down - f[1].up + f[1].direct, mu0 - f[0].up, 0,
                     1e-11 * scattered);
    }
}

/* The transmission of conservative slabs falls as 1/thickness, to all digits, however
 * thick: 1/T is linear in the thickness. */
static void thick_conservative_slab_keeps_its_digits(void **state) {
    (void)state;
    double inverse[3];
    for (int i = 0; i < 3; i++) {
        double w = 1e8 * (1 + i);
        pps_flux flux;
        fluxes(1, 0.5, w, 0.7, beam, 1, &w, &flux);
        inverse[i] = 1 / flux.down;
    }
    assert_close(inverse[2] - inverse[1], inverse[1] - inverse[0], 1e-11, 0);
}

/* I(mu0 -> mu)/mu0 = I(mu -> mu0)/mu, up at the top and down at the bottom. */
static void light_may_go_backwards(void **state) {
    (void)state;
    double a = 0.15, b = 0.7, phi = 40, w = 2, tau[2] = {0, w};
    double one[4], two[4], mus[2][2] = {{-b, b}, {-a, a}};
    for (int i = 0; i < 2; i++) {
        pps_grid at = {2, 2, 1, tau, mus[i], &phi};
        pps_model *model = create(0.9, 0.6, w, i ? b : a, 1e-11, beam);
        assert_int_equal(pps_model_radiance(model, &at, i ? two : one), PPS_OK);
        pps_model_free(model);
    }
    assert_close(one[0] / a, two[0] / b, 1e-12, 0);
    assert_close(one[3] / a, two[3] / b, 1e-12, 0);
}

static pps_stack *built(const pps_stack_problem *problem,
                        const pps_directions *directions) {
    pps_stack *stack = pps_stack_new();
    assert_non_null(stack);
    assert_int_equal(pps_stack_build(stack, problem, directions), PPS_OK);
    return stack;
}

/* Light that two half slabs exchange, at the level of the layers: the light that leaves
 * each half, lit by the beam and by the other half, is the field in the middle of the
 * whole. */
static void two_halves_added_equal_the_whole(void **state) {
    (void)state;
    enum { N = 24, WANTED = 2, ALL = N + WANTED };
    double mu[ALL], weight[N], zero[ALL] = {0}, whole[2][ALL], down[ALL], up[ALL];
    double unused[ALL];
    pps_gauss_unit(N, mu, weight);
    mu[N] = 0.01;
    mu[N + 1] = 0.77;
    pps_directions directions = {N, ALL, mu, weight};
    for (int m = 0; m < 3; m++) {
        double w = 3.7, mu0 = 0.4, past = exp(-w / 2 / mu0);
        pps_stack_problem problem = {{1, 0.5, w}, mu0, 1, w, 1e-13, m, 30};
        pps_stack *stack = built(&problem, &directions);
        problem.slab.thickness = w / 2;
        pps_stack *upper = built(&problem, &directions);
        problem.beam = past;
        pps_stack *lower = built(&problem, &directions);
        memset(up, 0, sizeof up);
        for (int bounce = 0; bounce < 200; bounce++) {
            pps_stack_at(upper, w / 2, zero, up, down, unused);
            pps_stack_at(lower, 0, down, zero, unused, up);
        }
        pps_stack_at(stack, w / 2, zero, zero, whole[0], whole[1]);
        for (int i = 0; i < ALL; i++) {
            assert_close(whole[0][i], down[i], 1e-12, 1e-15);
            assert_close(whole[1][i], up[i], 1e-12, 1e-15);
        }
        pps_stack_free(stack);
        pps_stack_free(upper);
        pps_stack_free(lower);
    }
}

/* A quarter of the way, by halving the whole or by halving the half of it. */
static void depth_is_the_same_however_it_is_reached(void **state) {
    (void)state;
    enum { N = 16 };
    double mu[N], weight[N], zero[N] = {0}, whole[2][N], middle[2][N], part[2][N];
    pps_gauss_unit(N, mu, weight);
    pps_directions directions = {N, N, mu, weight};
    double w = 3.7, tau = 0.3 * w;
    pps_stack_problem problem = {{0.95, 0.5, w}, 0.4, 1, w, 1e-13, 0, 20};
    pps_stack *stack = built(&problem, &directions);
    problem.slab.thickness = 0.7 * w;
    pps_stack *upper = built(&problem, &directions);
    pps_stack_at(stack, 0.7 * w, zero, zero, middle[0], middle[1]);
    pps_stack_at(stack, tau, zero, zero, whole[0], whole[1]);
    pps_stack_at(upper, tau, zero, middle[1], part[0], part[1]);
    for (int i = 0; i < N; i++) {
        assert_close(part[0][i], whole[0][i], 1e-12, 0);
        assert_close(part[1][i], whole[1][i], 1e-12, 0);
    }
    pps_stack_free(stack);
    pps_stack_free(upper);
}

static void ground_of_no_reflectance_is_black(void **state) {
    (void)state;
    double tau[2] = {0.3, 1.5};
    pps_flux black[2], none[2];
    fluxes(0.9, 0.5, 1.5, 0.4, (pps_light){.beam = 1, .ground = 0}, 2, tau, black);
    fluxes(0.9, 0.5, 1.5, 0.4, (pps_light){.beam = 1, .ground = 1e-300}, 2, tau, none);
    assert_close(none[0].up, black[0].up, 1e-13, 0);
    assert_close(none[1].down, black[1].down, 1e-13, 0);
    assert_close(none[1].up, 0, 0, 1e-290);
}

static void white_ground_under_a_conservative_slab_returns_everything(void **state) {
    (void)state;
    static const double thickness[] = {1e-4, 1, 50, 1e6};
    for (int i = 0; i < 4; i++) {
        double w = thickness[i], tau[3] = {0, w / 2, w};
        pps_flux f[3];
        fluxes(1, 0.3, w, 0.6, (pps_light){.beam = 1, .sky = 0.2, .ground = 1}, 3, tau,
               f);
        assert_close(f[0].up, 0.6 + 0.2 * PI, 1e-11, 0);
        assert_close(f[1].down + f[1].direct, f[1].up, 1e-11, 0);
        assert_close(f[2].down + f[2].direct, f[2].up, 1e-11, 0);
    }
}

/* Nothing scatters: the ground alone. */
static void ground_is_lambertian(void **state) {
    (void)state;
    double w = 0.7, mu0 = 0.4, tau[2] = {0, w}, mu[2] = {-0.3, -1}, phi = 77;
    double radiance[4];
    pps_grid at = {2, 2, 1, tau, mu, &phi};
    pps_light light = {.beam = 2, .sky = 0.5, .ground = 0.25};
    pps_model *model = create(0, 0.5, w, mu0, 1e-11, light);
    assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
    pps_model_free(model);
    double b = 0.25 * (2 * mu0 * exp(-w / mu0) / PI + 0.5 * uncollided(w));
    assert_close(radiance[2], b, 1e-11, 0);
    assert_close(radiance[3], b, 1e-11, 0);
    assert_close(radiance[0], b * exp(-w / 0.3), 1e-11, 0);
    assert_close(radiance[1], b * exp(-w), 1e-11, 0);
}

/* Over a ground the beam and the sky superpose. */
static void lights_superpose(void **state) {
    (void)state;
    double tau[2] = {0, 1.1}, mu[2] = {-0.6, 0.6}, phi = 20, part[3][4];
    pps_light light[3] = {{.beam = 2, .ground = 0.4},
                          {.sky = 0.3, .ground = 0.4},
                          {.beam = 2, .sky = 0.3, .ground = 0.4}};
    pps_grid at = {2, 2, 1, tau, mu, &phi};
    for (int i = 0; i < 3; i++) {
        pps_model *model = create(0.8, 0.4, 1.1, 0.5, 1e-11, light[i]);
        assert_int_equal(pps_model_radiance(model, &at, part[i]), PPS_OK);
        pps_model_free(model);
    }
    for (int i = 0; i < 4; i++) {
        assert_close(part[2][i], part[0][i] + part[1][i], 1e-12, 0);
    }
}

/* Columns: omega, mu, H, plane albedo, .. */
static void half_space_follows_the_h_function(void **state) {
    (void)state;
    support_table t = support_read("hfunction_isotropic.csv");
    for (size_t i = 0; i < t.n_rows; i += 37) {
        const double *row = t.value + i * t.n_columns;
        double tau = 0;
        pps_flux flux;
        if (row[1] >= 0.01) {
            fluxes(row[0], 0, (double)INFINITY, row[1], beam, 1, &tau, &flux);
            assert_close(flux.up / row[1], row[3], 1e-12, 0);
        }
    }
    support_table_free(&t);
}

/* Light of an isotropic sky fills a conservative slab over a white ground evenly. */
static void furnace_is_even(void **state) {
    (void)state;
    double w = 5, tau[3] = {0, 0.01, 5}, mu[4] = {-1, -0.1, 0.1, 1}, phi = 0;
    double radiance[12];
    pps_grid at = {3, 4, 1, tau, mu, &phi};
    pps_model *model =
        create(1, 0.7, w, 0.5, 1e-11, (pps_light){.sky = 1, .ground = 1});
    assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
    pps_model_free(model);
    for (int i = 0; i < 12; i++) {
        assert_close(radiance[i], 1, 1e-12, 0);
    }
}

/* 1 on the diagonal but for 1e-30, the row sums: the plain factors see 0. */
static void elimination_by_row_sums_keeps_a_tiny_excess(void **state) {
    (void)state;
    double a[4] = {1, -1, -1, 1}, excess[2] = {1e-30, 3e-30}, b[2] = {1, 1};
    int pivot[2];
    assert_true(pps_linear_factor_excess(2, a, excess, pivot));
    pps_linear_solve(2, a, pivot, 1, b, 2);
    assert_close(b[0], 0.5e30, 1e-15, 0);
    assert_close(b[1], 0.5e30, 1e-15, 0);
}

/* The beam lights the uppermost 1e-4, where light goes along the horizon. */
static void a_grazing_beam_is_followed_into_the_skin(void **state) {
    (void)state;
    double tau[2] = {0, 5}, mu[4] = {-0.9, -0.05, 0.05, 0.9}, phi[2] = {0, 120};
    double rough[16], sharp[16], largest = 0;
    pps_grid at = {2, 4, 2, tau, mu, phi};
    pps_model *model = create(0.95, 0.8, 10, 1e-4, 5e-6, beam);
    assert_int_equal(pps_model_radiance(model, &at, rough), PPS_OK);
    pps_model_free(model);
    model = create(0.95, 0.8, 10, 1e-4, 1e-9, beam);
    assert_int_equal(pps_model_radiance(model, &at, sharp), PPS_OK);
    pps_model_free(model);
    for (int i = 0; i < 16; i++) {
        largest = fmax(largest, sharp[i]);
    }
    for (int i = 0; i < 16; i++) {
        assert_close(rough[i], sharp[i], 0, 5e-6 * fmax(sharp[i], 1e-3 * largest));
    }
}

static void what_cannot_be_met_is_said(void **state) {
    (void)state;
    double tau = 0, mu = -0.5, phi = 0, radiance;
    pps_grid at = {1, 1, 1, &tau, &mu, &phi};
    pps_model *model = create(0.9, 0.99, 1, 0.5, 1e-8, beam);
    assert_int_equal(pps_model_radiance(model, &at, &radiance), PPS_ERR_UNSUPPORTED);
    pps_model_free(model);
}

static void info_says_what_was_used(void **state) {
    (void)state;
    double tau = 0.5, mu = -0.5, phi = 0, radiance;
    pps_grid at = {1, 1, 1, &tau, &mu, &phi};
    pps_info info;
    pps_model *model = create(0.9, 0.5, 1, 0.5, 1e-6, beam);
    assert_int_equal(pps_model_radiance(model, &at, &radiance), PPS_OK);
    pps_model_query(model, &info);
    pps_model_free(model);
    assert_true(info.streams > 0 && info.orders > 1);
    assert_true(info.error_estimate > 0 && info.error_estimate <= 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_fluxes_to_12_digits),
        cmocka_unit_test(anisotropic_fluxes_to_12_digits),
        cmocka_unit_test(sky_response_to_12_digits),
        cmocka_unit_test(radiances_to_12_digits),
        cmocka_unit_test(half_space_follows_the_h_function),
        cmocka_unit_test(conservative_slab_returns_all_energy),
        cmocka_unit_test(thick_conservative_slab_keeps_its_digits),
        cmocka_unit_test(light_may_go_backwards),
        cmocka_unit_test(two_halves_added_equal_the_whole),
        cmocka_unit_test(depth_is_the_same_however_it_is_reached),
        cmocka_unit_test(ground_of_no_reflectance_is_black),
        cmocka_unit_test(white_ground_under_a_conservative_slab_returns_everything),
        cmocka_unit_test(ground_is_lambertian),
        cmocka_unit_test(lights_superpose),
        cmocka_unit_test(furnace_is_even),
        cmocka_unit_test(elimination_by_row_sums_keeps_a_tiny_excess),
        cmocka_unit_test(a_grazing_beam_is_followed_into_the_skin),
        cmocka_unit_test(what_cannot_be_met_is_said),
        cmocka_unit_test(info_says_what_was_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
