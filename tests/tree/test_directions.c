/* The sampling directions: antipodal, symmetric, and good at integrals over the sphere.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/cells.h>

#include "support/support.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

static void directions_are_unit_and_antipodal(void **state) {
    (void)state;
    pps_directions d = pps_directions_22();
    assert_int_equal(d.n, 22);
    for (int j = 0; j < d.n; j++) {
        assert_close(vec_length(d.to[j]), 1, 1e-15, 0);
        for (int i = 0; i < 3; i++) {
            assert_true(d.to[j][i] == -d.to[j ^ 1][i]);
        }
    }
}

static void a_turn_by_72_degrees_permutes_them(void **state) {
    (void)state;
    pps_directions d = pps_directions_22();
    double c = cos(2 * PI / 5), s = sin(2 * PI / 5);
    for (int j = 0; j < d.n; j++) {
        double turned[3] = {c * d.to[j][0] - s * d.to[j][1],
                            s * d.to[j][0] + c * d.to[j][1], d.to[j][2]};
        double closest = 0;
        for (int k = 0; k < d.n; k++) {
            closest = fmax(closest, vec_dot(turned, d.to[k]));
        }
        assert_close(closest, 1, 1e-14, 0);
    }
}

/* Mean of x^a y^b z^c over the sphere; 0 where a power is odd. */
static double moment(int a, int b, int c) {
    return a % 2 || b % 2 || c % 2
               ? 0
               : tgamma((a + 1) / 2.0) * tgamma((b + 1) / 2.0) * tgamma((c + 1) / 2.0) /
                     (2 * PI * tgamma((a + b + c + 3) / 2.0));
}

static void polynomials_of_degree_5_are_exact(void **state) {
    (void)state;
    pps_directions d = pps_directions_22();
    for (int a = 0; a <= 5; a++) {
        for (int b = 0; a + b <= 5; b++) {
            for (int c = 0; a + b + c <= 5; c++) {
                double sum = 0;
                for (int j = 0; j < d.n; j++) {
                    sum += pow(d.to[j][0], a) * pow(d.to[j][1], b) * pow(d.to[j][2], c);
                }
                assert_close(sum / d.n, moment(a, b, c), 0, 1e-15);
            }
        }
    }
}

/* The irradiance of a uniform sky of radiance 1, for normals all over the sphere. */
static void a_uniform_sky_gives_pi_within_6_percent(void **state) {
    (void)state;
    pps_directions d = pps_directions_22();
    enum { N = 100000 };
    double low = INFINITY, high = 0;
    for (int i = 0; i < N; i++) {
        double z = 1 - 2 * (i + 0.5) / N, r = sqrt(1 - z * z),
               phi = 2.399963229728653 * i;
        double n[3] = {r * cos(phi), r * sin(phi), z}, sum = 0;
        for (int j = 0; j < d.n; j++) {
            sum += fmax(0, vec_dot(n, d.to[j])) * 4 * PI / d.n;
        }
        low = fmin(low, sum / PI);
        high = fmax(high, sum / PI);
    }
    assert_close(low, 0.939, 0.0005, 0);
    assert_close(high, 1.0315, 0.0005, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_are_unit_and_antipodal),
        cmocka_unit_test(a_turn_by_72_degrees_permutes_them),
        cmocka_unit_test(polynomials_of_degree_5_are_exact),
        cmocka_unit_test(a_uniform_sky_gives_pi_within_6_percent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
