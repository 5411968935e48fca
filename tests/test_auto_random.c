/* The method "exact" with streams chosen by itself, over random slabs: the tolerance is met
 * against 320 streams. Slow: run by `scripts/test.sh --all`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/method.h>

#include "support/support.h"

enum { N_TAU = 4, N_MU = 12, N_PHI = 3, N_BLOCK = N_TAU * N_MU * N_PHI, CASES = 150 };
static const double mus[N_MU] = {-1,   -0.8, -0.5, -0.2, -0.05, -0.01,
                                 0.01, 0.05, 0.2,  0.5,  0.8,   1};
static const double phis[N_PHI] = {0, 70, 180};

typedef struct {
    pps_slab slab;
    double mu0, tau[N_TAU];
    double radiance[N_BLOCK];
    pps_flux flux[N_TAU];
} solved_case;

static void draw(solved_case *c, uint64_t *seed) {
    double g = support_random(seed) < 0.2 ? 0 : 0.8 * (2 * support_random(seed) - 1);
    double w = pow(10, -9 + 12 * support_random(seed));
    double depth = w;
    if (support_random(seed) < 0.1) {
        w = (double)INFINITY;
        depth = 10;
    }
    double albedo =
        support_random(seed) < 0.3 ? 1 : 1 - pow(10, -4 * support_random(seed));
    c->slab = (pps_slab){albedo, g, w};
    c->mu0 = pow(10, -3 * support_random(seed));
    for (int k = 0; k < N_TAU; k++) {
        static const double share[N_TAU] = {0, 0.1, 0.5, 1};
        c->tau[k] = share[k] * depth;
    }
}

static pps_grid grid_of(const solved_case *c) {
    return (pps_grid){N_TAU, N_MU, N_PHI, c->tau, mus, phis};
}

/* 320 streams, on the kind of nodes that suits the thickness. */
static void solve_reference(solved_case *c) {
    pps_nodes nodes = c->slab.thickness < 1e-2 ? PPS_NODES_GRADED : PPS_NODES_MAPPED;
    pps_dom_opts opts = {.streams = 320, .nodes = nodes, .tolerance = 1e-9};
    pps_grid at = grid_of(c);
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&c->slab, &opts, &dom), PPS_OK);
    assert_int_equal(pps_dom_solve(dom, c->mu0), PPS_OK);
    assert_int_equal(pps_dom_radiance(dom, &at, c->radiance), PPS_OK);
    assert_int_equal(pps_dom_flux(dom, N_TAU, c->tau, c->flux), PPS_OK);
    pps_dom_free(dom);
}

static double radiance_error(const double *got, const double *want) {
    double largest = 0, worst = 0;
    for (int i = 0; i < N_BLOCK; i++) {
        largest = fmax(largest, want[i]);
    }
    for (int i = 0; i < N_BLOCK; i++) {
        double scale = fmax(want[i], 1e-3 * largest);
        worst = fmax(worst, fabs(got[i] - want[i]) / scale);
    }
    return worst;
}

static double flux_error(const pps_flux *got, const pps_flux *want) {
    double worst = 0;
    for (int k = 0; k < N_TAU; k++) {
        worst = fmax(worst, support_relative_error(got[k].up, want[k].up));
        worst = fmax(worst, support_relative_error(got[k].down, want[k].down));
        worst = fmax(worst,
                     support_relative_error(got[k].mean_diffuse, want[k].mean_diffuse));
    }
    return worst;
}

static void report(const solved_case *c, const char *what, double error, double tol) {
    if (error > tol) {
        print_error("%s: albedo %.17g g %g w %g mu0 %g: error %.2e for %.0e\n", what,
                    c->slab.albedo, c->slab.g, c->slab.thickness, c->mu0, error, tol);
    }
}

/* True when both the radiances and the fluxes meet the tolerance. */
static int meets(const solved_case *c, double tolerance) {
    pps_options opts = {.tolerance = tolerance};
    pps_grid at = grid_of(c);
    double radiance[N_BLOCK];
    pps_flux flux[N_TAU];
    pps_model *model;
    assert_int_equal(
        pps_model_create(pps_method_find("exact"), &c->slab, &opts, &model), PPS_OK);
    assert_int_equal(pps_model_solve(model, c->slab.thickness, c->mu0), PPS_OK);
    assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
    assert_int_equal(pps_model_flux(model, N_TAU, c->tau, flux), PPS_OK);
    pps_model_free(model);
    double in_field = radiance_error(radiance, c->radiance);
    double in_flux = flux_error(flux, c->flux);
    report(c, "radiance", in_field, tolerance);
    report(c, "flux", in_flux, tolerance);
    return in_field <= tolerance && in_flux <= tolerance;
}

static void tolerance_is_met_on_random_slabs(void **state) {
    (void)state;
    uint64_t seed = 2013;
    int missed = 0;
    for (int i = 0; i < CASES; i++) {
        solved_case c;
        draw(&c, &seed);
        solve_reference(&c);
        missed += !meets(&c, 1e-2) + !meets(&c, 1e-4) + !meets(&c, 1e-6);
    }
    assert_int_equal(missed, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tolerance_is_met_on_random_slabs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
