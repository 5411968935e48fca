/* Integrals over a hemisphere, against closed forms and against the same integrals in
 * the other order: over mu first, which gives exponential integrals, then over depth.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>

#include "core/hemisphere.h"
#include "core/quadrature.h"

static const double PI = 3.14159265358979323846;

enum { POINTS = 24, HALVINGS = 40 };

/* ---- an isotropic radiance ---- */

static void ones(const void *context, size_t n, const double *mu, double *radiance) {
    (void)context;
    (void)mu;
    for (size_t i = 0; i < n; i++) {
        radiance[i] = 1;
    }
}

static void isotropic_radiance_gives_flux_pi_and_mean_one_half(void **state) {
    (void)state;
    static const double runs[] = {1e-12, 1e-9, 1e-3, 1, 50, INFINITY};
    static const double beams[] = {1e-4, 1e-3, 0.5, 0.999, 1};
    static const double asymmetries[] = {-0.999, 0, 0.5, 0.99};
    for (int i = 0; i < 6 * 5 * 4; i++) {
        pps_hemisphere all = pps_hemisphere_integral(
            ones, NULL, runs[i % 6], beams[i / 6 % 5], asymmetries[i / 30]);
        assert_close(all.flux, PI, 1e-14, 0);
        assert_close(all.mean, 0.5, 1e-14, 0);
    }
}

static void no_run_gives_no_light(void **state) {
    (void)state;
    pps_hemisphere none = pps_hemisphere_integral(ones, NULL, 0, 0.5, 0);
    assert_close(none.flux, 0, 0, 0);
    assert_close(none.mean, 0, 0, 0);
}

/* ---- isotropic single scattering by exponential integrals ---- */

/* E_1(x) = int_1^inf e^(-x t)/t dt: its series, its continued fraction. */
static double exponential_integral(double x) {
    if (x > 1.5) {
        double tail = 0;
        for (int i = 120; i > 0; i--) {
            tail = i / (1 + i / (x + tail));
        }
        return exp(-x) / (x + tail);
    }
    double sum = -0.57721566490153286061 - log(x), term = -1;
    for (int i = 1; i < 40; i++) {
        term *= -x / i;
        sum += term / i;
    }
    return sum;
}

/* E_2(x) = e^(-x) - x E_1(x). */
static double second_exponential_integral(double x) {
    return exp(-x) - x * exponential_integral(x);
}

/* Light from distance s along tau: e^(-q (tau -+ s)) times the mean over the hemisphere
 * of what comes through, on panels that halve towards s = 0 and the far end. */
typedef struct {
    double q, tau, side; /* side 1: from above */
} column;

static void add_panel(const column *c, double from, double to, pps_hemisphere *sum) {
    double node[POINTS], weight[POINTS];
    pps_gauss_unit(POINTS, node, weight);
    for (int i = 0; i < POINTS; i++) {
        double s = from + (to - from) * node[i];
        double source =
            fabs(to - from) * weight[i] * exp(-c->q * (c->tau - c->side * s));
        sum->mean += source * exponential_integral(s) / (8 * PI);
        sum->flux += source * second_exponential_integral(s) / 2;
    }
}

static pps_hemisphere column_sum(const column *c, double run) {
    pps_hemisphere sum = {0};
    double far = run / 2;
    if (run == 0) {
        return sum;
    }
    for (int panel = 0; panel <= HALVINGS; panel++) {
        double near = panel < HALVINGS ? far / 2 : 0;
        add_panel(c, near, far, &sum);
        add_panel(c, run - far, run - near, &sum);
        far = near;
    }
    return sum;
}

static const struct {
    double mu0, w, tau;
} places[] = {{1, 1, 0},          {1, 1, 0.3},       {1, 1, 1},
              {0.5, 10, 5},       {0.5, 10, 10},     {0.01, 1, 0.02},
              {0.01, 1, 1},       {1e-3, 0.1, 1e-3}, {0.8, 1e-9, 0},
              {0.8, 1e-9, 5e-10}, {0.8, 1e-9, 1e-9}, {1e-3, 1e-9, 1e-9},
              {0.3, 1e-3, 5e-4},  {0.3, 30, 1e-6}};
enum { N_PLACES = sizeof places / sizeof places[0] };

static void isotropic_single_scattering_is_an_exponential_integral(void **state) {
    (void)state;
    for (int i = 0; i < N_PLACES; i++) {
        double w = places[i].w, tau = places[i].tau, mu0 = places[i].mu0;
        for (int down = 0; down < 2; down++) {
            double run = down ? tau : fmin(w - tau, 40 * mu0);
            pps_hemisphere got = pps_single_hemisphere(0, mu0, w, tau, down);
            column c = {1 / mu0, tau, down ? 1 : -1};
            pps_hemisphere want = column_sum(&c, run);
            assert_close(got.flux, want.flux, 1e-12, 0);
            assert_close(got.mean, want.mean, 1e-12, 0);
        }
    }
}

/* int_0^inf e^(-q s) E_1(s) ds = ln(1 + q)/q, and of E_2 (1 - ln(1 + q)/q)/q. */
static void half_space_reflects_a_logarithm(void **state) {
    (void)state;
    static const double beams[] = {1e-4, 1e-3, 0.1, 0.5, 0.9, 1};
    for (int i = 0; i < 6; i++) {
        double mu0 = beams[i], part = mu0 * log1p(1 / mu0);
        pps_hemisphere up = pps_single_hemisphere(0, mu0, INFINITY, 0, 0);
        assert_close(up.mean, part / (8 * PI), 1e-12, 0);
        assert_close(up.flux, mu0 * (1 - part) / 2, 1e-12, 0);
    }
}

/* ---- any phase function: what is scattered either leaves or is extinguished ---- */

/* d(F+ - F-)/dtau = e^(-q tau) - 4 pi J, integrated over the slab. */
static double left_in_flight(double g, double mu0, double w) {
    double node[POINTS], weight[POINTS], sum = 0, far = w / 2;
    pps_gauss_unit(POINTS, node, weight);
    for (int panel = 0; panel <= 12; panel++) { /* J has x log x at both edges */
        double near = panel < 12 ? far / 8 : 0;
        for (int i = 0; i < 2 * POINTS; i++) {
            double s = near + (far - near) * node[i / 2], tau = i % 2 ? s : w - s;
            double mean = pps_single_hemisphere(g, mu0, w, tau, 0).mean +
                          pps_single_hemisphere(g, mu0, w, tau, 1).mean;
            sum += (far - near) * weight[i / 2] * (exp(-tau / mu0) - 4 * PI * mean);
        }
        far = near;
    }
    return sum;
}

static void single_scattering_balances_its_light(void **state) {
    (void)state;
    static const struct {
        double g, mu0, w;
    } cases[] = {{0.5, 0.5, 1}, {-0.7, 0.2, 0.3}, {0.9, 1, 2}, {0.95, 0.6, 1e-6}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double g = cases[i].g, mu0 = cases[i].mu0, w = cases[i].w;
        double up = pps_single_hemisphere(g, mu0, w, 0, 0).flux;
        double down = pps_single_hemisphere(g, mu0, w, w, 1).flux;
        assert_close(up + down, left_in_flight(g, mu0, w), 1e-12, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_radiance_gives_flux_pi_and_mean_one_half),
        cmocka_unit_test(no_run_gives_no_light),
        cmocka_unit_test(isotropic_single_scattering_is_an_exponential_integral),
        cmocka_unit_test(half_space_reflects_a_logarithm),
        cmocka_unit_test(single_scattering_balances_its_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
