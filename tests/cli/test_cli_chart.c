/* Speed against accuracy: the rows of `chart`, and that its errors are those of `error`.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/ppscat.h>

static const char header[] = "method,setting,albedo,g,thickness,mu0,rms_abs,rms_rel,"
                             "reflectance_error,setup_seconds,seconds,evaluations\n";
enum { RMS_ABS = 6, RMS_REL, REFLECTANCE, SETUP, SECONDS, EVALUATIONS };

#define SLAB "--albedo 0.9 --g 0.5 --thickness 1 --mu0 0.6 "

static double number(const char *line, size_t i) {
    char *text = csv_field(line, i);
    double x = *text ? strtod(text, NULL) : (double)NAN;

    free(text);
    return x;
}

static void assert_field(const char *line, size_t i, const char *want) {
    char *got = csv_field(line, i);

    assert_string_equal(got, want);
    free(got);
}

static void exact_is_charted_with_every_setting(void **state) {
    static const char *const settings[] = {"streams=4",  "streams=8",  "streams=16",
                                           "streams=32", "streams=64", "tol=1e-06"};
    result r = program_run("chart --method exact " SLAB);
    const char *line = next_line(r.out);
    double last = 1;

    (void)state;
    assert_string_equal(r.err, "");
    assert_int_equal(r.status, 0);
    assert_int_equal(strncmp(r.out, header, strlen(header)), 0);
    assert_int_equal(count_lines(r.out), 7);
    for (size_t i = 0; i < 6; i++, line = next_line(line)) {
        assert_field(line, 0, "exact");
        assert_field(line, 1, settings[i]);
        if (i < 5) /* four streams have the aureole from its correction: 9 times to 8 */
            assert_true(number(line, RMS_REL) < (i == 1 ? 0.2 : 0.1) * last);
        last = number(line, RMS_REL);
        assert_true(number(line, REFLECTANCE) < 0.1);
    }
    assert_true(last < 1e-6);
    result_free(&r);
}

static void times_are_there(void **state) {
    result r = program_run("chart --method exact,spp,single " SLAB);

    (void)state;
    assert_int_equal(count_lines(r.out), 9);
    for (const char *line = next_line(r.out); line; line = next_line(line)) {
        double n = number(line, EVALUATIONS), seconds = number(line, SECONDS);
        assert_true(number(line, SETUP) >= 0 && seconds > 0);
        assert_true(n >= 3 && n * seconds > 1e-3);
    }
    result_free(&r);
}

static void errors_are_those_of_the_error_command(void **state) {
    result chart = program_run("chart --method spp,spp-refined,hemispheric " SLAB);
    result error =
        program_run("error --tol 1e-10 --method spp,spp-refined,hemispheric " SLAB);
    const char *a = next_line(chart.out), *b = next_line(error.out);

    (void)state;
    assert_int_equal(chart.status, 0);
    assert_int_equal(error.status, 0);
    for (; a && b; a = next_line(a), b = next_line(b)) {
        assert_field(a, 1, "-");
        assert_true(fabs(number(a, RMS_ABS) / number(b, 5) - 1) < 1e-7);
        assert_true(fabs(number(a, RMS_REL) / number(b, 6) - 1) < 1e-7);
        assert_true(fabs(number(a, REFLECTANCE) / number(b, 8) - 1) < 1e-7);
    }
    assert_true(!a && !b);
    result_free(&chart);
    result_free(&error);
}

/* The last list runs fastest; a method and setting stay together. */
static void rows_are_in_the_order_of_the_columns(void **state) {
    static const char *const want[4][4] = {{"0.5", "0", "1", "0.3"},
                                           {"0.5", "0", "1", "1"},
                                           {"0.5", "0", "inf", "0.3"},
                                           {"0.5", "0", "inf", "1"}};
    result r = program_run("chart --method spp,hemispheric --albedo 0.5 --thickness "
                           "1,inf --mu0 0.3,1 --mu -0.5 --phi 0");
    const char *line = next_line(r.out);

    (void)state;
    assert_int_equal(r.status, 0);
    for (size_t i = 0; i < 8; i++, line = next_line(line)) {
        assert_non_null(line);
        assert_field(line, 0, i < 4 ? "spp" : "hemispheric");
        for (size_t c = 0; c < 4; c++)
            assert_field(line, 2 + c, want[i % 4][c]);
    }
    assert_null(line);
    result_free(&r);
}

static void the_fixed_set_is_four_slabs_and_two_beams(void **state) {
    result r = program_run("chart --method spp");
    const char *line = next_line(r.out);

    (void)state;
    assert_int_equal(r.status, 0);
    assert_int_equal(count_lines(r.out), 9);
    assert_field(line, 4, "0.1");
    assert_field(line, 5, "0.25");
    result_free(&r);
}

/* The first method that gives fluxes only, or NULL. */
static const pps_method *fluxes_only(void) {
    size_t n;
    const pps_method *const *table = pps_method_table(&n);

    for (size_t i = 0; i < n; i++) {
        if (!table[i]->fields)
            return table[i];
    }
    return NULL;
}

static void methods_without_radiances_have_the_reflectance_alone(void **state) {
    const pps_method *method = fluxes_only();
    char command[160];
    result r;

    (void)state;
    if (!method)
        return;
    snprintf(command, sizeof command, "chart " SLAB "--method %s", method->name);
    r = program_run(command);
    assert_int_equal(r.status, 0);
    assert_field(next_line(r.out), RMS_ABS, "");
    assert_field(next_line(r.out), RMS_REL, "");
    assert_true(number(next_line(r.out), REFLECTANCE) >= 0);
    result_free(&r);
}

static void a_refusal_leaves_its_row_and_says_why(void **state) {
    result r = program_run("chart --method spp,single --sky 0.3 " SLAB);
    const char *line = next_line(r.out), *refused = next_line(line);

    (void)state;
    assert_int_equal(r.status, 3);
    assert_int_equal(count_lines(r.err), 1);
    assert_non_null(strstr(r.err, "single"));
    assert_true(number(line, RMS_REL) > 0);
    assert_field(refused, 1, "-");
    for (size_t i = RMS_ABS; i <= EVALUATIONS; i++)
        assert_field(refused, i, "");
    result_free(&r);
}

static void what_it_sweeps_itself_is_no_option(void **state) {
    static const char *const bad[] = {"--streams 8", "--tol 1e-3", "-j 2"};

    (void)state;
    for (size_t i = 0; i < 3; i++) {
        char command[80];
        result r;
        snprintf(command, sizeof command, "chart %s", bad[i]);
        r = program_run(command);
        assert_int_equal(r.status, 2);
        assert_int_equal(count_lines(r.err), 1);
        result_free(&r);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_is_charted_with_every_setting),
        cmocka_unit_test(times_are_there),
        cmocka_unit_test(errors_are_those_of_the_error_command),
        cmocka_unit_test(rows_are_in_the_order_of_the_columns),
        cmocka_unit_test(the_fixed_set_is_four_slabs_and_two_beams),
        cmocka_unit_test(methods_without_radiances_have_the_reflectance_alone),
        cmocka_unit_test(a_refusal_leaves_its_row_and_says_why),
        cmocka_unit_test(what_it_sweeps_itself_is_no_option),
    };
    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
