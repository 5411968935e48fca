/* The closed forms: SPP against its own equations and against the paper's quotients (which
 * decides the misprints), its refinement against numerical ray marching, the two-streams
 * against published coefficients solved in 40 digits.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/dom.h>
#include <ppscat/method.h>
#include <ppscat/phase.h>
#include <ppscat/spp.h>

#include "core/quadrature.h"
#include "spp/march.h"
#include "spp/twostream.h"
#include "support/support.h"

static const double PI = 3.14159265358979323846;

static const double albedos[] = {0, 1e-6, 0.3, 0.9, 1 - 1e-9, 1};
static const double gs[] = {0, 0.5, 0.99, -0.5, -0.99};
static const double thicknesses[] = {1e-3, 1, 10, 300};
static const double mu0s[] = {0.05, 0.5, 1};
enum { N_CASES = 6 * 5 * 4 * 3 };

static pps_slab slab_of(int i) {
    return (pps_slab){albedos[i % 6], gs[i / 6 % 5], thicknesses[i / 30 % 4]};
}
static double mu0_of(int i) { return mu0s[i / 120]; }

static pps_spp solved(int i, pps_spp_kappa kappa) {
    pps_slab slab = slab_of(i);
    pps_spp spp;
    assert_int_equal(pps_spp_init(&spp, &slab, mu0_of(i), kappa), PPS_OK);
    return spp;
}

/* What Eqs. 11 and 12 leave over, relative to their largest term, for the total downward
 * amplitude D + e^(-q tau); fourth-order differences of D and U. */
static double residual(const pps_spp *spp, double tau) {
    double h = 2e-3 * fmin(fmin(tau, spp->thickness - tau), 1 / spp->q);
    double down[5], up[5], mu0 = 1 / spp->q, beam = exp(-spp->q * tau);
    for (int s = -2; s <= 2; s++) {
        down[s + 2] = pps_spp_down(spp, tau + s * h);
        up[s + 2] = pps_spp_up(spp, tau + s * h);
    }
    double d_down = (down[0] - 8 * down[1] + 8 * down[3] - down[4]) / (12 * h);
    double d_up = (up[0] - 8 * up[1] + 8 * up[3] - up[4]) / (12 * h);
    double total = down[2] + beam, a = spp->albedo, t = spp->forward, r = spp->backward;
    double eq11 = mu0 * d_down + down[2] - a * (t * total + r * up[2]);
    double eq12 = -mu0 * d_up + up[2] - a * (r * total + t * up[2]);
    return fmax(fabs(eq11), fabs(eq12)) / fmax(fabs(total), fabs(up[2]));
}

static void spp_satisfies_equations_11_and_12(void **state) {
    (void)state;
    static const double share[] = {0.01, 0.3, 0.9};
    for (int i = 0; i < N_CASES; i++) {
        pps_spp spp = solved(i, PPS_SPP_CONSISTENT);
        for (int k = 0; k < 3; k++) {
            double tau = share[k] * spp.thickness;
            if (spp.lambda * tau < 500) { /* else below the smallest double */
                assert_true(residual(&spp, tau) < 1e-10);
            }
        }
    }
}

static void kappa_as_printed_does_not_satisfy_equation_11(void **state) {
    (void)state;
    pps_slab slab = {0.9, 0, 10};
    pps_spp spp;
    assert_int_equal(pps_spp_init(&spp, &slab, 0.5, PPS_SPP_PRINTED), PPS_OK);
    assert_true(residual(&spp, 0.3) > 0.1);
}

static void spp_satisfies_the_boundary_conditions_21(void **state) {
    (void)state;
    for (int i = 0; i < N_CASES; i++) {
        pps_spp spp = solved(i, PPS_SPP_CONSISTENT);
        assert_true(pps_spp_down(&spp, 0) == 0);
        assert_true(pps_spp_up(&spp, spp.thickness) == 0);
    }
}

/* Eqs. 17, 19-22 in their own shape with the misprints mended: third term
 * c3 (U+ + alpha U-), c3 = + c2 E1/(alpha^2 E3 - E1), beam along the slant. */
static void spp_equals_the_papers_quotients(void **state) {
    (void)state;
    uint64_t seed = 1;
    for (int i = 0; i < 1200; i++) {
        pps_slab slab = {0.05 + 0.94 * support_random(&seed),
                         1.8 * support_random(&seed) - 0.9,
                         0.1 + 10 * support_random(&seed)};
        double mu0 = 0.2 + 0.8 * support_random(&seed), a = slab.albedo;
        double tau = slab.thickness * support_random(&seed), w = slab.thickness;
        pps_spp spp;
        assert_int_equal(pps_spp_init(&spp, &slab, mu0, PPS_SPP_CONSISTENT), PPS_OK);
        double r = spp.backward, t = 1 - r,
               lambda = sqrt((1 - a * (t - r)) * (1 - a)) / mu0;
        double alpha = a * r / (1 - a * t - lambda * mu0);
        double e1 = exp(-lambda * w), e3 = exp(lambda * w);
        double c2 = -1, den = alpha * alpha * e3 - e1;
        double c1 = -alpha * e3 * c2 / den, c3 = c2 * e1 / den;
        double down = c1 * alpha * exp(-lambda * tau) + c2 * exp(-tau / mu0) +
                      c3 * exp(lambda * tau);
        double up = c1 * exp(-lambda * tau) + c3 * alpha * exp(lambda * tau);
        assert_close(pps_spp_down(&spp, tau), down, 1e-9, 1e-11);
        assert_close(pps_spp_up(&spp, tau), up, 1e-9, 1e-11);
    }
}

static void conservative_spp_keeps_its_net_flux(void **state) {
    (void)state;
    for (int i = 5; i < N_CASES; i += 6) {
        pps_spp spp = solved(i, PPS_SPP_CONSISTENT);
        double w = spp.thickness, net = pps_spp_down(&spp, w) + exp(-spp.q * w);
        for (int k = 0; k <= 4; k++) {
            double tau = k * w / 4;
            double here =
                pps_spp_down(&spp, tau) + exp(-spp.q * tau) - pps_spp_up(&spp, tau);
            assert_close(here, net, 0, 2e-15);
        }
    }
}

static void spp_is_first_order_in_a_small_albedo(void **state) {
    (void)state;
    pps_slab slab = {1e-12, 0.4, 2};
    double mu0 = 0.5, tau = 0.7;
    pps_spp spp;
    assert_int_equal(pps_spp_init(&spp, &slab, mu0, PPS_SPP_CONSISTENT), PPS_OK);
    /* dD/dtau + q D = q albedo T e^(-q tau) to first order. */
    double want = slab.albedo * spp.forward * tau / mu0 * exp(-tau / mu0);
    assert_close(pps_spp_down(&spp, tau), want, 1e-11, 0);
}

static void thick_spp_is_a_half_space(void **state) {
    (void)state;
    for (int i = 0; i < 6 * 5; i++) {
        pps_slab slab = {albedos[i % 6], gs[i / 6], 1e12};
        pps_spp thick, half;
        pps_spp_init(&thick, &slab, 0.7, PPS_SPP_CONSISTENT);
        slab.thickness = (double)INFINITY;
        pps_spp_init(&half, &slab, 0.7, PPS_SPP_CONSISTENT);
        for (double tau = 0; tau < 20; tau += 1.3) {
            assert_close(pps_spp_down(&half, tau), pps_spp_down(&thick, tau), 1e-9,
                         1e-300);
            assert_close(pps_spp_up(&half, tau), pps_spp_up(&thick, tau), 1e-9, 1e-300);
        }
    }
}

/* A Gauss rule on (0, run) with nodes dense at both ends: s = run y^2 (3 - 2 y). Node i of
 * panels * POINTS; returns s and its weight. */
enum { POINTS = 16 };
typedef struct {
    double x[POINTS], w[POINTS];
} gauss_rule;

static double graded_node(const gauss_rule *rule, int i, int panels, double run,
                          double *weight) {
    double y = (i / POINTS + rule->x[i % POINTS]) / panels;
    *weight = rule->w[i % POINTS] * 6 * run * y * (1 - y) / panels;
    return run * y * y * (3 - 2 * y);
}

/* int J(t) e^(-c |tau - t|) c dt from the edge where the ray enters. */
static double march_numerically(const pps_spp *spp, double g, double tau, double mu,
                                double phi) {
    enum { PANELS = 300 };
    double sum = 0, c = 1 / fabs(mu), run = mu > 0 ? tau : spp->thickness - tau;
    double r = pps_hg_backward(g, fabs(mu)) / (2 * PI), f = 1 / (2 * PI) - r;
    double p = pps_hg(g, pps_cos_scattering(1 / spp->q, mu, phi));
    gauss_rule rule;
    pps_gauss_unit(POINTS, rule.x, rule.w);
    for (int i = 0; i < PANELS * POINTS; i++) {
        double weight, s = graded_node(&rule, i, PANELS, run, &weight);
        double t = mu > 0 ? tau - s : tau + s;
        double d = pps_spp_down(spp, t), u = pps_spp_up(spp, t);
        double source = mu > 0 ? f * d + r * u : r * d + f * u;
        source += p * exp(-spp->q * t);
        sum += weight * c * exp(-c * s) * source;
    }
    return spp->albedo * sum;
}

static void refined_spp_is_spp_marched_along_the_ray(void **state) {
    (void)state;
    static const double mus[] = {-1, -0.4, -0.03, 0.03, 0.5, 1};
    const pps_method *refined = pps_method_find("spp-refined");
    for (int i = 0; i < N_CASES; i += 7) {
        pps_slab slab = slab_of(i);
        pps_spp spp = solved(i, PPS_SPP_CONSISTENT);
        double tau[3] = {0.02 * slab.thickness, 0.5 * slab.thickness, slab.thickness};
        double phi = 60, radiance[18];
        pps_grid at = {3, 6, 1, tau, mus, &phi};
        pps_model *model;
        assert_int_equal(pps_model_create(refined, &slab, NULL, &model), PPS_OK);
        assert_int_equal(pps_model_solve(model, slab.thickness, mu0_of(i)), PPS_OK);
        assert_int_equal(pps_model_radiance(model, &at, radiance), PPS_OK);
        for (int k = 0; k < 18; k++) {
            double want = march_numerically(&spp, slab.g, tau[k / 6], mus[k % 6], phi);
            assert_close(radiance[k], want, 1e-10, 1e-200);
        }
        pps_model_free(model);
    }
}

/* An isotropic source taken from the exact solution, integrated numerically: what ray
 * marching makes of it is the exact radiance. */
typedef struct {
    const pps_dom *dom;
    double w;
} exact_source;

static void exact_terms(const void *solution, const pps_ray *ray, double term[2]) {
    enum { PANELS = 12 };
    const exact_source *e = solution;
    double sum = 0, run = ray->down ? ray->tau : ray->x;
    gauss_rule rule;
    pps_gauss_unit(POINTS, rule.x, rule.w);
    for (int i = 0; i < PANELS * POINTS; i++) {
        double weight, s = graded_node(&rule, i, PANELS, run, &weight);
        double tau = ray->down ? ray->tau - s : ray->tau + s;
        pps_flux flux;
        assert_int_equal(pps_dom_flux(e->dom, 1, &tau, &flux), PPS_OK);
        sum += weight * ray->c * exp(-ray->c * s) * flux.mean_diffuse;
    }
    term[0] = sum;
    term[1] = 0;
}

static void all_to_the_first(const void *solution, double mu, double share[2]) {
    (void)solution;
    (void)mu;
    share[0] = 1;
    share[1] = 0;
}

static void marching_an_exact_source_gives_the_exact_radiance(void **state) {
    (void)state;
    pps_slab slab = {0.95, 0, 4};
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&slab, &(pps_dom_opts){.streams = 128}, &dom),
                     PPS_OK);
    assert_int_equal(pps_dom_solve(dom, 0.6), PPS_OK);
    static const double mus[] = {-1, -0.5, -0.2, 0.2, 0.5, 1};
    double tau[3] = {0.5, 2, 3.9}, phi = 0, marched[18], exact[18];
    pps_grid at = {3, 6, 1, tau, mus, &phi};
    exact_source source = {dom, 4};
    pps_march march = {.slab = slab,
                       .mu0 = 0.6,
                       .shares = all_to_the_first,
                       .terms = exact_terms,
                       .solution = &source};
    pps_march_radiance(&march, &at, marched);
    assert_int_equal(pps_dom_radiance(dom, &at, exact), PPS_OK);
    for (int i = 0; i < 18; i++) {
        assert_close(marched[i], exact[i], 1e-10, 0);
    }
    pps_dom_free(dom);
}

/* Columns: scheme, delta, omega, g, w, mu0, R, Tdif, .. The first 300 rows are the
 * Eddington scheme without delta scaling. */
static void eddington_fluxes_match_the_published_scheme(void **state) {
    (void)state;
    support_table t = support_read("twostream_values.csv");
    for (size_t i = 0; i < 300; i++) {
        const double *row = t.value + i * t.n_columns;
        double a = row[2], g = row[3], w = row[4], mu0 = row[5];
        assert_true(row[1] == 0);
        pps_twostream two;
        pps_twostream_solve(&two, w, mu0, 2 * (1 - a), 1.5 * (1 - a * g), a,
                            1.5 * a * g * mu0);
        assert_close(pps_twostream_flux(&two, 0).up / mu0, row[6], 1e-12, 1e-15);
        assert_close(pps_twostream_flux(&two, w).down / mu0, row[7], 1e-12, 1e-15);
    }
    support_table_free(&t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spp_satisfies_equations_11_and_12),
        cmocka_unit_test(kappa_as_printed_does_not_satisfy_equation_11),
        cmocka_unit_test(spp_satisfies_the_boundary_conditions_21),
        cmocka_unit_test(spp_equals_the_papers_quotients),
        cmocka_unit_test(conservative_spp_keeps_its_net_flux),
        cmocka_unit_test(spp_is_first_order_in_a_small_albedo),
        cmocka_unit_test(thick_spp_is_a_half_space),
        cmocka_unit_test(refined_spp_is_spp_marched_along_the_ray),
        cmocka_unit_test(marching_an_exact_source_gives_the_exact_radiance),
        cmocka_unit_test(eddington_fluxes_match_the_published_scheme),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
