/* The G-factor: its ends, its range, and balls with analytic paths.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/cells.h>

#include "support/support.h"
#include "tree/gfactor.h"

static const pps_compensation forms[] = {PPS_COMPENSATE_DERIVED,
                                         PPS_COMPENSATE_PRINTED};

/* Cosines to a light overhead. */
static int cosines(double mu[]) {
    pps_directions to = pps_directions_22();
    for (int j = 0; j < to.n; j++) {
        mu[j] = to.to[j][2];
    }
    return to.n;
}

static void one_in_a_slab_and_none_at_the_edge_of_nothing(void **state) {
    (void)state;
    double mu[64], h[64], zero[64] = {0};
    int n = cosines(mu);
    for (int i = 1; i < 10; i++) {
        double w = 0.1 * i * i, d = 0.37 * w;
        for (int j = 0; j < n; j++) {
            h[j] = mu[j] > 0 ? d / mu[j] : (w - d) / -mu[j];
        }
        for (int f = 0; f < 2; f++) {
            assert_close(pps_g_factor(forms[f], d, w, n, mu, h), 1, 0, 1e-9);
            assert_close(pps_g_factor(forms[f], d, w, n, mu, zero), 0, 0, 1e-9);
        }
        assert_close(pps_g_factor(PPS_COMPENSATE_NONE, d, w, n, mu, zero), 1, 0, 0);
    }
}

static void always_from_none_to_one(void **state) {
    (void)state;
    uint64_t seed = 1;
    double mu[64], h[64];
    int n = cosines(mu);
    mu[0] = 0; /* along the slab: left out of the mean */
    mu[2] = 1;
    for (int i = 0; i < 2000; i++) {
        double w = pow(10, 6 * support_random(&seed) - 4);
        double d = i % 7 == 0 ? 0 : i % 7 == 1 ? w : w * support_random(&seed);
        for (int j = 0; j < n; j++) {
            h[j] = i % 5 == 0 ? 0 : pow(10, 6 * support_random(&seed) - 4);
        }
        for (int f = 0; f < 2; f++) {
            double g = pps_g_factor(forms[f], d, w, n, mu, h);
            assert_true(g >= 0 && g <= 1);
        }
    }
}

static void directions_along_the_slab_do_not_count(void **state) {
    (void)state;
    double mu[] = {0.5, 0, 1e-4, -1e-4}, h[] = {0.3, 5, 0, 2};
    for (int f = 0; f < 2; f++) {
        assert_close(pps_g_factor(forms[f], 1, 2, 4, mu, h),
                     pps_g_factor(forms[f], 1, 2, 1, mu, h), 1e-15, 0);
    }
}

/* On the axis of a ball of optical radius R, at share s of R below its top, |z e + h u| = R.
 * n cosines evenly spread. */
static double in_ball(pps_compensation form, double radius, double share, int n) {
    double mu[1000], h[1000], z = (1 - share) * radius;
    if (n == 22) {
        cosines(mu);
    }
    for (int j = 0; j < n; j++) {
        mu[j] = n == 22 ? mu[j] : (2 * j + 1.0) / n - 1;
        h[j] = -z * mu[j] + sqrt(radius * radius - z * z * (1 - mu[j] * mu[j]));
    }
    return pps_g_factor(form, radius - z, 2 * radius, n, mu, h);
}

/* The printed shape is steep near the top: 22 directions are not enough for 0.02 there. */
static void balls_as_tabulated(void **state) {
    (void)state;
    static const double share[] = {0, 0.1, 0.25, 0.5, 1, 1.5, 1.9};
    static const struct {
        pps_compensation form;
        double radius, g[7];
        double few; /* tolerance with the 22 directions */
    } rows[] = {
        {PPS_COMPENSATE_DERIVED, 2, {.91, .87, .87, .88, .88, .84, .78}, 0.02},
        {PPS_COMPENSATE_DERIVED, 0.5, {.77, .69, .67, .66, .64, .62, .63}, 0.02},
        {PPS_COMPENSATE_PRINTED, 2, {1, .73, .61, .49, .36, .28, .23}, 0.03},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (int k = 0; k < 7; k++) {
            double want = rows[i].g[k];
            assert_close(in_ball(rows[i].form, rows[i].radius, share[k], 1000), want, 0,
                         0.02);
            assert_close(in_ball(rows[i].form, rows[i].radius, share[k], 22), want, 0,
                         rows[i].few);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_in_a_slab_and_none_at_the_edge_of_nothing),
        cmocka_unit_test(always_from_none_to_one),
        cmocka_unit_test(directions_along_the_slab_do_not_count),
        cmocka_unit_test(balls_as_tabulated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
