/* Complete elliptic integrals of the second kind: published values, the expansion at k = 1,
 * and GSL's.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>

#include <gsl/gsl_sf_ellint.h>

#include "core/elliptic.h"

static double elliptic_e(double complement) {
    pps_elliptic_e(1, &complement);
    return complement;
}

/* Abramowitz and Stegun, Table 17.1, by the parameter m = k^2. */
static void values_are_those_of_the_tables(void **state) {
    (void)state;
    static const struct {
        double m, e;
    } table[] = {{0.1, 1.530757637}, {0.5, 1.350643881}, {0.9, 1.104774733}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_close(elliptic_e(1 - table[i].m), table[i].e, 0, 6e-10);
    }
    assert_close(elliptic_e(1), 1.57079632679489661923, 1e-15, 0);
    assert_close(elliptic_e(0), 1, 0, 0);
    assert_close(elliptic_e(0.5), 1.35064388104767550252, 1e-15, 0);
}

/* 1 + m/2 (L - 1/2) + 3/16 m^2 (L - 13/12) + 15/128 m^3 (L - 6/5) + .., m the complement
 * and L = ln(4/sqrt(m)): DLMF 19.12.2. */
static void towards_one_it_is_its_expansion(void **state) {
    (void)state;
    for (double m = 1e-4; m > 1e-16; m *= 0.37) {
        double l = log(4 / sqrt(m));
        double want = 1 + m * ((l - 0.5) / 2 + m * (3 * (l - 13 / 12.0) / 16 +
                                                    m * 15 * (l - 1.2) / 128));
        assert_close(elliptic_e(m), want, 1e-14, 0);
    }
}

/* Whose own error grows to 1e-12 towards k = 1; here an array that no block divides. */
static void gsl_agrees(void **state) {
    (void)state;
    enum { N = 501 };
    double value[N];
    for (int i = 0; i < N; i++) {
        value[i] = 1e-3 + (1 - 1e-3) * i / (N - 1.0);
    }
    pps_elliptic_e(N, value);
    for (int i = 0; i < N; i++) {
        double k = sqrt(1 - (1e-3 + (1 - 1e-3) * i / (N - 1.0)));
        assert_close(value[i], gsl_sf_ellint_Ecomp(k, GSL_PREC_DOUBLE), 1e-12, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_the_tables),
        cmocka_unit_test(towards_one_it_is_its_expansion),
        cmocka_unit_test(gsl_agrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
