/* Normalised associated Legendre functions: orthogonality and the addition theorem.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>

#include <ppscat/phase.h>

#include "core/legendre.h"
#include "core/quadrature.h"

enum { MOST = 1024, POINTS = 128 };

/* int_-1^1 p_k p_l dx = 2/(2l+1) when k = l, else 0. */
static void functions_of_one_order_are_orthogonal(void **state) {
    (void)state;
    enum { N = 80 };
    static const int orders[] = {0, 1, 2, 7, 40, 79};
    static double p[POINTS][N];
    double node[POINTS], weight[POINTS];
    pps_gauss_unit(POINTS, node, weight);
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        int m = orders[o];
        for (int i = 0; i < POINTS; i++) {
            pps_legendre(m, N, 2 * node[i] - 1, p[i]);
        }
        for (int k = m; k < N; k++) {
            for (int l = k; l < N; l++) {
                double sum = 0;
                for (int i = 0; i < POINTS; i++) {
                    sum += 2 * weight[i] * p[i][k - m] * p[i][l - m];
                }
                assert_close(sum, k == l ? 2.0 / (2 * l + 1) : 0, 0, 1e-14);
            }
        }
    }
}

/* P_l by its own recurrence. */
static double legendre_polynomial(int l, double x) {
    double before = 1, here = x;
    for (int i = 1; i < l; i++) {
        double next = ((2 * i + 1) * x * here - i * before) / (i + 1);
        before = here;
        here = next;
    }
    return l == 0 ? 1 : here;
}

/* sum over m of (2 - delta_m0) p_l^m(x) p_l^m(y) cos(m phi). */
static double addition_sum(int l, double x, double y, double phi) {
    double px[MOST], py[MOST], sum = 0;
    for (int m = 0; m <= l; m++) {
        pps_legendre(m, l + 1, x, px);
        pps_legendre(m, l + 1, y, py);
        sum += (m == 0 ? 1 : 2) * px[l - m] * py[l - m] * pps_cos_degrees(m * phi);
    }
    return sum;
}

static const struct {
    double x, y, phi;
} pairs[] = {{0.3, 0.8, 0}, {0.3, -0.8, 60},  {-0.5, -0.5, 180},
             {1, 0.37, 25}, {0, 1e-3, 90},    {0.999, 0.998, 10},
             {-1, 1, 45},   {1e-6, 0.9, 150}, {0.7, 0.7, 0}};
enum { N_PAIRS = sizeof pairs / sizeof pairs[0] };

static void addition_theorem_holds(void **state) {
    (void)state;
    static const int degrees[] = {0, 1, 2, 3, 10, 31, 64, 127};
    for (size_t d = 0; d < sizeof degrees / sizeof *degrees; d++) {
        for (int i = 0; i < N_PAIRS; i++) {
            double x = pairs[i].x, y = pairs[i].y, phi = pairs[i].phi;
            double cosine = pps_cos_scattering(x, y, phi);
            assert_close(addition_sum(degrees[d], x, y, phi),
                         legendre_polynomial(degrees[d], cosine), 0, 1e-12);
        }
    }
}

/* Up to the most moments a solver takes: what underflows at high orders near mu = 1
 * would not have shown. */
static void addition_theorem_holds_where_high_orders_underflow(void **state) {
    (void)state;
    double p[MOST];
    pps_legendre(MOST - 2, MOST, 0.999, p);
    assert_close(p[0], 0, 0, 0);
    assert_close(p[1], 0, 0, 0);
    static const int rows[] = {0, 4, 5, 8};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double x = pairs[rows[i]].x, y = pairs[rows[i]].y, phi = pairs[rows[i]].phi;
        double cosine = pps_cos_scattering(x, y, phi);
        assert_close(addition_sum(MOST - 1, x, y, phi),
                     legendre_polynomial(MOST - 1, cosine), 0, 1e-11);
    }
}

/* (2m-1)!!/(2m)!! = Gamma(m + 1/2) / (sqrt(pi) Gamma(m + 1)). */
static void sectoral_functions_at_the_horizon_are_known(void **state) {
    (void)state;
    static const int orders[] = {0, 1, 2, 10, 100, 1000};
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        int m = orders[o];
        double p[2], ratio = 1;
        for (int i = m; i > 0; i--) {
            ratio *= (2 * i - 1.0) / (2 * i);
        }
        pps_legendre(m, m + 2, 0, p);
        assert_close(p[0], sqrt(ratio), 1e-13, 0);
        assert_close(p[1], 0, 0, 0);
    }
}

static void only_order_zero_is_left_at_the_poles(void **state) {
    (void)state;
    enum { N = 50 };
    double p[N];
    for (int m = 0; m < 3; m++) {
        pps_legendre(m, N, -1, p);
        for (int l = m; l < N; l++) {
            double parity = l % 2 == 0 ? 1 : -1;
            assert_close(p[l - m], m == 0 ? parity : 0, 1e-14, 0);
        }
    }
}

static void products_sum_with_their_coefficients(void **state) {
    (void)state;
    enum { N = 40 };
    double coefficient[N], px[N], py[N];
    for (int i = 0; i < N_PAIRS; i++) {
        double x = pairs[i].x, y = pairs[i].y, sum = 0;
        pps_legendre(0, N, x, px);
        pps_legendre(0, N, y, py);
        for (int l = 0; l < N; l++) {
            coefficient[l] = (2 * l + 1) * pow(0.8, l);
            sum += coefficient[l] * px[l] * py[l];
        }
        assert_close(pps_legendre_product(N, coefficient, x, y), sum, 1e-13, 1e-13);
        assert_close(pps_legendre_product(1, coefficient, x, y), 1, 0, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_of_one_order_are_orthogonal),
        cmocka_unit_test(addition_theorem_holds),
        cmocka_unit_test(addition_theorem_holds_where_high_orders_underflow),
        cmocka_unit_test(sectoral_functions_at_the_horizon_are_known),
        cmocka_unit_test(only_order_zero_is_left_at_the_poles),
        cmocka_unit_test(products_sum_with_their_coefficients),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
