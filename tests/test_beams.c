/* Beams together are the beams alone, to the last bit: of the solver and of every method.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include <ppscat/ppscat.h>

enum { N_BEAMS = 11, N_TAU = 5, N_MU = 9, N_PHI = 3 };
enum { N_RADIANCES = N_TAU * N_MU * N_PHI };
static const double beams[N_BEAMS] = {0.003, 0.08, 0.2, 0.37, 0.5, 0.61,
                                      0.77,  0.9,  1,   0.98, 0.2};
static const double mus[N_MU] = {-1, -0.5, -0.11, -1e-4, 0.003, 0.3, 0.61, 0.8, 1};
static const double phis[N_PHI] = {0, 60, 200};

static void depths(double thickness, double *tau) {
    double end = isinf(thickness) ? 10 : thickness;
    for (int k = 0; k < N_TAU; k++) {
        tau[k] = end * k / (N_TAU - 1);
    }
}

typedef struct {
    pps_flux flux[N_TAU];
    double radiance[N_RADIANCES];
} answer;

static void alone(const pps_slab *slab, const pps_dom_opts *opts, double mu0,
                  answer *out) {
    double tau[N_TAU];
    pps_dom *dom;
    depths(slab->thickness, tau);
    pps_grid at = {N_TAU, N_MU, N_PHI, tau, mus, phis};
    assert_int_equal(pps_dom_create(slab, opts, &dom), PPS_OK);
    assert_int_equal(pps_dom_solve(dom, mu0), PPS_OK);
    assert_int_equal(pps_dom_flux(dom, N_TAU, tau, out->flux), PPS_OK);
    assert_int_equal(pps_dom_radiance(dom, &at, out->radiance), PPS_OK);
    pps_dom_free(dom);
}

/* The outputs of a solved solver are those of its beams alone. */
static void assert_alone(const pps_dom *dom, const pps_slab *slab,
                         const pps_dom_opts *opts, size_t n, const double *mu0) {
    static pps_flux flux[N_BEAMS * N_TAU];
    static double radiance[N_BEAMS * N_RADIANCES];
    double tau[N_TAU];
    depths(slab->thickness, tau);
    pps_grid at = {N_TAU, N_MU, N_PHI, tau, mus, phis};
    assert_int_equal(pps_dom_flux(dom, N_TAU, tau, flux), PPS_OK);
    assert_int_equal(pps_dom_radiance(dom, &at, radiance), PPS_OK);
    for (size_t b = 0; b < n; b++) {
        answer one;
        alone(slab, opts, mu0[b], &one);
        assert_memory_equal(flux + b * N_TAU, one.flux, sizeof one.flux);
        assert_memory_equal(radiance + b * N_RADIANCES, one.radiance,
                            sizeof one.radiance);
    }
}

static const pps_slab slabs[] = {{0.95, 0.5, 10}, {0.5, 0, 0.3},
                                 {1, -0.4, 1},    {0.99, 0.8, 0.05},
                                 {1, 0.5, 1000},  {0.9, 0.7, INFINITY}};
enum { N_SLABS = sizeof slabs / sizeof *slabs };

static void solver_gives_beams_together_as_alone(void **state) {
    (void)state;
    pps_dom_opts opts = {.streams = 16};
    for (int i = 0; i < N_SLABS; i++) {
        pps_dom *dom;
        assert_int_equal(pps_dom_create(&slabs[i], &opts, &dom), PPS_OK);
        for (size_t n = 1; n <= N_BEAMS; n += 5) {
            assert_int_equal(pps_dom_solve_beams(dom, n, beams), PPS_OK);
            assert_alone(dom, &slabs[i], &opts, n, beams);
        }
        pps_dom_free(dom);
    }
}

static void what_was_solved_before_leaves_no_trace(void **state) {
    (void)state;
    pps_dom_opts opts = {.streams = 8, .nodes = PPS_NODES_MAPPED};
    pps_slab slab = slabs[0];
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&slab, &opts, &dom), PPS_OK);
    assert_int_equal(pps_dom_set_directions(dom, N_MU, mus), PPS_OK);
    for (int i = 0; i < 4; i++) { /* fewer beams, other thickness, sky between */
        slab.thickness = i % 2 ? 0.2 : 3;
        assert_int_equal(pps_dom_set_thickness(dom, slab.thickness), PPS_OK);
        assert_int_equal(pps_dom_solve_beams(dom, N_BEAMS, beams), PPS_OK);
        assert_alone(dom, &slab, &opts, N_BEAMS, beams);
        assert_int_equal(pps_dom_solve_sky(dom), PPS_OK);
        assert_int_equal(pps_dom_solve_beams(dom, 2, beams + 8), PPS_OK);
        assert_alone(dom, &slab, &opts, 2, beams + 8);
        assert_int_equal(pps_dom_set_directions(dom, N_MU - (size_t)i, mus), PPS_OK);
    }
    assert_int_equal(pps_dom_set_directions(dom, 0, NULL), PPS_OK);
    pps_dom_free(dom);
}

static void bad_lists_are_refused(void **state) {
    (void)state;
    pps_dom *dom;
    const double bad[] = {0.5, 0}, bad_mu[] = {0.5, NAN};
    pps_dom_opts opts = {.streams = 4};
    assert_int_equal(pps_dom_create(&slabs[0], &opts, &dom), PPS_OK);
    assert_int_equal(pps_dom_solve_beams(dom, 0, beams), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_solve_beams(dom, 1, NULL), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_solve_beams(dom, 2, bad), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_set_directions(dom, 2, bad_mu), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_set_directions(dom, 2, NULL), PPS_ERR_ARGUMENT);
    pps_dom_free(dom);
    pps_model *model;
    assert_int_equal(pps_model_create(pps_method_find("spp"), &slabs[0], NULL, &model),
                     PPS_OK);
    assert_int_equal(pps_model_solve_beams(model, 1, 0, beams), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_model_solve_beams(model, 1, 2, bad), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_model_solve_beams(model, 1, 2, NULL), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_model_solve_beams(model, -1, 2, beams), PPS_ERR_ARGUMENT);
    pps_model_free(model);
}

/* ---- methods ---- */

enum { N_FEW = 3 };
static const double few[N_FEW] = {0.3, 1, 0.77};

static pps_model *model_of(const pps_method *method, const pps_options *opts) {
    pps_model *model;
    pps_status status = pps_model_create(method, &slabs[0], opts, &model);
    assert_int_equal(status, PPS_OK);
    return model;
}

static void assert_same_info(const pps_info *a, const pps_info *b) {
    assert_int_equal(a->streams, b->streams);
    assert_int_equal(a->orders, b->orders);
    assert_int_equal(a->nodes, b->nodes);
    assert_int_equal(a->delta_m, b->delta_m);
    assert_ptr_equal(a->used, b->used);
    assert_memory_equal(&a->error_estimate, &b->error_estimate, sizeof(double));
}

/* Radiances, then fluxes, of beams together and alone: values, status and info. */
static void check_method(const pps_method *method, const pps_options *opts) {
    pps_flux flux[N_FEW * N_TAU] = {0}, one_flux[N_TAU];
    double radiance[N_FEW * N_RADIANCES] = {0}, one[N_RADIANCES], tau[N_TAU];
    depths(1, tau);
    pps_grid at = {N_TAU, N_MU, N_PHI, tau, mus, phis};
    pps_model *together = model_of(method, opts), *alone_model = model_of(method, opts);
    pps_status status = pps_model_solve_beams(together, 1, N_FEW, few);
    if (status == PPS_OK) {
        for (int fluxes = 0; fluxes < 2; fluxes++) {
            pps_status all = fluxes ? pps_model_flux(together, N_TAU, tau, flux)
                                    : pps_model_radiance(together, &at, radiance);
            for (size_t b = 0; b < N_FEW; b++) {
                assert_int_equal(pps_model_solve(alone_model, 1, few[b]), PPS_OK);
                assert_int_equal(fluxes
                                     ? pps_model_flux(alone_model, N_TAU, tau, one_flux)
                                     : pps_model_radiance(alone_model, &at, one),
                                 all);
                if (all) {
                    continue;
                }
                if (fluxes) {
                    assert_memory_equal(flux + b * N_TAU, one_flux, sizeof one_flux);
                } else {
                    assert_memory_equal(radiance + b * N_RADIANCES, one, sizeof one);
                }
                pps_info info, one_info;
                pps_model_query_beam(together, b, &info);
                pps_model_query(alone_model, &one_info);
                assert_same_info(&info, &one_info);
            }
        }
    }
    pps_model_free(together);
    pps_model_free(alone_model);
}

static void every_method_gives_beams_together_as_alone(void **state) {
    (void)state;
    const pps_options opts = {.tolerance = 1e-2, .photons = 300};
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t m = 0; m < n; m++) {
        check_method(table[m], &opts);
    }
    const pps_options lit = {.streams = 8,
                             .light = {.beam = 1, .sky = 1, .ground = 0.3}};
    const pps_options given = {.streams = 16};
    check_method(pps_method_find("exact"), &lit);
    check_method(pps_method_find("exact"), &given);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solver_gives_beams_together_as_alone),
        cmocka_unit_test(what_was_solved_before_leaves_no_trace),
        cmocka_unit_test(bad_lists_are_refused),
        cmocka_unit_test(every_method_gives_beams_together_as_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
