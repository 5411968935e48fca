/* The Monte Carlo: against `exact` within its standard errors, against itself, and where
 * the answer is known. MC_SLABS and MC_PHOTONS say how far the random walk goes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include <ppscat/mc.h>
#include <ppscat/ppscat.h>

#include "core/quadrature.h"
#include "reference/mc.h"

static const double PI = 3.14159265358979323846;

enum { N_DEPTHS = 4, N_MU = 8, N_PHI = 3, N_RADIANCES = N_DEPTHS * N_MU * N_PHI };
enum { N_OUTPUTS = N_RADIANCES + 3 * N_DEPTHS };

static const double mus[N_MU] = {1, 0.7, 0.3, 0.01, -0.01, -0.3, -0.7, -1};
static const double phis[N_PHI] = {0, 60, 180};

/* Radiances, then up, down and mean diffuse of each depth. */
typedef struct {
    double value[N_OUTPUTS], error[N_OUTPUTS];
} answer;

typedef struct {
    pps_slab slab;
    double mu0, tau[N_DEPTHS];
} place;

static place place_of(pps_slab slab, double mu0) {
    double deep = fmin(slab.thickness, 10);
    return (place){slab, mu0, {0, 0.1 * deep, 0.5 * deep, deep}};
}

static pps_grid grid_of(const place *at) {
    return (pps_grid){N_DEPTHS, N_MU, N_PHI, at->tau, mus, phis};
}

static void lay_out(const pps_flux *flux, double *out) {
    for (int k = 0; k < N_DEPTHS; k++) {
        out[N_RADIANCES + 3 * k] = flux[k].up;
        out[N_RADIANCES + 3 * k + 1] = flux[k].down;
        out[N_RADIANCES + 3 * k + 2] = flux[k].mean_diffuse;
    }
}

static answer sampled(const place *at, const pps_mc_opts *opts) {
    answer a;
    pps_flux flux[N_DEPTHS], error[N_DEPTHS];
    pps_grid grid = grid_of(at);
    assert_int_equal(pps_mc_radiance(&at->slab, at->mu0, opts, &grid, a.value, a.error),
                     PPS_OK);
    assert_int_equal(
        pps_mc_flux(&at->slab, at->mu0, opts, N_DEPTHS, at->tau, flux, error), PPS_OK);
    lay_out(flux, a.value);
    lay_out(error, a.error);
    return a;
}

/* The same by another method; its status. */
static pps_status solved(const char *method, const place *at, pps_options opts,
                         double *value) {
    pps_model *model;
    pps_flux flux[N_DEPTHS];
    pps_grid grid = grid_of(at);
    pps_status status =
        pps_model_create(pps_method_find(method), &at->slab, &opts, &model);
    if (status) {
        return status;
    }
    status = pps_model_solve(model, at->slab.thickness, at->mu0);
    status = status ? status : pps_model_radiance(model, &grid, value);
    status = status ? status : pps_model_flux(model, N_DEPTHS, at->tau, flux);
    lay_out(flux, value);
    pps_model_free(model);
    return status;
}

/* How many numbers were compared, said to be unknown, and beyond four errors. */
typedef struct {
    int all, unknown, sampled, beyond;
    double squares; /* of errors in standard errors */
} tally;

/* `tolerance` is that of `want`, as options.tolerance. */
static void compare(const answer *got, const double *want, double tolerance,
                    tally *sum) {
    double largest = 0;
    for (int i = 0; i < N_RADIANCES; i++) {
        largest = fmax(largest, want[i]);
    }
    for (int i = 0; i < N_OUTPUTS; i++) {
        double scale = fmax(fabs(want[i]), i < N_RADIANCES ? 1e-3 * largest : 0);
        double off = fmax(fabs(got->value[i] - want[i]) - tolerance * scale, 0);
        double error = got->error[i];
        sum->all++;
        if (isinf(error)) {
            sum->unknown++;
        } else if (error == 0) {
            assert_close(off, 0, 0, 1e-12 * scale);
        } else if (tolerance * scale < 0.3 * error) { /* else `want` is no judge */
            sum->sampled++;
            sum->beyond += off > 4 * error;
            sum->squares += pow((got->value[i] - want[i]) / error, 2);
        }
    }
}

/* At least 99.9 % within four standard errors, and those neither too large nor too small
 * (numbers of one slab share their photons, so the mean square scatters); at most a
 * tenth said to be unknown. */
static void assert_agreement(const tally *sum) {
    double rms = sqrt(sum->squares / sum->sampled);
    print_message("%d numbers, %d unknown, %d sampled, %d beyond 4 standard errors, "
                  "rms %.3f\n",
                  sum->all, sum->unknown, sum->sampled, sum->beyond, rms);
    assert_true(sum->sampled > sum->all / 2);
    assert_true(sum->beyond <= sum->sampled / 1000);
    assert_true(sum->unknown <= sum->all / 10);
    assert_close(rms, 1, 0.3, 0);
}

static place random_place(uint64_t *random) {
    double exponent = -3 * support_random(random);
    double albedo = support_random(random) < 0.2 ? 1 : 1 - pow(10, exponent);
    double g = 1.6 * support_random(random) - 0.8;
    double thickness = pow(10, 4 * support_random(random) - 2);
    double mu0 = 0.05 + 0.95 * support_random(random);
    return place_of((pps_slab){albedo, g, thickness}, mu0);
}

static void random_slabs_agree_with_exact(void **state) {
    (void)state;
    uint64_t random = 2;
    tally sum = {0};
    for (uint64_t i = 0; i < MC_SLABS; i++) {
        place at = random_place(&random);
        answer got = sampled(&at, &(pps_mc_opts){.photons = MC_PHOTONS, .seed = i});
        double want[N_OUTPUTS];
        assert_int_equal(solved("exact", &at, (pps_options){.tolerance = 1e-4}, want),
                         PPS_OK);
        compare(&got, want, 1e-4, &sum);
    }
    assert_agreement(&sum);
}

/* Beam, sky and ground at once. */
static void sky_and_ground_agree_with(const char *method) {
    uint64_t random = 3;
    tally sum = {0};
    pps_light light = {.beam = 2, .sky = 0.3, .ground = 0.6};
    for (uint64_t i = 0; i < (MC_SLABS + 1) / 2; i++) {
        place at = random_place(&random);
        answer got = sampled(
            &at, &(pps_mc_opts){.light = light, .photons = MC_PHOTONS, .seed = i});
        double want[N_OUTPUTS];
        pps_options opts = {.tolerance = 1e-4, .light = light};
        assert_int_equal(solved(method, &at, opts, want), PPS_OK);
        compare(&got, want, 1e-4, &sum);
    }
    assert_agreement(&sum);
}

static void sky_and_ground_agree_with_superposition(void **state) {
    (void)state;
    sky_and_ground_agree_with("exact");
}

static void sky_and_ground_agree_with_adding(void **state) {
    (void)state;
    sky_and_ground_agree_with("adding");
}

/* ---- what is known ---- */

/* Between a sky of 1 and a white ground a conservative slab has radiance 1 everywhere. */
static void light_in_equilibrium_is_isotropic(void **state) {
    (void)state;
    static const double g[] = {-0.5, 0, 0.8}, w[] = {0.01, 1, 20};
    tally sum = {0};
    for (int i = 0; i < 9; i++) {
        place at = place_of((pps_slab){1, g[i % 3], w[i / 3]}, 1);
        double want[N_OUTPUTS];
        for (int n = 0; n < N_OUTPUTS; n++) {
            want[n] = n < N_RADIANCES || (n - N_RADIANCES) % 3 == 2 ? 1 : PI;
        }
        answer got = sampled(
            &at, &(pps_mc_opts){.light = {.sky = 1, .ground = 1}, .photons = 4000});
        compare(&got, want, 1e-12, &sum);
    }
    assert_agreement(&sum);
}

static void without_scattering_all_is_exact(void **state) {
    (void)state;
    place at = place_of((pps_slab){0, 0.5, 1}, 0.5);
    pps_light light = {.beam = 2, .sky = 0.25, .ground = 0.5};
    answer got = sampled(&at, &(pps_mc_opts){.light = light, .photons = 100});
    double e3 = 0.10969196719776013684; /* E3(1) */
    double ground = 0.5 / PI * (2 * 0.5 * exp(-2) + 0.25 * 2 * PI * e3);
    for (int k = 0; k < N_DEPTHS; k++) {
        for (int j = 0; j < N_MU; j++) {
            double want = mus[j] > 0 ? 0.25 * exp(-at.tau[k] / mus[j])
                                     : ground * exp((1 - at.tau[k]) / mus[j]);
            assert_close(got.value[(k * N_MU + j) * N_PHI], want, 1e-14, 1e-300);
        }
    }
    assert_close(got.value[N_RADIANCES], ground * 2 * PI * e3, 1e-14, 0);
    for (int i = 0; i < N_OUTPUTS; i++) {
        assert_true(got.error[i] == 0);
    }
}

static void weak_scattering_is_single_scattering(void **state) {
    (void)state;
    static const double g[] = {-0.9, 0, 0.9}, w[] = {1e-9, 0.03, 3};
    for (int i = 0; i < 9; i++) {
        place at = place_of((pps_slab){1e-12, g[i % 3], w[i / 3]}, 0.3);
        answer got = sampled(&at, &(pps_mc_opts){.photons = 100});
        double want[N_OUTPUTS];
        assert_int_equal(solved("single", &at, (pps_options){0}, want), PPS_OK);
        for (int n = 0; n < N_RADIANCES; n++) {
            assert_close(got.value[n], want[n], 1e-8, 0);
        }
    }
}

static void conservative_half_spaces_return_all_energy(void **state) {
    (void)state;
    static const double g[] = {-0.5, 0, 0.8};
    for (int i = 0; i < 3; i++) {
        pps_slab slab = {1, g[i], INFINITY};
        double top = 0;
        pps_flux flux, error;
        assert_int_equal(pps_mc_flux(&slab, 0.6, &(pps_mc_opts){.photons = 10000}, 1,
                                     &top, &flux, &error),
                         PPS_OK);
        assert_true(error.up < 0.1 * flux.up);
        assert_close(flux.up, 0.6, 0, 4 * error.up);
    }
}

static void energy_is_conserved(void **state) {
    (void)state;
    uint64_t random = 4;
    for (uint64_t i = 0; i < 20; i++) {
        place at = random_place(&random);
        pps_mc_opts opts = {
            .light = {.beam = 1, .sky = 0.2, .ground = 0.1 * (int)(i % 3)},
            .photons = 2000,
            .seed = i};
        pps_mc_budget b;
        assert_int_equal(pps_mc_energy(&at.slab, at.mu0, &opts, &b), PPS_OK);
        assert_close(b.launched, 2000 * (at.mu0 + 0.2 * PI), 1e-12, 0);
        assert_close(b.reflected + b.transmitted + b.absorbed, b.launched + b.roulette,
                     1e-12, 0);
        assert_close(b.roulette, 0, 0, 0.05 * b.launched);
    }
}

/* ---- photons and seeds ---- */

static void errors_fall_as_the_root_of_the_photons(void **state) {
    (void)state;
    place at = place_of((pps_slab){0.9, 0.5, 3}, 0.5);
    double want[N_OUTPUTS], few_squares = 0, many_squares = 0;
    assert_int_equal(solved("exact", &at, (pps_options){.tolerance = 1e-7}, want),
                     PPS_OK);
    /* Errors against `exact`, over 20 seeds, of the fluxes. */
    for (uint64_t seed = 0; seed < 20; seed++) {
        pps_flux few[N_DEPTHS], many[N_DEPTHS];
        double got_few[N_OUTPUTS], got_many[N_OUTPUTS];
        pps_mc_flux(&at.slab, at.mu0, &(pps_mc_opts){.photons = 500, .seed = seed},
                    N_DEPTHS, at.tau, few, NULL);
        pps_mc_flux(&at.slab, at.mu0, &(pps_mc_opts){.photons = 32000, .seed = seed},
                    N_DEPTHS, at.tau, many, NULL);
        lay_out(few, got_few);
        lay_out(many, got_many);
        for (int i = N_RADIANCES; i < N_OUTPUTS; i++) {
            double scale = fmax(want[i], 1e-300);
            few_squares += pow((got_few[i] - want[i]) / scale, 2);
            many_squares += pow((got_many[i] - want[i]) / scale, 2);
        }
    }
    assert_close(sqrt(few_squares / many_squares), 8, 0.25, 0);
}

static void standard_errors_fall_as_the_root_of_the_photons(void **state) {
    (void)state;
    place at = place_of((pps_slab){0.9, 0.5, 3}, 0.5);
    answer few = sampled(&at, &(pps_mc_opts){.photons = 4000});
    answer many = sampled(&at, &(pps_mc_opts){.photons = 64000, .seed = 1});
    for (int i = N_RADIANCES; i < N_OUTPUTS; i++) {
        assert_close(few.error[i], 4 * many.error[i], 0.1, 0);
    }
}

static void the_answer_depends_on_the_seed_alone(void **state) {
    (void)state;
    place at = place_of((pps_slab){0.9, 0.5, 3}, 0.5);
    answer one = sampled(&at, &(pps_mc_opts){.photons = 3000, .seed = 7});
    answer again = sampled(&at, &(pps_mc_opts){.photons = 3000, .seed = 7});
    answer other = sampled(&at, &(pps_mc_opts){.photons = 3000, .seed = 8});
    assert_memory_equal(&one, &again, sizeof one);
    assert_true(one.value[N_OUTPUTS - 1] != other.value[N_OUTPUTS - 1]);
}

/* ---- honesty ---- */

static void unknown_numbers_are_said_to_be(void **state) {
    (void)state;
    static const pps_slab deep[] = {{0.5, 0, 60}, {1, 0, 1e9}, {0.9, 0.9, INFINITY}};
    static const double depth[] = {40, 5e8, 300};
    for (int i = 0; i < 3; i++) {
        pps_flux flux, error;
        double mu = -0.5, phi = 90, radiance, radiance_error;
        pps_grid grid = {1, 1, 1, &depth[i], &mu, &phi};
        pps_mc_opts opts = {.photons = 2000};
        pps_mc_flux(&deep[i], 0.5, &opts, 1, &depth[i], &flux, &error);
        pps_mc_radiance(&deep[i], 0.5, &opts, &grid, &radiance, &radiance_error);
        assert_true(isinf(error.up) && isinf(error.mean) && isinf(radiance_error));
        assert_true(isfinite(flux.up) && isfinite(radiance));
    }
}

/* None of 1,000 photons comes near enough to the wanted directions: they agree among
 * themselves, and are wrong by hundreds of their standard errors. */
static void a_peak_that_was_not_seen_is_not_left_out_of_the_error(void **state) {
    (void)state;
    place at = place_of((pps_slab){0.9, 0.99, 1}, 0.6);
    answer got = sampled(&at, &(pps_mc_opts){.photons = 1000});
    for (int i = 0; i < N_RADIANCES; i++) {
        assert_true(got.error[i] == 0 || isinf(got.error[i]));
    }
}

static void the_method_reports_its_largest_error(void **state) {
    (void)state;
    pps_slab slab = {0.9, 0.2, 1};
    place at = place_of(slab, 0.5);
    answer got = sampled(&at, &(pps_mc_opts){.photons = 5000, .seed = 5});
    double worst = 0, value[N_RADIANCES];
    for (int i = 0; i < N_RADIANCES; i++) {
        worst = got.error[i] > 0 ? fmax(worst, got.error[i] / got.value[i]) : worst;
    }
    pps_model *model;
    pps_info info;
    pps_options opts = {.photons = 5000, .seed = 5};
    pps_grid grid = grid_of(&at);
    assert_int_equal(pps_model_create(pps_method_find("mc"), &slab, &opts, &model),
                     PPS_OK);
    assert_int_equal(pps_model_solve(model, 1, 0.5), PPS_OK);
    assert_int_equal(pps_model_radiance(model, &grid, value), PPS_OK);
    pps_model_query(model, &info);
    pps_model_free(model);
    assert_memory_equal(value, got.value, sizeof value);
    assert_close(info.error_estimate, worst, 1e-14, 0);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    pps_slab good = {0.5, 0, 1}, bad = {2, 0, 1};
    double tau = 0.5, beyond = 2, mu = 1, phi = 0, radiance;
    pps_grid grid = {1, 1, 1, &tau, &mu, &phi}, outside = {1, 1, 1, &beyond, &mu, &phi};
    pps_mc_opts white = {.light = {.ground = 1.5}}, dark = {.light = {.sky = -1}};
    pps_flux flux;
    assert_int_equal(pps_mc_radiance(&bad, 1, NULL, &grid, &radiance, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_radiance(&good, 0, NULL, &grid, &radiance, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_radiance(&good, 1, &white, &grid, &radiance, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_radiance(&good, 1, NULL, &outside, &radiance, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_radiance(&good, 1, NULL, &grid, NULL, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_flux(&good, 1, &dark, 1, &tau, &flux, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_flux(&good, 1, NULL, 1, &beyond, &flux, NULL),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_mc_flux(&good, 1, NULL, 0, NULL, NULL, NULL), PPS_OK);
}

/* ---- parts ---- */

/* -2 pi p d(1 - cos)/du = -1: what is sampled is what is evaluated. */
static void sampled_angles_have_the_phase_function(void **state) {
    (void)state;
    static const double g[] = {-0.99, -0.5, 0, 1e-9, 0.3, 0.9, 0.999};
    for (int i = 0; i < 7; i++) {
        for (int n = 1; n < 40; n++) {
            double u = n / 40.0, h = 1e-5;
            double slope =
                (pps_mc_versine(g[i], u + h) - pps_mc_versine(g[i], u - h)) / (2 * h);
            double p = pps_hg(g[i], 1 - pps_mc_versine(g[i], u));
            assert_close(2 * PI * p * fabs(slope), 1, 1e-5, 0);
        }
    }
}

static void exponential_integrals_have_their_digits(void **state) {
    (void)state;
    static const double known[][3] = {
        {1e-6, 0.99998576170460694, 0.49999900000736915},
        {0.3, 0.46911522517896385, 0.30004182656401436},
        {0.999, 0.14871507477274132, 0.10984057245784717},
        {1, 0.14849550677592205, 0.10969196719776014},
        {2.5, 0.019797703948224456, 0.016295369376668827},
        {10, 3.8302404656316088e-6, 3.548762553084382e-6},
        {100, 3.6478214338803783e-46, 3.6127271070228845e-46},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double e2, e3;
        pps_mc_expint(known[i][0], &e2, &e3);
        assert_close(e2, known[i][1], 2e-14, 0);
        assert_close(e3, known[i][2], 2e-14, 0);
    }
    double e2, e3;
    pps_mc_expint(0, &e2, &e3);
    assert_true(e2 == 1 && e3 == 0.5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_slabs_agree_with_exact),
        cmocka_unit_test(sky_and_ground_agree_with_superposition),
        cmocka_unit_test(sky_and_ground_agree_with_adding),
        cmocka_unit_test(light_in_equilibrium_is_isotropic),
        cmocka_unit_test(without_scattering_all_is_exact),
        cmocka_unit_test(weak_scattering_is_single_scattering),
        cmocka_unit_test(conservative_half_spaces_return_all_energy),
        cmocka_unit_test(energy_is_conserved),
        cmocka_unit_test(errors_fall_as_the_root_of_the_photons),
        cmocka_unit_test(standard_errors_fall_as_the_root_of_the_photons),
        cmocka_unit_test(the_answer_depends_on_the_seed_alone),
        cmocka_unit_test(unknown_numbers_are_said_to_be),
        cmocka_unit_test(a_peak_that_was_not_seen_is_not_left_out_of_the_error),
        cmocka_unit_test(the_method_reports_its_largest_error),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(sampled_angles_have_the_phase_function),
        cmocka_unit_test(exponential_integrals_have_their_digits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
