/* Discrete ordinates: what is true by identity, in every regime.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/dom.h>
#include <ppscat/phase.h>

#include "support/support.h"

static const double PI = 3.14159265358979323846;

static pps_dom *solve(pps_slab slab, pps_dom_opts opts, double mu0) {
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&slab, &opts, &dom), PPS_OK);
    assert_int_equal(pps_dom_solve(dom, mu0), PPS_OK);
    return dom;
}

/* |R + T + expm1(-w/mu0)| <= 1e-12 (1 - e^(-w/mu0)), on every kind of nodes and with any
 * number of streams: what conserves energy is the scheme, not its convergence. */
static void conservative_slab_returns_all_energy(void **state) {
    (void)state;
    static const double mu0s[] = {0.001, 0.03, 0.5, 1}, gs[] = {0, 0.5, 0.9, -0.5};
    static const struct {
        pps_nodes nodes;
        pps_delta_m delta_m;
    } kinds[] = {{PPS_NODES_GAUSS, PPS_DELTA_M_AUTO},
                 {PPS_NODES_GAUSS, PPS_DELTA_M_OFF},
                 {PPS_NODES_MAPPED, PPS_DELTA_M_AUTO},
                 {PPS_NODES_GRADED, PPS_DELTA_M_AUTO}};
    for (double w = 1e-6; w < 2e6; w *= 10) {
        for (int i = 0; i < 4 * 4 * 4 * 2; i++) {
            double g = gs[i % 4], mu0 = mu0s[i / 4 % 4], tau[2] = {0, w};
            int kind = i / 16 % 4, streams = i / 64 ? 48 : 8;
            if (kind == 1 && g == 0.9) {
                continue; /* indefinite without scaling */
            }
            pps_dom_opts opts = {streams, kinds[kind].nodes, kinds[kind].delta_m, 1, 0};
            pps_dom *dom = solve((pps_slab){1, g, w}, opts, mu0);
            pps_flux flux[2];
            assert_int_equal(pps_dom_flux(dom, 2, tau, flux), PPS_OK);
            double scattered = -expm1(-w / mu0);
            assert_close((flux[0].up + flux[1].down) / mu0, scattered, 1e-12, 0);
            pps_dom_free(dom);
        }
    }
}

static void conservative_net_flux_is_the_same_at_every_depth(void **state) {
    (void)state;
    static const double ws[] = {1, 30, 1e4};
    for (int i = 0; i < 3; i++) {
        double w = ws[i], tau[5] = {0, 0.1 * w, 0.4 * w, 0.9 * w, w};
        pps_dom *dom = solve((pps_slab){1, 0.5, w}, (pps_dom_opts){.streams = 32}, 0.6);
        pps_flux flux[5];
        assert_int_equal(pps_dom_flux(dom, 5, tau, flux), PPS_OK);
        double net = flux[4].down + flux[4].direct;
        for (int k = 0; k < 5; k++) {
            assert_close(flux[k].down + flux[k].direct - flux[k].up, net, 0, 2e-15);
        }
        pps_dom_free(dom);
    }
}

/* I(0, -mu; mu0) mu = I(0, -mu0; mu) mu0 for the diffuse reflection, and likewise for the
 * transmission, at every relative azimuth; also where the aureole is corrected. */
static void reflection_and_transmission_are_reciprocal(void **state) {
    (void)state;
    static const double pairs[][2] = {
        {0.9, 0.2}, {0.5, 0.5001}, {1, 0.01}, {0.33, 0.8}};
    static const double phis[] = {0, 35, 90, 180};
    static const struct {
        double g;
        pps_dom_opts opts;
    } kinds[] = {{0.6, {.streams = 24, .nodes = PPS_NODES_GAUSS}},
                 {0.6, {.streams = 24, .nodes = PPS_NODES_MAPPED}},
                 {0.85, {.streams = 8, .nodes = PPS_NODES_GAUSS}}};
    for (int i = 0; i < 4 * 3; i++) {
        const double *pair = pairs[i / 3];
        double field[2][4 * 4], tau[2] = {0, 2};
        pps_slab slab = {0.97, kinds[i % 3].g, 2};
        for (int swap = 0; swap < 2; swap++) {
            double mu = pair[1 - swap], mus[2] = {-mu, mu};
            pps_dom *dom = solve(slab, kinds[i % 3].opts, pair[swap]);
            pps_grid at = {2, 2, 4, tau, mus, phis};
            assert_int_equal(pps_dom_radiance(dom, &at, field[swap]), PPS_OK);
            pps_dom_free(dom);
        }
        for (int p = 0; p < 4; p++) {
            assert_close(field[0][p] * pair[1], field[1][p] * pair[0], 1e-12, 0);
            assert_close(field[0][12 + p] * pair[1], field[1][12 + p] * pair[0], 1e-12,
                         0);
        }
    }
}

/* Radiances downwards in the plane of the sun, about it and opposite: root mean square of
 * a few streams' error over the mean, at mid-depth. */
static double sunward_error(double g, double w, double mu0, int streams) {
    enum { N = 20 };
    double mu[N], value[2][N * 2], phis[2] = {0, 180}, tau = w / 2;
    for (int j = 0; j < N; j++) {
        mu[j] = (j + 0.5) / N;
    }
    pps_grid at = {1, N, 2, &tau, mu, phis};
    for (int fine = 0; fine < 2; fine++) {
        pps_dom *dom = solve(
            (pps_slab){0.95, g, w},
            (pps_dom_opts){.streams = fine ? 128 : streams, .tolerance = 1e-8}, mu0);
        assert_int_equal(pps_dom_radiance(dom, &at, value[fine]), PPS_OK);
        pps_dom_free(dom);
    }
    double square = 0, mean = 0;
    for (int i = 0; i < N * 2; i++) {
        square += pow(value[0][i] - value[1][i], 2) / (N * 2);
        mean += value[1][i] / (N * 2);
    }
    return sqrt(square) / mean;
}

/* With TMS alone these are three to twenty times as large. */
static void few_streams_have_the_aureole(void **state) {
    (void)state;
    static const struct {
        double g, w, mu0;
        int streams;
        double most;
    } cases[] = {
        {0.8, 1, 0.9, 8, 5e-3},  {0.8, 10, 0.9, 8, 0.015}, {0.9, 10, 0.9, 8, 0.3},
        {0.8, 10, 0.5, 8, 0.01}, {0.9, 10, 0.9, 16, 0.02}, {0.8, 10, 0.9, 4, 0.15},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double error =
            sunward_error(cases[i].g, cases[i].w, cases[i].mu0, cases[i].streams);
        print_message("g %g, thickness %g, mu0 %g, %d streams: %.2e\n", cases[i].g,
                      cases[i].w, cases[i].mu0, cases[i].streams, error);
        assert_true(error <= cases[i].most);
    }
}

/* Fluxes and mean intensity are the quadrature sums of the azimuthally averaged radiance
 * at the nodes, which the ray integrals give independently of the flux formulas. */
static void fluxes_are_sums_of_radiances_at_the_nodes(void **state) {
    (void)state;
    double mu[8], weight[8], both[16], radiance[16 * 2], phis[2] = {0, 180};
    static const double ws[] = {1e-3, 0.5, 6, 1e5};
    for (int i = 0; i < 4; i++) {
        double tau = 0.37 * ws[i];
        pps_dom *dom =
            solve((pps_slab){0.99, 0, ws[i]},
                  (pps_dom_opts){.streams = 16, .delta_m = PPS_DELTA_M_OFF}, 0.4);
        pps_dom_nodes(dom, mu, weight);
        for (int j = 0; j < 8; j++) {
            both[j] = mu[j];
            both[8 + j] = -mu[j];
        }
        pps_grid at = {1, 16, 2, &tau, both, phis}; /* g = 0: no azimuth in it */
        assert_int_equal(pps_dom_radiance(dom, &at, radiance), PPS_OK);
        double down = 0, up = 0, mean = 0;
        for (int j = 0; j < 8; j++) {
            down += 2 * PI * weight[j] * mu[j] * radiance[2 * j];
            up += 2 * PI * weight[j] * mu[j] * radiance[16 + 2 * j];
            mean += weight[j] * (radiance[2 * j] + radiance[16 + 2 * j]) / 2;
        }
        pps_flux flux;
        assert_int_equal(pps_dom_flux(dom, 1, &tau, &flux), PPS_OK);
        assert_close(down, flux.down, 1e-13, 0);
        assert_close(up, flux.up, 1e-13, 0);
        assert_close(mean, flux.mean_diffuse, 1e-13, 0);
        pps_dom_free(dom);
    }
}

/* The equation of transfer itself, mu dI/dtau = -I + J, with J from the radiance in 4,000
 * directions... is what the integral form solves; here its derivative at mid-depth: the
 * diffuse net flux loses what is absorbed, dF/dtau = -(1 - albedo) 4 pi mean + source. */
static void net_flux_loses_what_is_absorbed(void **state) {
    (void)state;
    double albedo = 0.8, mu0 = 0.7, h = 1e-3;
    double tau[5] = {1 - 2 * h, 1 - h, 1, 1 + h, 1 + 2 * h};
    pps_dom *dom =
        solve((pps_slab){albedo, 0.6, 3}, (pps_dom_opts){.streams = 24}, mu0);
    pps_flux f[5];
    double net[5];
    assert_int_equal(pps_dom_flux(dom, 5, tau, f), PPS_OK);
    for (int k = 0; k < 5; k++) {
        net[k] = f[k].down - f[k].up + f[k].direct;
    }
    double slope = (net[0] - 8 * net[1] + 8 * net[3] - net[4]) / (12 * h);
    assert_close(slope, -(1 - albedo) * 4 * PI * f[2].mean, 1e-10, 0);
    pps_dom_free(dom);
}

/* Just inside an edge the flux that starts there is tau times the source, to all digits,
 * not 0 and not noise. */
static void flux_next_to_an_edge_keeps_its_digits(void **state) {
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        double tau[4] = {1e-9, 2e-9, 5 - 2e-9, 5 - 1e-9};
        pps_dom_opts opts = {.streams = 16,
                             .nodes = kind ? PPS_NODES_MAPPED : PPS_NODES_GAUSS};
        pps_dom *dom = solve((pps_slab){0.9, -0.3, 5}, opts, 0.5);
        pps_flux f[4];
        assert_int_equal(pps_dom_flux(dom, 4, tau, f), PPS_OK);
        assert_close(f[1].down / f[0].down, 2, 2e-8, 0);
        assert_close(f[2].up / f[3].up, (5 - tau[2]) / (5 - tau[3]), 2e-8, 0);
        pps_dom_free(dom);
    }
}

static void nothing_diffuse_falls_in(void **state) {
    (void)state;
    double tau[2] = {0, 4}, mus[4] = {-0.7, -0.02, 0.02, 0.7}, phi = 10, radiance[8];
    pps_dom *dom = solve((pps_slab){0.9, 0.8, 4}, (pps_dom_opts){.streams = 16}, 0.5);
    pps_grid at = {2, 4, 1, tau, mus, &phi};
    pps_flux f[2];
    assert_int_equal(pps_dom_radiance(dom, &at, radiance), PPS_OK);
    assert_int_equal(pps_dom_flux(dom, 2, tau, f), PPS_OK);
    assert_true(radiance[2] == 0 && radiance[3] == 0);
    assert_true(radiance[4] == 0 && radiance[5] == 0);
    assert_true(f[1].up == 0);
    /* Down at the top: delta-M's forward peak has had no way to go either. */
    assert_true(f[0].down == 0);
    pps_dom_free(dom);
}

/* As albedo -> 0 only single scattering is left. */
static void faint_scattering_is_single_scattering(void **state) {
    (void)state;
    double tau = 0.3, mu = -0.6, phi = 70, radiance, mu0 = 0.8, w = 2;
    pps_grid at = {1, 1, 1, &tau, &mu, &phi};
    double q = 1 / mu0, c = -1 / mu;
    double beam = c * (exp(-q * tau) - exp(-q * w - c * (w - tau))) / (q + c);
    double want = pps_hg(0.7, pps_cos_scattering(mu0, mu, phi)) * beam;
    static const double albedos[] = {1e-4, 1e-8, 1e-200};
    for (int i = 0; i < 3; i++) {
        double albedo = albedos[i];
        pps_dom *dom =
            solve((pps_slab){albedo, 0.7, w}, (pps_dom_opts){.streams = 32}, mu0);
        assert_int_equal(pps_dom_radiance(dom, &at, &radiance), PPS_OK);
        /* g^32 = 1e-5 of it is scaled away by delta-M: first order in albedo. */
        assert_close(radiance / albedo, want, 2 * albedo, 1e-15);
        pps_dom_free(dom);
    }
    pps_dom *dom = solve((pps_slab){0, 0.7, w}, (pps_dom_opts){.streams = 32}, mu0);
    pps_flux f;
    assert_int_equal(pps_dom_radiance(dom, &at, &radiance), PPS_OK);
    assert_int_equal(pps_dom_flux(dom, 1, &tau, &f), PPS_OK);
    assert_true(radiance == 0 && f.up == 0 && f.down == 0 && f.mean_diffuse == 0);
    pps_dom_free(dom);
}

/* A very thick slab is a half-space from above. */
static void thick_slab_is_a_half_space(void **state) {
    (void)state;
    double tau[3] = {0, 1, 7}, mus[3] = {-1, -0.1, 0.3}, phi = 0, thick[9], half[9];
    pps_grid at = {3, 3, 1, tau, mus, &phi};
    pps_dom *dom = solve((pps_slab){0.9, 0.5, 1e9}, (pps_dom_opts){.streams = 16}, 0.5);
    assert_int_equal(pps_dom_radiance(dom, &at, thick), PPS_OK);
    assert_int_equal(pps_dom_set_thickness(dom, (double)INFINITY), PPS_OK);
    assert_int_equal(pps_dom_solve(dom, 0.5), PPS_OK);
    assert_int_equal(pps_dom_radiance(dom, &at, half), PPS_OK);
    for (int i = 0; i < 9; i++) {
        assert_close(thick[i], half[i], 1e-14, 0);
    }
    pps_dom_free(dom);
}

/* Answers do not jump where the solver changes its formulas: k w = 1, w/mu0 = 2. */
static void answers_are_continuous_in_thickness(void **state) {
    (void)state;
    double k[8], mu0 = 0.6, mus[2] = {-0.4, 0.4}, phi = 0;
    pps_slab slab = {0.9, 0.5, 1};
    pps_dom_opts opts = {.streams = 16, .delta_m = PPS_DELTA_M_OFF};
    pps_dom *dom = solve(slab, opts, mu0);
    pps_dom_eigenvalues(dom, 0, k);
    for (int j = 0; j < 9; j++) {
        double w = j < 8 ? 1 / k[j] : 2 * mu0, radiance[2][4];
        for (int side = 0; side < 2; side++) {
            double at_w = w * (1 + (side ? 1e-13 : -1e-13)), tau[2] = {0, 0.5 * at_w};
            pps_grid at = {2, 2, 1, tau, mus, &phi};
            pps_dom_set_thickness(dom, at_w);
            pps_dom_solve(dom, mu0);
            assert_int_equal(pps_dom_radiance(dom, &at, radiance[side]), PPS_OK);
        }
        for (int i = 0; i < 4; i++) {
            assert_close(radiance[0][i], radiance[1][i], 2e-12, 0);
        }
    }
    pps_dom_free(dom);
}

/* ---- nodes ---- */

static double reflectance_of(pps_slab slab, int streams, pps_nodes nodes) {
    pps_dom *dom = solve(
        slab, (pps_dom_opts){.streams = streams, .nodes = nodes, .orders = 1}, 0.6);
    double top = 0;
    pps_flux flux;
    assert_int_equal(pps_dom_flux(dom, 1, &top, &flux), PPS_OK);
    pps_dom_free(dom);
    return flux.up;
}

/* In the geometric mean over slabs the choice is as good as the better of both nodes to a
 * factor of two, and five times better than the worse. */
static void auto_nodes_are_those_that_suit_the_slab(void **state) {
    (void)state;
    static const double gs[] = {-0.5, 0, 0.5, 0.7, 0.85}, ws[] = {0.2, 1, 3, 10, 100};
    static const int streams[] = {4, 8, 16, 32};
    double over_best = 0, under_worst = 0;
    int n = 0;
    for (int i = 0; i < 5 * 5 * 4; i++) {
        pps_slab slab = {0.95, gs[i % 5], ws[i / 5 % 5]};
        double want = reflectance_of(slab, 192, PPS_NODES_AUTO), error[3];
        for (int k = 0; k < 3; k++) { /* auto, Gauss, mapped */
            double got = reflectance_of(slab, streams[i / 25], (pps_nodes)k);
            error[k] = fmax(fabs(got / want - 1), 1e-12);
        }
        over_best += log(error[0] / fmin(error[1], error[2]));
        under_worst += log(fmax(error[1], error[2]) / error[0]);
        n++;
    }
    print_message(
        "auto nodes: %.2f times the error of the better, 1/%.1f of the worse\n",
        exp(over_best / n), exp(under_worst / n));
    assert_true(exp(over_best / n) < 2);
    assert_true(exp(under_worst / n) > 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conservative_slab_returns_all_energy),
        cmocka_unit_test(conservative_net_flux_is_the_same_at_every_depth),
        cmocka_unit_test(reflection_and_transmission_are_reciprocal),
        cmocka_unit_test(few_streams_have_the_aureole),
        cmocka_unit_test(fluxes_are_sums_of_radiances_at_the_nodes),
        cmocka_unit_test(net_flux_loses_what_is_absorbed),
        cmocka_unit_test(flux_next_to_an_edge_keeps_its_digits),
        cmocka_unit_test(nothing_diffuse_falls_in),
        cmocka_unit_test(faint_scattering_is_single_scattering),
        cmocka_unit_test(thick_slab_is_a_half_space),
        cmocka_unit_test(answers_are_continuous_in_thickness),
        cmocka_unit_test(auto_nodes_are_those_that_suit_the_slab),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
