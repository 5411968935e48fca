/* Divided differences of exponentials, against a quad-precision matrix exponential.
 *
 * E_n(t; x_0, .., x_n) is t^n e^(-low t) times the corner entry of exp(M), M upper
 * bidiagonal with -(x_i - low) t on the diagonal and 1 above it, low the smallest rate.
 * All entries of exp(M) are positive, so that squaring loses nothing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>

#include <ppscat/expdiff.h>

__extension__ typedef __float128 quad;

enum { MOST = 4, CASES = 4000 };

typedef struct {
    quad entry[MOST][MOST];
} matrix;

static matrix multiply(int n, const matrix *a, const matrix *b) {
    matrix c = {0};
    for (int i = 0; i < n; i++) {
        for (int j = i; j < n; j++) {
            for (int k = i; k <= j; k++) {
                c.entry[i][j] += a->entry[i][k] * b->entry[k][j];
            }
        }
    }
    return c;
}

/* 1 + M (1 + M/2 (1 + M/3 (..))) for |M| < 1. */
static matrix taylor(int n, const matrix *m) {
    matrix sum = {0};
    for (int term = 32; term > 0; term--) {
        matrix next = multiply(n, m, &sum);
        for (int i = 0; i < n; i++) {
            for (int j = i; j < n; j++) {
                sum.entry[i][j] = (m->entry[i][j] + next.entry[i][j]) / term;
            }
        }
    }
    for (int i = 0; i < n; i++) {
        sum.entry[i][i] += 1;
    }
    return sum;
}

/* The corner entry of exp(M), M with diagonal[i] <= 0 and 1 above it. */
static quad bidiagonal_exponential(int n, const quad *diagonal) {
    quad largest = 1, scale = 1;
    for (int i = 0; i < n; i++) {
        largest = -diagonal[i] > largest ? -diagonal[i] : largest;
    }
    int squarings = 0;
    while (largest * scale > 0.25) {
        scale /= 2;
        squarings++;
    }
    matrix m = {0};
    for (int i = 0; i < n; i++) {
        m.entry[i][i] = diagonal[i] * scale;
        if (i + 1 < n) {
            m.entry[i][i + 1] = scale;
        }
    }
    m = taylor(n, &m);
    for (int i = 0; i < squarings; i++) {
        m = multiply(n, &m, &m);
    }
    return m.entry[0][n - 1];
}

static double smallest(int n, const double *rate) {
    double low = rate[0];
    for (int i = 1; i < n; i++) {
        low = fmin(low, rate[i]);
    }
    return low;
}

/* E_(n-1) over n rates; right for |low t| below 11,000. */
static quad reference(double t, int n, const double *rate) {
    quad low = smallest(n, rate), diagonal[MOST], zero = 0;
    quad value = 1, shift = low * t < 0 ? low * t : -low * t;
    for (int i = 0; i < n; i++) {
        diagonal[i] = -(rate[i] - low) * t;
    }
    for (int i = 1; i < n; i++) {
        value *= t;
    }
    value *= bidiagonal_exponential(n, diagonal);
    quad decay = bidiagonal_exponential(1, shift < zero ? &shift : &zero);
    return low < 0 ? value / decay : value * decay;
}

static double evaluate(double t, int n, const double *x) {
    switch (n) {
    case 2:
        return pps_exp1(t, x[0], x[1]);
    case 3:
        return pps_exp2(t, x[0], x[1], x[2]);
    default:
        return pps_exp3(t, x[0], x[1], x[2], x[3]);
    }
}

/* |E - reference| / reference in units of 1 + |low t|, the error of e^(-low t). */
static double scaled_error(double got, double t, int n, const double *rate) {
    quad want = reference(t, n, rate);
    double relative = fabs((double)((got - want) / want));
    return relative / (1 + fabs(smallest(n, rate) * t));
}

/* ---- random cases ---- */

static double between(uint64_t *seed, double from, double to) {
    return from + (to - from) * support_random(seed);
}

static double power_between(uint64_t *seed, double from, double to) {
    return pow(10, between(seed, from, to));
}

/* t in 1e-12..50; rates 1e-6..1e6 or negative, with a first rate that leaves e^(-low t)
 * a normal number; later ones may coincide with an earlier one, to all or to some
 * digits. */
static double random_case(uint64_t *seed, double *rate) {
    double t = power_between(seed, -12, log10(50));
    double most = fmin(1e6, 500 / t);
    rate[0] = most * power_between(seed, -6, 0);
    if (support_random(seed) < 0.25) {
        rate[0] = -rate[0];
    }
    for (int i = 1; i < MOST; i++) {
        double kind = support_random(seed), old = rate[(int)(i * support_random(seed))];
        if (kind < 0.2) {
            rate[i] = old;
        } else if (kind < 0.4) {
            rate[i] = old * (1 + power_between(seed, -16, -1));
        } else if (kind < 0.6) { /* apart by 1e-3 .. 1e2 in units of 1/t */
            rate[i] = old + power_between(seed, -3, 2) / t;
        } else if (kind < 0.9) {
            rate[i] = power_between(seed, -6, 6);
        } else {
            rate[i] = -most * power_between(seed, -6, 0);
        }
    }
    return t;
}

static double worst_of_random_cases(int n) {
    uint64_t seed = 2013;
    double worst = 0;
    for (int i = 0; i < CASES; i++) {
        double rate[MOST], t = random_case(&seed, rate);
        double got = evaluate(t, n, rate);
        worst = fmax(worst, scaled_error(got, t, n, rate));
    }
    return worst;
}

static void reference_agrees_with_a_case_known_in_closed_form(void **state) {
    (void)state;
    /* E2(1; 0, 1, 1) = 1 - 2/e, E3(2; 0, 0, 0, 0) = 8/6. */
    assert_close((double)reference(1, 3, (double[]){0, 1, 1}), 1 - 2 * exp(-1), 1e-15,
                 0);
    assert_close((double)reference(2, 4, (double[]){0, 0, 0, 0}), 8.0 / 6, 1e-15, 0);
    assert_close((double)reference(3, 2, (double[]){-1, -1}), 3 * exp(3), 1e-15, 0);
}

static void first_difference_holds_its_digits(void **state) {
    (void)state;
    assert_close(worst_of_random_cases(2), 0, 0, 2e-15);
}

static void second_difference_holds_its_digits(void **state) {
    (void)state;
    assert_close(worst_of_random_cases(3), 0, 0, 2e-15);
}

static void third_difference_holds_its_digits(void **state) {
    (void)state;
    assert_close(worst_of_random_cases(4), 0, 0, 4e-15);
}

/* ---- identities and limits ---- */

static void order_of_the_rates_does_not_matter(void **state) {
    (void)state;
    uint64_t seed = 7;
    for (int i = 0; i < 500; i++) {
        double x[MOST], t = random_case(&seed, x);
        double e1 = pps_exp1(t, x[0], x[1]);
        double e2 = pps_exp2(t, x[0], x[1], x[2]);
        double e3 = pps_exp3(t, x[0], x[1], x[2], x[3]);
        assert_close(pps_exp1(t, x[1], x[0]), e1, 0, 0);
        assert_close(pps_exp2(t, x[0], x[2], x[1]), e2, 0, 0);
        assert_close(pps_exp2(t, x[1], x[0], x[2]), e2, 0, 0);
        assert_close(pps_exp2(t, x[2], x[1], x[0]), e2, 0, 0);
        assert_close(pps_exp3(t, x[3], x[2], x[1], x[0]), e3, 0, 0);
        assert_close(pps_exp3(t, x[1], x[0], x[3], x[2]), e3, 0, 0);
        assert_close(pps_exp3(t, x[2], x[0], x[1], x[3]), e3, 0, 0);
        assert_close(pps_exp3(t, x[0], x[3], x[2], x[1]), e3, 0, 0);
    }
}

static void nothing_is_gathered_over_no_distance(void **state) {
    (void)state;
    static const double rates[][4] = {
        {0, 0, 0, 0}, {1, 2, 3, 4}, {-1, -1, 5, 1e6}, {1e6, 1e6, 1e6, 0}};
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        const double *x = rates[i];
        assert_close(pps_exp1(0, x[0], x[1]), 0, 0, 0);
        assert_close(pps_exp2(0, x[0], x[1], x[2]), 0, 0, 0);
        assert_close(pps_exp3(0, x[0], x[1], x[2], x[3]), 0, 0, 0);
    }
}

/* As t grows only the terms of the zero rate stay: the product of 1/rate. */
static void infinite_distance_leaves_the_zero_rate_alone(void **state) {
    (void)state;
    assert_close(pps_exp1(INFINITY, 0, 4), 0.25, 1e-15, 0);
    assert_close(pps_exp1(INFINITY, 3, 0), 1 / 3.0, 1e-15, 0);
    assert_close(pps_exp1(INFINITY, 3, 4), 0, 0, 0);
    assert_close(pps_exp1(INFINITY, 3, 3), 0, 0, 0);
    assert_close(pps_exp1_known(INFINITY, 0, 4, 1, 0), 0.25, 1e-15, 0);
    assert_close(pps_exp1_known(INFINITY, 3, 4, 0, 0), 0, 0, 0);
    assert_close(pps_exp1_known(INFINITY, 3, 3, 0, 0), 0, 0, 0);
    assert_close(pps_exp2(INFINITY, 5, 0, 4), 0.05, 1e-15, 0);
    assert_close(pps_exp2(INFINITY, 5, 0, 5), 0.04, 1e-15, 0);
    assert_close(pps_exp2(INFINITY, 2, 2, 2), 0, 0, 0);
    assert_close(pps_exp3(INFINITY, 5, 2, 0, 4), 0.025, 1e-15, 0);
    assert_close(pps_exp3(INFINITY, 5, 5, 0, 4), 0.01, 1e-15, 0);
    assert_close(pps_exp3(INFINITY, 1, 2, 3, 4), 0, 0, 0);
    assert_close(pps_exp3(INFINITY, 2, 2, 2, 2), 0, 0, 0);
}

static void known_exponentials_give_the_same_difference(void **state) {
    (void)state;
    uint64_t seed = 11;
    double worst = 0;
    for (int i = 0; i < CASES; i++) {
        double x[MOST], t = random_case(&seed, x);
        double k = fabs(x[0]), c = fmin(fabs(x[1]), 700 / t), pair[] = {k, c};
        double got = pps_exp1_known(t, k, c, exp(-k * t), exp(-c * t));
        worst = fmax(worst, scaled_error(got, t, 2, pair));
    }
    assert_close(worst, 0, 0, 2e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_agrees_with_a_case_known_in_closed_form),
        cmocka_unit_test(first_difference_holds_its_digits),
        cmocka_unit_test(second_difference_holds_its_digits),
        cmocka_unit_test(third_difference_holds_its_digits),
        cmocka_unit_test(order_of_the_rates_does_not_matter),
        cmocka_unit_test(nothing_is_gathered_over_no_distance),
        cmocka_unit_test(infinite_distance_leaves_the_zero_rate_alone),
        cmocka_unit_test(known_exponentials_give_the_same_difference),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
