/* Nodes and weights of a hemisphere.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <float.h>
#include <math.h>

#include "core/quadrature.h"

__extension__ typedef __float128 quad;

enum { MOST = 600 };

static const int sizes[] = {1, 2, 3, 4, 5, 8, 16, 33, 44, 64, 88, 128, 256, 512, 600};
enum { N_SIZES = sizeof sizes / sizeof sizes[0] };

/* x^k magnifies the rounding of x by k. */
static double power_tolerance(int k) { return 4e-15 + k * DBL_EPSILON / 2; }

static void gauss_integrates_polynomials(void **state) {
    (void)state;
    double x[MOST], weight[MOST];
    for (int s = 0; s < N_SIZES; s++) {
        int n = sizes[s];
        pps_gauss_unit(n, x, weight);
        for (int k = 0; k < 2 * n; k++) {
            double sum = 0;
            for (int i = 0; i < n; i++) {
                sum += weight[i] * pow(x[i], k);
            }
            assert_close(sum, 1.0 / (k + 1), power_tolerance(k), 0);
        }
    }
}

/* The n-point rule is off by (n!)^4 / ((2n+1) ((2n)!)^3) (2n)! on x^(2n): not by 0. */
static void gauss_is_no_better_than_gauss(void **state) {
    (void)state;
    double x[3], weight[3], sum = 0;
    pps_gauss_unit(3, x, weight);
    for (int i = 0; i < 3; i++) {
        sum += weight[i] * pow(x[i], 6);
    }
    assert_close(1 / 7.0 - sum, 1296.0 / (7 * 720 * 720), 1e-12, 0);
}

static void nodes_ascend_inside_the_unit_interval(void **state) {
    (void)state;
    double x[MOST], weight[MOST];
    for (int s = 0; s < N_SIZES; s++) {
        for (pps_nodes kind = PPS_NODES_GAUSS; kind <= PPS_NODES_GRADED; kind++) {
            int n = sizes[s];
            pps_hemisphere_nodes(kind, n, x, weight);
            assert_true(x[0] > 0 && x[n - 1] < 1);
            for (int i = 0; i < n; i++) {
                assert_true(weight[i] > 0);
                assert_true(i == 0 || x[i] > x[i - 1]);
            }
        }
    }
}

static void weights_sum_to_one(void **state) {
    (void)state;
    double x[MOST], weight[MOST];
    for (int s = 0; s < N_SIZES; s++) {
        for (pps_nodes kind = PPS_NODES_GAUSS; kind <= PPS_NODES_GRADED; kind++) {
            double sum = 0;
            pps_hemisphere_nodes(kind, sizes[s], x, weight);
            for (int i = 0; i < sizes[s]; i++) {
                sum += weight[i];
            }
            assert_close(sum, 1, 1e-14, 0);
        }
    }
}

/* ---- against Newton's method in quad precision ---- */

/* P_n(1 - 2 x) and its derivative in x. */
static quad shifted_legendre(int n, quad x, quad *derivative) {
    quad z = 1 - 2 * x, before = 1, here = z;
    for (int l = 1; l < n; l++) {
        quad next = ((2 * l + 1) * z * here - l * before) / (l + 1);
        before = here;
        here = next;
    }
    *derivative = -2 * n * (before - z * here) / ((1 - z) * (1 + z));
    return here;
}

static void every_node_and_weight_holds_its_own_digits(void **state) {
    (void)state;
    static const int counts[] = {2, 5, 44, 128, 512};
    double x[MOST], weight[MOST];
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        int n = counts[c];
        pps_gauss_unit(n, x, weight);
        for (int i = 0; i < n; i++) {
            quad root = x[i], slope;
            for (int step = 0; step < 3; step++) {
                quad p = shifted_legendre(n, root, &slope);
                root -= p / slope;
            }
            shifted_legendre(n, root, &slope);
            quad exact_weight = 1 / (root * (1 - root) * slope * slope);
            assert_close(x[i], (double)root, 1e-14, 0);
            assert_close(weight[i], (double)exact_weight, 1e-14, 0);
        }
    }
}

/* ---- mapped nodes ---- */

static void mapped_nodes_integrate_half_the_degree(void **state) {
    (void)state;
    double x[MOST], weight[MOST];
    for (int s = 0; s < N_SIZES; s++) {
        int n = sizes[s];
        pps_hemisphere_nodes(PPS_NODES_MAPPED, n, x, weight);
        for (int k = 0; k < n; k++) {
            double sum = 0;
            for (int i = 0; i < n; i++) {
                sum += weight[i] * pow(x[i], k);
            }
            assert_close(sum, 1.0 / (k + 1), power_tolerance(k), 0);
        }
    }
}

static double log_moment(pps_nodes kind, int n) {
    double x[MOST], weight[MOST], sum = 0;
    pps_hemisphere_nodes(kind, n, x, weight);
    for (int i = 0; i < n; i++) {
        sum += weight[i] * x[i] * log(x[i]);
    }
    return sum;
}

/* int mu log mu = -1/4. A rule of n points is off by about n^-4 on x log x, and as
 * x^3 log x in the root by about n^-8. */
static void mapped_nodes_resolve_grazing_angles(void **state) {
    (void)state;
    static const int counts[] = {4, 8, 16, 32};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        double n4 = pow(counts[c], 4);
        double plain = fabs(log_moment(PPS_NODES_GAUSS, counts[c]) + 0.25);
        assert_close(log_moment(PPS_NODES_MAPPED, counts[c]), -0.25, 0,
                     4 / (n4 * n4) + 1e-16);
        assert_true(plain > 0.1 / n4);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gauss_integrates_polynomials),
        cmocka_unit_test(gauss_is_no_better_than_gauss),
        cmocka_unit_test(nodes_ascend_inside_the_unit_interval),
        cmocka_unit_test(weights_sum_to_one),
        cmocka_unit_test(every_node_and_weight_holds_its_own_digits),
        cmocka_unit_test(mapped_nodes_integrate_half_the_degree),
        cmocka_unit_test(mapped_nodes_resolve_grazing_angles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
