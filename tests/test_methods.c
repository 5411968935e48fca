/* Every row of the table of methods: finite everywhere, right in its limits.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include <ppscat/ppscat.h>

static const double PI = 3.14159265358979323846;

enum { N_DEPTHS = 3, N_MU = 7, N_PHI = 2, N_RADIANCES = N_DEPTHS * N_MU * N_PHI };

static const double mus[N_MU] = {1, 0.5, 0.3, 1e-4, -1e-4, -0.5, -1};
static const double phis[N_PHI] = {0, 120};

/* Given streams, so that `exact` has one answer and no search; few where they cost much;
 * few photons. */
static pps_options settings_of(const char *method) {
    bool stepwise = strncmp(method, "rk", 2) == 0;
    return (pps_options){.streams = stepwise ? 4 : 16, .photons = 16};
}

/* ---- the table ---- */

static void names_are_unique_and_findable(void **state) {
    (void)state;
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    assert_true(n >= 7);
    for (size_t i = 0; i < n; i++) {
        assert_ptr_equal(pps_method_find(table[i]->name), table[i]);
        for (size_t j = 0; j < i; j++) {
            assert_string_not_equal(table[i]->name, table[j]->name);
        }
    }
}

static void unknown_names_are_not_found(void **state) {
    (void)state;
    static const char *const names[] = {"", "Exact", "spp-", "spp-refined ", "two"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_null(pps_method_find(names[i]));
    }
    assert_null(pps_method_find(NULL));
}

static void every_row_says_what_it_is(void **state) {
    (void)state;
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t i = 0; i < n; i++) {
        assert_true(strlen(table[i]->summary) > 10 && strlen(table[i]->cost) > 5);
        assert_true(strlen(table[i]->limits) > 10);
        assert_true(table[i]->fields || table[i]->fluxes);
    }
}

/* ---- one case, and all cases ---- */

typedef struct {
    const char *method;
    pps_slab slab;
    double mu0;
    double tau[N_DEPTHS]; /* top, middle, bottom; in a half-space 0, 1 and 30 */
    pps_flux flux[N_DEPTHS];
    double radiance[N_RADIANCES];
} answer;

static void set_depths(answer *a) {
    double w = a->slab.thickness;
    a->tau[0] = 0;
    a->tau[1] = isinf(w) ? 1 : w / 2;
    a->tau[2] = isinf(w) ? 30 : w;
}

/* Fluxes of a solved model, and radiances where its method has them. */
static pps_status produce(pps_model *model, answer *a) {
    pps_grid grid = {N_DEPTHS, N_MU, N_PHI, a->tau, mus, phis};
    pps_status status = pps_model_flux(model, N_DEPTHS, a->tau, a->flux);
    bool fields = pps_method_find(a->method)->fields;
    return status || !fields ? status : pps_model_radiance(model, &grid, a->radiance);
}

/* One case from nothing; the status must be good. */
static answer solve(const char *method, pps_slab slab, double mu0) {
    answer a = {.method = method, .slab = slab, .mu0 = mu0};
    pps_model *model;
    set_depths(&a);
    pps_options opts = settings_of(method);
    assert_int_equal(pps_model_create(pps_method_find(method), &slab, &opts, &model),
                     PPS_OK);
    assert_int_equal(pps_model_solve(model, slab.thickness, mu0), PPS_OK);
    assert_int_equal(produce(model, &a), PPS_OK);
    pps_model_free(model);
    return a;
}

static const double albedos[] = {0, 1e-12, 0.5, 1 - 1e-12, 1};
static const double asymmetries[] = {-0.999, -0.9, -0.5, 0, 0.5, 0.9, 0.999};
static const double thicknesses[] = {1e-9, 1e-3, 1, 50, 1e4, 1e9, INFINITY};
static const double beams[] = {1e-4, 1e-3, 0.5, 1};
enum { N_ALBEDOS = 5, N_ASYMMETRIES = 7, N_THICKNESSES = 7, N_BEAMS = 4 };

typedef void (*check)(const answer *a);

/* A refusal is an answer; anything else that is not OK is not. */
static bool refused(pps_status status) {
    assert_true(status == PPS_OK || status == PPS_ERR_INDEFINITE ||
                status == PPS_ERR_UNSUPPORTED);
    return status != PPS_OK;
}

static int check_model(pps_model *model, answer *a, check one) {
    int checked = 0;
    for (int i = 0; i < N_THICKNESSES * N_BEAMS; i++) {
        a->slab.thickness = thicknesses[i / N_BEAMS];
        a->mu0 = beams[i % N_BEAMS];
        set_depths(a);
        if (refused(pps_model_solve(model, a->slab.thickness, a->mu0)) ||
            refused(produce(model, a))) {
            continue;
        }
        one(a);
        checked++;
    }
    return checked;
}

/* Every method over every combination of the four lists. */
static void check_all_cases(int first_albedo, int end_albedo, check one) {
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t m = 0; m < n; m++) {
        pps_options opts = settings_of(table[m]->name);
        int checked = 0;
        if (strcmp(table[m]->name, "adding") == 0) {
            continue; /* up to seconds a case; test_adding.c has its limits */
        }
        for (int i = first_albedo * N_ASYMMETRIES; i < end_albedo * N_ASYMMETRIES;
             i++) {
            answer a = {.method = table[m]->name,
                        .slab = {albedos[i / N_ASYMMETRIES],
                                 asymmetries[i % N_ASYMMETRIES], 1}};
            pps_model *model;
            if (!refused(pps_model_create(table[m], &a.slab, &opts, &model))) {
                checked += check_model(model, &a, one);
                pps_model_free(model);
            }
        }
        /* Few may be refused, but by the methods that are there to fail, and by steps
         * through thick slabs. */
        int all = (end_albedo - first_albedo) * N_ASYMMETRIES * N_THICKNESSES * N_BEAMS;
        bool naive = strcmp(table[m]->name, "spp-literal") == 0 ||
                     strncmp(table[m]->name, "rk", 2) == 0;
        assert_true(naive || checked > all / 2);
    }
}

/* ---- what holds in all cases ---- */

static void assert_finite(const answer *a, const char *what, double value) {
    if (!isfinite(value)) {
        print_error("%s: albedo %.17g, g %g, thickness %g, mu0 %g: ", a->method,
                    a->slab.albedo, a->slab.g, a->slab.thickness, a->mu0);
        fail_msg("%s is %g", what, value);
    }
}

static void check_finite(const answer *a) {
    for (int k = 0; k < N_DEPTHS; k++) {
        assert_finite(a, "flux up", a->flux[k].up);
        assert_finite(a, "flux down", a->flux[k].down);
        assert_finite(a, "mean intensity", a->flux[k].mean);
    }
    for (int i = 0; i < N_RADIANCES; i++) {
        assert_finite(a, "radiance", a->radiance[i]);
    }
}

static void check_beam(const answer *a) {
    for (int k = 0; k < N_DEPTHS; k++) {
        const pps_flux *f = &a->flux[k];
        double beam = exp(-a->tau[k] / a->mu0);
        double rounding = 1e-15 * (1 + fmin(a->tau[k] / a->mu0, 750));
        assert_close(f->direct, a->mu0 * beam, rounding, 1e-300);
        assert_close(f->mean, f->mean_diffuse + beam / (4 * PI), rounding, 1e-300);
    }
}

static void check_finite_and_beam(const answer *a) {
    check_finite(a);
    check_beam(a);
}

static void all_methods_are_finite_everywhere(void **state) {
    (void)state;
    check_all_cases(0, N_ALBEDOS, check_finite_and_beam);
}

/* Nothing diffuse falls in: where a flux starts it is 0. */
static void check_dark(const answer *a) {
    for (int k = 0; k < N_DEPTHS; k++) {
        assert_close(a->flux[k].up, 0, 0, 0);
        assert_close(a->flux[k].down, 0, 0, 0);
        assert_close(a->flux[k].mean_diffuse, 0, 0, 0);
    }
    for (int i = 0; i < N_RADIANCES; i++) {
        assert_close(a->radiance[i], 0, 0, 0);
    }
}

static void no_scattering_leaves_no_diffuse_light(void **state) {
    (void)state;
    check_all_cases(0, 1, check_dark);
}

/* ---- limits ---- */

/* To first order in albedo the marched methods are single scattering. */
static void weak_scattering_is_single_scattering(void **state) {
    (void)state;
    static const char *const marched[] = {"spp-refined", "eddington", "exact"};
    static const double g[] = {-0.9, 0, 0.5, 0.9}, w[] = {1e-3, 1}, mu0[] = {0.5, 1};
    for (int i = 0; i < 3 * 4 * 2 * 2; i++) {
        pps_slab weak = {1e-9, g[i / 3 % 4], w[i / 12 % 2]}, full = weak;
        full.albedo = 1;
        answer got = solve(marched[i % 3], weak, mu0[i / 24]);
        answer want = solve("single", full, mu0[i / 24]);
        for (int k = 0; k < N_RADIANCES; k++) {
            assert_close(got.radiance[k] / weak.albedo, want.radiance[k], 1e-6, 0);
        }
    }
}

/* `single` is linear in albedo. */
static void single_scattering_is_proportional_to_albedo(void **state) {
    (void)state;
    answer half = solve("single", (pps_slab){0.5, 0.7, 2}, 0.3);
    answer full = solve("single", (pps_slab){1, 0.7, 2}, 0.3);
    for (int i = 0; i < N_RADIANCES; i++) {
        assert_close(2 * half.radiance[i], full.radiance[i], 1e-15, 0);
    }
    for (int k = 0; k < N_DEPTHS; k++) {
        assert_close(2 * half.flux[k].up, full.flux[k].up, 1e-15, 0);
        assert_close(2 * half.flux[k].down, full.flux[k].down, 1e-15, 0);
    }
}

/* What comes out at albedo 1 is what the beam lost: -mu0 expm1(-w/mu0). */
static void conservative_slabs_return_all_energy(void **state) {
    (void)state;
    static const char *const conserving[] = {"spp", "hemispheric", "eddington"};
    for (int i = 0; i < N_ASYMMETRIES * (N_THICKNESSES - 1) * N_BEAMS; i++) {
        double w = thicknesses[i / N_BEAMS / N_ASYMMETRIES], mu0 = beams[i % N_BEAMS];
        pps_slab slab = {1, asymmetries[i / N_BEAMS % N_ASYMMETRIES], w};
        for (int m = 0; m < 3; m++) {
            answer a = solve(conserving[m], slab, mu0);
            assert_close(a.flux[0].up + a.flux[2].down, -mu0 * expm1(-w / mu0), 1e-12,
                         0);
        }
    }
}

static void conservative_half_spaces_return_all_energy(void **state) {
    (void)state;
    static const char *const conserving[] = {"spp", "hemispheric", "eddington",
                                             "exact"};
    static const double g[] = {-0.5, 0, 0.5};
    for (int i = 0; i < 3 * N_BEAMS; i++) {
        pps_slab slab = {1, g[i % 3], INFINITY};
        for (int m = 0; m < 4; m++) {
            answer a = solve(conserving[m], slab, beams[i / 3]);
            assert_close(a.flux[0].up, beams[i / 3], 1e-12, 0);
        }
    }
}

/* ---- resonance: 1/mu0 is a diffusion exponent, or mu = mu0 ---- */

/* f(mu0) lies between its neighbours to second order in the step, of which the beam
 * takes (step tau/mu0)^2 and the sine of its angle step^2/sine^3. */
static void assert_smooth(const char *method, pps_slab slab, double mu0) {
    const double step = 1e-7, sine = sqrt(1 - mu0 * mu0);
    double bend = step * step / (sine * sine * sine);
    answer at = solve(method, slab, mu0);
    answer below = solve(method, slab, mu0 * (1 - step));
    answer above = solve(method, slab, mu0 * (1 + step));
    for (int i = 0; i < N_RADIANCES; i++) {
        int k = i / (N_MU * N_PHI);
        double change = step * at.tau[k] / mu0, bound = 1e-12 + bend + change * change;
        double mean = (below.flux[k].mean + above.flux[k].mean) / 2;
        double up = (below.flux[k].up + above.flux[k].up) / 2;
        double radiance = (below.radiance[i] + above.radiance[i]) / 2;
        assert_close(at.flux[k].mean, mean, bound, 0);
        assert_close(at.flux[k].up, up, bound, 1e-15);
        assert_close(at.radiance[i], radiance, bound, 1e-15);
    }
}

static void two_streams_are_smooth_on_resonance(void **state) {
    (void)state;
    static const double w[] = {0.3, 3, 30, INFINITY};
    for (int i = 0; i < 4; i++) {
        /* Isotropic: k = 2 sqrt(1 - albedo) and sqrt(3 (1 - albedo)). */
        assert_smooth("hemispheric", (pps_slab){0.5, 0, w[i]}, sqrt(0.5));
        assert_smooth("eddington", (pps_slab){0.5, 0, w[i]}, 1 / sqrt(1.5));
        /* g = 1/2: e f = 2 (1 - albedo) 3/2 (1 - albedo g). */
        assert_smooth("eddington", (pps_slab){0.5, 0.5, w[i]}, 1 / sqrt(1.125));
    }
}

static void refined_spp_is_smooth_where_the_view_resonates(void **state) {
    (void)state;
    /* 0.3 of mus is the beam's own direction, 0.5 and -0.5 are 1/lambda. */
    static const double w[] = {0.3, 3, 30, INFINITY};
    for (int i = 0; i < 4; i++) {
        assert_smooth("spp-refined", (pps_slab){0.9, 0.5, w[i]}, 0.3);
        assert_smooth("single", (pps_slab){0.9, 0.5, w[i]}, 0.3);
        assert_smooth("spp-refined", (pps_slab){0.75, 0, w[i]}, 0.25);
        assert_smooth("spp", (pps_slab){0.75, 0, w[i]}, 0.25);
    }
}

static void exact_is_smooth_on_every_resonance_of_its_modes(void **state) {
    (void)state;
    enum { N = 8 };
    pps_slab slab = {0.9, 0.5, 2};
    pps_dom_opts opts = {.streams = 2 * N};
    pps_dom *dom;
    double k[N], node[N], weight[N];
    assert_int_equal(pps_dom_create(&slab, &opts, &dom), PPS_OK);
    pps_dom_info info;
    pps_dom_query(dom, &info);
    pps_dom_eigenvalues(dom, 0, k);
    pps_dom_nodes(dom, node, weight);
    pps_dom_free(dom);
    double stretch = info.diffusion_exponent / k[0]; /* k is per scaled depth */
    for (int j = 0; j < N; j++) {
        if (k[j] * stretch > 1) {
            assert_smooth("exact", slab, 1 / (k[j] * stretch));
        }
        assert_smooth("exact", slab, node[j]);
    }
}

/* ---- what a model remembers ---- */

static void a_model_gives_the_same_answer_in_any_order(void **state) {
    (void)state;
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    pps_slab slab = {0.8, 0.4, 1};
    for (size_t m = 0; m < n; m++) {
        if (strcmp(table[m]->name, "rk-shooting") == 0) {
            continue; /* refuses directions as flat as these */
        }
        answer fresh = solve(table[m]->name, slab, 0.6), again = fresh;
        pps_options opts = settings_of(table[m]->name);
        pps_model *model;
        pps_model_create(table[m], &slab, &opts, &model);
        pps_model_solve(model, 7, 0.2);
        again.tau[2] = 7;
        assert_int_equal(produce(model, &again), PPS_OK);
        set_depths(&again);
        pps_model_solve(model, slab.thickness, 0.6);
        assert_int_equal(produce(model, &again), PPS_OK);
        pps_model_free(model);
        assert_memory_equal(again.flux, fresh.flux, sizeof fresh.flux);
        assert_memory_equal(again.radiance, fresh.radiance, sizeof fresh.radiance);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_unique_and_findable),
        cmocka_unit_test(unknown_names_are_not_found),
        cmocka_unit_test(every_row_says_what_it_is),
        cmocka_unit_test(all_methods_are_finite_everywhere),
        cmocka_unit_test(no_scattering_leaves_no_diffuse_light),
        cmocka_unit_test(weak_scattering_is_single_scattering),
        cmocka_unit_test(single_scattering_is_proportional_to_albedo),
        cmocka_unit_test(conservative_slabs_return_all_energy),
        cmocka_unit_test(conservative_half_spaces_return_all_energy),
        cmocka_unit_test(two_streams_are_smooth_on_resonance),
        cmocka_unit_test(refined_spp_is_smooth_where_the_view_resonates),
        cmocka_unit_test(exact_is_smooth_on_every_resonance_of_its_modes),
        cmocka_unit_test(a_model_gives_the_same_answer_in_any_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
