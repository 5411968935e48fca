/* `exact` and `adding` certify each other: random slabs with |g| <= 0.8, both asked for
 * 1e-10. Where `exact` says that it cannot, it is asked for the tightest power of ten that
 * it does promise, and held to that.
 *
 *     test_adding_random [n_cases]
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <ppscat/method.h>

#include "support/support.h"

enum { N_TAU = 4, N_MU = 12, N_PHI = 3, N_BLOCK = N_TAU * N_MU * N_PHI, MOST = 500 };
static const double mus[N_MU] = {-1,   -0.8, -0.5, -0.2, -0.05, -0.01,
                                 0.01, 0.05, 0.2,  0.5,  0.8,   1};
static const double phis[N_PHI] = {0, 70, 180};
static const double TOLERANCE = 1e-10;
static int n_cases = 15;

typedef struct {
    pps_slab slab;
    double mu0, tau[N_TAU];
    pps_status status, exact_status; /* at TOLERANCE */
    double promised;                 /* what exact was held to */
    double radiance_error, flux_error;
} compared_case;

static void draw(compared_case *c, uint64_t *seed) {
    double g = support_random(seed) < 0.2 ? 0 : 0.8 * (2 * support_random(seed) - 1);
    double w = pow(10, -6 + 9 * support_random(seed)), depth = w;
    if (support_random(seed) < 0.1) {
        w = (double)INFINITY;
        depth = 10;
    }
    double kind = support_random(seed);
    double albedo = kind < 0.2    ? 1
                    : kind < 0.25 ? 0
                    : kind < 0.5  ? support_random(seed)
                                  : 1 - pow(10, -12 * support_random(seed));
    *c = (compared_case){.slab = {albedo, g, w}};
    c->mu0 = support_random(seed) < 0.1 ? 1 : pow(10, -2 * support_random(seed));
    for (int k = 0; k < N_TAU; k++) {
        static const double share[N_TAU] = {0, 0.1, 0.5, 1};
        c->tau[k] = share[k] * depth;
    }
}

static pps_status solve(const char *method, const compared_case *c, double tolerance,
                        double *radiance, pps_flux *flux) {
    pps_options opts = {.tolerance = tolerance};
    pps_grid at = {N_TAU, N_MU, N_PHI, c->tau, mus, phis};
    pps_model *model;
    pps_status status =
        pps_model_create(pps_method_find(method), &c->slab, &opts, &model);
    status = status ? status : pps_model_solve(model, c->slab.thickness, c->mu0);
    status = status ? status : pps_model_radiance(model, &at, radiance);
    status = status ? status : pps_model_flux(model, N_TAU, c->tau, flux);
    pps_model_free(model);
    return status;
}

static double radiance_error(const double *got, const double *want) {
    double largest = 0, worst = 0;
    for (int i = 0; i < N_BLOCK; i++) {
        largest = fmax(largest, want[i]);
    }
    for (int i = 0; i < N_BLOCK; i++) {
        double scale = fmax(fabs(want[i]), 1e-3 * largest);
        double error = fabs(got[i] - want[i]);
        worst = fmax(worst, error > 0 ? error / scale : 0);
    }
    return worst;
}

static double flux_error(const pps_flux *got, const pps_flux *want) {
    double worst = 0;
    for (int k = 0; k < N_TAU; k++) {
        worst = fmax(worst, support_relative_error(got[k].up, want[k].up));
        worst = fmax(worst, support_relative_error(got[k].down, want[k].down));
        worst = fmax(worst, support_relative_error(got[k].direct, want[k].direct));
        worst = fmax(worst,
                     support_relative_error(got[k].mean_diffuse, want[k].mean_diffuse));
        worst = fmax(worst, support_relative_error(got[k].mean, want[k].mean));
    }
    return worst;
}

static void compare(compared_case *c) {
    double adding[N_BLOCK] = {0}, exact[N_BLOCK] = {0};
    pps_flux adding_flux[N_TAU] = {{0}}, exact_flux[N_TAU] = {{0}};
    c->promised = TOLERANCE;
    c->status = solve("adding", c, TOLERANCE, adding, adding_flux);
    c->exact_status = solve("exact", c, TOLERANCE, exact, exact_flux);
    pps_status status = c->exact_status;
    while (status == PPS_ERR_TOLERANCE && c->promised < 1e-5) {
        c->promised *= 10;
        status = solve("exact", c, c->promised, exact, exact_flux);
    }
    c->radiance_error = radiance_error(exact, adding);
    c->flux_error = flux_error(exact_flux, adding_flux);
}

static int report(const compared_case *c) {
    int bad = c->status != PPS_OK || !(c->radiance_error <= c->promised) ||
              !(c->flux_error <= c->promised);
    if (bad || c->exact_status) {
        print_message("%salbedo %.17g g %.17g w %.17g mu0 %.17g: adding %s; exact "
                      "promises %.0e; they differ by %.1e (fluxes %.1e)\n",
                      bad ? "FAILED " : "", c->slab.albedo, c->slab.g,
                      c->slab.thickness, c->mu0, pps_status_string(c->status),
                      c->promised, c->radiance_error, c->flux_error);
    }
    return bad;
}

static void exact_and_adding_agree(void **state) {
    (void)state;
    compared_case *c = calloc(MOST, sizeof *c);
    uint64_t seed = 1974;
    int failed = 0, weaker = 0;
    double radiance = 0, flux = 0;
    assert_non_null(c);
    for (int i = 0; i < n_cases; i++) {
        draw(&c[i], &seed);
    }
#pragma omp parallel for schedule(dynamic)
    for (int i = 0; i < n_cases; i++) {
        compare(&c[i]);
    }
    for (int i = 0; i < n_cases; i++) {
        failed += report(&c[i]);
        weaker += c[i].exact_status != PPS_OK;
        if (!c[i].exact_status) {
            radiance = fmax(radiance, c[i].radiance_error);
            flux = fmax(flux, c[i].flux_error);
        }
    }
    print_message("%d slabs; where both promise %.0e (%d): radiances differ by %.1e, "
                  "fluxes by %.1e\n",
                  n_cases, TOLERANCE, n_cases - weaker, radiance, flux);
    free(c);
    assert_int_equal(failed, 0);
}

int main(int argc, char **argv) {
    if (argc > 1) {
        n_cases = atoi(argv[1]);
        n_cases = n_cases > MOST ? MOST : n_cases;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(exact_and_adding_agree)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
