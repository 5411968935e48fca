/* Tables 1 and 2 of the SPP paper as the program measures them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Refined SPP at thickness 10, in percent: an independent prototype by the same
 * sampling, to two decimals. Albedo 0.5, 0.7, 0.9, 0.95, 0.99. */
static const struct {
    const char *column;
    double value[5];
} refined[] = {
    {"g=0.0 R.", {0.13, 0.40, 1.43, 2.37, 5.17}},
    {"g=0.5 R.", {0.15, 0.43, 1.50, 2.57, 5.52}},
    {"g=-0.5 R.", {0.11, 0.33, 1.23, 2.07, 4.76}},
};

static const char *const rows[] = {"0.5", "0.7", "0.9", "0.95", "0.99"};

/* Field `field` of the row of that name and column; NAN where there is none. */
static double table_value(const char *csv, const char *row, const char *column,
                          size_t field) {
    double value = (double)NAN;

    for (const char *line = next_line(csv); line; line = next_line(line)) {
        char *r = csv_field(line, 1), *c = csv_field(line, 2),
             *v = csv_field(line, field);
        if (strcmp(r, row) == 0 && strcmp(c, column) == 0)
            value = strtod(v, NULL);
        free(r);
        free(c);
        free(v);
    }
    return value;
}

/* Within 2 % and half of the last printed digit. */
static void table_1_refined_is_what_the_prototype_gave(void **state) {
    result r = program_run("table 1");

    (void)state;
    assert_int_equal(r.status, 0);
    for (size_t j = 0; j < sizeof refined / sizeof refined[0]; j++) {
        for (size_t a = 0; a < 5; a++) {
            double got = table_value(r.out, rows[a], refined[j].column, 4);
            double want = refined[j].value[a];
            if (!(fabs(got - want) <= 0.02 * want + 0.005))
                fail_msg("%s at %s: %.4g, not %.4g", refined[j].column, rows[a], got,
                         want);
        }
    }
    result_free(&r);
}

static void table_1_unrefined_is_what_the_prototype_gave(void **state) {
    static const double g0[] = {0.43, 0.84, 2.02, 2.98, 5.71};
    result r = program_run("table 1");

    (void)state;
    for (size_t a = 0; a < 5; a++) {
        double got = table_value(r.out, rows[a], "g=0.0 S.", 4);
        assert_true(fabs(got - g0[a]) <= 0.02 * g0[a] + 0.005);
    }
    result_free(&r);
}

/* At thickness 10 Table 2 is the mean of the refined columns of Table 1. */
static void table_2_agrees_with_table_1(void **state) {
    result one = program_run("table 1"), two = program_run("table 2");

    (void)state;
    assert_int_equal(two.status, 0);
    assert_int_equal(count_lines(two.out), 1 + 6 * 4);
    for (size_t a = 0; a < 5; a++) {
        double mean = 0, got = table_value(two.out, rows[a], "w=10", 4);
        for (size_t j = 0; j < 3; j++)
            mean += table_value(one.out, rows[a], refined[j].column, 4) / 3;
        assert_true(fabs(got - mean) <= 1e-9 * mean);
    }
    result_free(&one);
    result_free(&two);
}

/* The sampling of the tables is that of `error`. */
static void a_table_is_a_run_of_error(void **state) {
    result table = program_run("table 1");
    result error = program_run("error --method spp-refined --albedo 0.9 --g 0.5 "
                               "--thickness 10 --theta0 0:75:6");
    double mean_square = 0, want = table_value(table.out, "0.9", "g=0.5 R.", 4);

    (void)state;
    for (const char *line = next_line(error.out); line; line = next_line(line)) {
        char *rms_abs = csv_field(line, 5);
        mean_square += pow(strtod(rms_abs, NULL), 2) / 6;
        free(rms_abs);
    }
    assert_true(fabs(100 * sqrt(mean_square) - want) <= 1e-9 * want);
    result_free(&table);
    result_free(&error);
}

/* Its rows are empty then, and growth of what was not measured is empty too. */
static void without_a_preview_its_rows_are_refused(void **state) {
    result r = program_shell("cp \"$P\" alone && PATH=/nowhere ./alone table 4");

    (void)state;
    assert_int_equal(r.status, 3);
    assert_non_null(strstr(r.err, "4 rows refused: ppscat-preview is not there"));
    assert_int_equal(count_lines(r.out), 1 + 4 + 2 * 4);
    assert_non_null(strstr(r.out, "\n4,CHERRY16,,,,,sppg,,,,,\n"));
    result_free(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_1_refined_is_what_the_prototype_gave),
        cmocka_unit_test(table_1_unrefined_is_what_the_prototype_gave),
        cmocka_unit_test(table_2_agrees_with_table_1),
        cmocka_unit_test(a_table_is_a_run_of_error),
        cmocka_unit_test(without_a_preview_its_rows_are_refused),
    };

    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
