/* Lists, angles, default directions and the digits of CSV, from their functions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/csv.h"
#include "cli/directions.h"
#include "cli/list.h"

enum { MOST = 6 };

static const struct {
    const char *text;
    unsigned allow;
    size_t n;
    double value[MOST];
} good_lists[] = {
    {"0.5", 0, 1, {0.5}},
    {"1,-2,3e2", 0, 3, {1, -2, 300}},
    {"+1,.5,5.", 0, 3, {1, 0.5, 5}},
    {"0:1:3", 0, 3, {0, 0.5, 1}},
    {"1:0:3", 0, 3, {1, 0.5, 0}},
    {"-1:1:5,7", 0, 6, {-1, -0.5, 0, 0.5, 1, 7}},
    {"3:3:1", 0, 1, {3}},
    {"3:3:2", 0, 2, {3, 3}},
    {"0.1:10:3log", 0, 3, {0.1, 1, 10}},
    {"0.001:100:6log", 0, 6, {0.001, 0.01, 0.1, 1, 10, 100}},
    {"inf", LIST_INF, 1, {INFINITY}},
    {"1,inf,2:3:2", LIST_INF, 4, {1, INFINITY, 2, 3}},
    {"25%,1", LIST_SHARE, 2, {25, 1}},
    {"0:1e308:2", 0, 2, {0, 1e308}},
    {"-1e308:1e308:3", 0, 3, {-1e308, 0, 1e308}},
};

static void lists_hold_what_they_say(void **state) {
    char why[160];

    (void)state;
    for (size_t i = 0; i < sizeof good_lists / sizeof good_lists[0]; i++) {
        number_list list;
        assert_int_equal(
            list_read(good_lists[i].text, good_lists[i].allow, &list, why, sizeof why),
            CLI_DONE);
        assert_int_equal(list.n, good_lists[i].n);
        for (size_t j = 0; j < list.n; j++) {
            double want = good_lists[i].value[j];
            assert_true(list.value[j] == want ||
                        fabs(list.value[j] - want) <= 2e-16 * fabs(want));
        }
        list_free(&list);
    }
}

static void ends_of_a_range_are_exact(void **state) {
    static const double ends[][2] = {{0.1, 0.7}, {1e-9, 1e9}, {1.0 / 3, 2.0 / 3}};

    (void)state;
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        for (int logs = 0; logs < 2; logs++) {
            char text[128], why[160];
            number_list list;
            snprintf(text, sizeof text, "%.17g:%.17g:7%s", ends[i][0], ends[i][1],
                     logs ? "log" : "");
            assert_int_equal(list_read(text, 0, &list, why, sizeof why), CLI_DONE);
            assert_int_equal(list.n, 7);
            assert_true(list.value[0] == ends[i][0]);
            assert_true(list.value[6] == ends[i][1]);
            list_free(&list);
        }
    }
}

static void shares_are_marked(void **state) {
    char why[160];
    number_list list;

    (void)state;
    assert_int_equal(list_read("5,25%", LIST_SHARE, &list, why, sizeof why), CLI_DONE);
    assert_false(list.share[0]);
    assert_true(list.share[1]);
    list_free(&list);
}

static void wrong_lists_are_refused_with_a_reason(void **state) {
    static const char *const texts[] = {
        "",         ",",         "1,",
        ",1",       "1,,2",      "x",
        "1x",       "nan",       "NAN",
        "inf",      "-inf",      "infinity",
        "0x10",     " 1",        "1 ",
        "1e",       "1e999",     "1e-999",
        "--1",      "1:2",       "1:2:",
        "1:2:0",    "1:2:-1",    "1:2:1",
        "1:2:2.5",  "1:2:3lo",   "1:2:3logx",
        "1:2:3:4",  ":2:3",      "1::3",
        "0:1:3log", "-1:1:3log", "1:2:99999999",
        "25%",      "1:50%:3",   "1:2:1e1",
        "nan:1:2",  "1:inf:3",   "1:2:99999999999999999999",
    };
    char why[160];

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        number_list list;
        why[0] = '\0';
        if (list_read(texts[i], 0, &list, why, sizeof why) != CLI_USAGE || !why[0])
            fail_msg("'%s' was taken", texts[i]);
        assert_null(list.value);
    }
}

static void cosines_of_round_angles_are_exact(void **state) {
    static const double exact[][2] = {
        {0, 1}, {60, 0.5}, {90, 0}, {120, -0.5}, {180, -1}};

    (void)state;
    for (size_t i = 0; i < sizeof exact / sizeof exact[0]; i++)
        assert_true(cos_degrees(exact[i][0]) == exact[i][1]);
    for (int i = 0; i < 180; i++) {
        double angle = i + 0.5;
        double want = (double)cosl((long double)angle * 3.14159265358979323846L / 180);
        assert_true(fabs(cos_degrees(angle) - want) < 2e-16);
        assert_true(cos_degrees(angle) == -cos_degrees(180 - angle));
    }
}

/* 2n nodes a hemisphere integrate mu^k exactly for k < 2n, on each hemisphere. */
static void gauss_nodes_integrate_polynomials(void **state) {
    enum { N = 16 };
    double mu[2 * N], weight[2 * N];

    (void)state;
    for (size_t n = 1; n <= N; n++) {
        gauss_sphere(n, mu, weight);
        for (size_t k = 0; k < 2 * n; k++) {
            double up = 0, down = 0;
            for (size_t i = 0; i < n; i++) {
                up += weight[i] * pow(mu[i], (double)k);
                down += weight[n + i] * pow(mu[n + i], (double)k);
            }
            assert_true(fabs(2 * down * ((double)k + 1) - 1) < 2e-14);
            assert_true(fabs(fabs(up) - down) < 1e-15);
        }
        for (size_t i = 1; i < 2 * n; i++)
            assert_true(mu[i] > mu[i - 1]);
    }
}

static void azimuths_integrate_cosines(void **state) {
    enum { N = 19 };
    const double pi = 3.14159265358979323846;
    double phi[N], weight[N];

    (void)state;
    even_azimuths(N, phi, weight);
    for (int m = 0; m < 36; m++) {
        double sum = 0;
        for (int i = 0; i < N; i++)
            sum += weight[i] * cos(m * phi[i] * pi / 180);
        assert_true(fabs(sum - (m == 0)) < 1e-13);
    }
}

static void numbers_read_back_the_same(void **state) {
    static const double plain[] = {0.1,    1e-5,    1e300,
                                   5e-324, 1.0 / 3, 0.30000000000000004};
    uint64_t bits = 88172645463325252u;
    char text[CSV_NUMBER_SIZE];

    (void)state;
    for (int i = 0; i < 100000; i++) {
        double x;
        size_t length;
        bits ^= bits << 13; /* xorshift64 */
        bits ^= bits >> 7;
        bits ^= bits << 17;
        memcpy(&x, &bits, sizeof x);
        if (i < 6)
            x = plain[i];
        if (!isfinite(x))
            continue;
        length = csv_format(x, text);
        assert_int_equal(length, strlen(text));
        assert_true(strtod(text, NULL) == x);
    }
}

static void numbers_are_short(void **state) {
    static const struct {
        double x;
        const char *text;
    } cases[] = {{0.1, "0.1"},
                 {10, "10"},
                 {0.5, "0.5"},
                 {1e-6, "1e-06"},
                 {INFINITY, "inf"},
                 {(double)NAN, ""},
                 {0, "0"},
                 {-0.25, "-0.25"},
                 {1e15, "1000000000000000"},
                 {1e16, "1e+16"},
                 {12345.678, "12345.678"},
                 {0.0001, "0.0001"},
                 {0.00001234, "1.234e-05"},
                 {5e-324, "5e-324"},
                 {DBL_MAX, "1.7976931348623157e+308"},
                 {-INFINITY, "-inf"},
                 {9007199254740992, "9007199254740992"},
                 {1e23, "1e+23"},
                 {100, "100"}};
    char text[CSV_NUMBER_SIZE];

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        csv_format(cases[i].x, text);
        assert_string_equal(text, cases[i].text);
    }
}

/* The digits of a number as text, without zeros at either end; returns how many. */
static size_t digits_of(const char *text, char digits[CSV_NUMBER_SIZE]) {
    size_t n = 0;

    for (; *text && *text != 'e'; text++) {
        if (*text >= '0' && *text <= '9' && (n || *text != '0'))
            digits[n++] = *text;
    }
    while (n && digits[n - 1] == '0')
        n--;
    digits[n] = '\0';
    return n;
}

/* printf's digits, as many as it takes to read back x: correctly rounded, so nobody has
 * nearer ones, but where rounding leads out of what reads back as x there may be fewer. */
static void compare_with_printf(double x) {
    char text[CSV_NUMBER_SIZE], want[64], ours[CSV_NUMBER_SIZE],
        theirs[CSV_NUMBER_SIZE];
    int precision = 0;
    size_t n;

    do
        snprintf(want, sizeof want, "%.*e", precision++, x);
    while (strtod(want, NULL) != x);
    csv_format(x, text);
    n = digits_of(want, theirs);
    if (strtod(text, NULL) != x || digits_of(text, ours) > n ||
        (strlen(ours) == n && strcmp(ours, theirs) != 0))
        fail_msg("%a is '%s', printf has '%s'", x, text, want);
}

/* Every exponent, with the fractions at and beside the powers of two, where the interval
 * that reads back as x is lopsided; subnormals; decimal fractions; random bits. */
static void numbers_have_the_fewest_digits_and_the_nearest(void **state) {
    uint64_t random = 88172645463325252u;

    (void)state;
    for (uint64_t exponent = 0; exponent < 2047; exponent++) {
        for (uint64_t i = 0; i < 40; i++) {
            uint64_t bits = exponent << 52;
            double x;
            random ^= random << 13; /* xorshift64 */
            random ^= random >> 7;
            random ^= random << 17;
            if (i < 8)
                bits += i < 4 ? i : UINT64_C(0) - (i - 3);
            else
                bits |= i < 12 ? random >> 12 & ~UINT64_C(0) << 5 * i : random >> 12;
            bits &= INT64_MAX;
            memcpy(&x, &bits, sizeof x);
            if (isfinite(x) && x != 0)
                compare_with_printf(x);
        }
    }
    for (int i = 1; i < 20000; i++) {
        compare_with_printf(i / 1000.0);
        compare_with_printf(i * 1e17);
        compare_with_printf(i * 5e-324);
        compare_with_printf((double)(random >> 11) + i);
    }
}

static void misspelt_words_are_guessed(void **state) {
    static const char *const words[] = {"albedo", "thickness", "g"};

    (void)state;
    assert_string_equal(cli_closest("albdo", 3, words), "albedo");
    assert_string_equal(cli_closest("thicknes", 3, words), "thickness");
    assert_null(cli_closest("zebra", 3, words));
    assert_null(cli_closest("x", 3, words));
    assert_null(cli_closest("", 3, words));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_hold_what_they_say),
        cmocka_unit_test(ends_of_a_range_are_exact),
        cmocka_unit_test(shares_are_marked),
        cmocka_unit_test(wrong_lists_are_refused_with_a_reason),
        cmocka_unit_test(cosines_of_round_angles_are_exact),
        cmocka_unit_test(gauss_nodes_integrate_polynomials),
        cmocka_unit_test(azimuths_integrate_cosines),
        cmocka_unit_test(numbers_read_back_the_same),
        cmocka_unit_test(numbers_are_short),
        cmocka_unit_test(numbers_have_the_fewest_digits_and_the_nearest),
        cmocka_unit_test(misspelt_words_are_guessed),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
