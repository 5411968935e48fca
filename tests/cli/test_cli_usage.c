/* Bad usage and bad input: exit 2 with one line; and what --help and the man page say.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options.h"

/* The arguments, and words that the line on standard error must hold. */
static const struct {
    const char *arguments, *option, *value, *allowed;
} bad[] = {
    {"field --albedo 1.2", "--albedo", "1.2", "0 to 1"},
    {"field --albedo=-0.1", "--albedo", "-0.1", "0 to 1"},
    {"field --albedo nan", "--albedo", "nan", "0 to 1"},
    {"field --albedo ''", "--albedo", "''", "0 to 1"},
    {"field --albedo 0.5,,0.9", "--albedo", "''", "0 to 1"},
    {"field --albedo 0.5,", "--albedo", "''", "0 to 1"},
    {"field --albedo half", "--albedo", "half", "0 to 1"},
    {"field --albedo 0.5x", "--albedo", "0.5x", "0 to 1"},
    {"field --albedo 0:1:0", "--albedo", "0:1:0", "0 to 1"},
    {"field --albedo 0:1:1", "--albedo", "0:1:1", "0 to 1"},
    {"field --albedo 0:1.5:4", "--albedo", "1.5", "0 to 1"},
    {"field --albedo 0:1:3log", "--albedo", "0:1:3log", "0 to 1"},
    {"field --albedo inf", "--albedo", "inf", "0 to 1"},
    {"field --albedo", "--albedo", "needs a value", "LIST"},
    {"field --g 1", "--g", "'1'", "-1 and 1"},
    {"field --g -1", "--g", "'-1'", "-1 and 1"},
    {"field --g 0.5,1.5", "--g", "1.5", "-1 and 1"},
    {"field --thickness 0", "--thickness", "'0'", "above 0"},
    {"field --thickness nan", "--thickness", "nan", "above 0"},
    {"field --thickness -1", "--thickness", "-1", "above 0"},
    {"field --thickness -inf", "--thickness", "-inf", "above 0"},
    {"field --mu0 0", "--mu0", "'0'", "above 0"},
    {"field --mu0 1.1", "--mu0", "1.1", "up to 1"},
    {"field --mu0 -0.5", "--mu0", "-0.5", "above 0"},
    {"field --theta0 90", "--theta0", "90", "not 90"},
    {"field --theta0 -1", "--theta0", "-1", "from 0"},
    {"field --mu0 0.5 --theta0 60", "--theta0", "60", "one of them"},
    {"field --mu 0", "--mu", "'0'", "never 0"},
    {"field --mu 0.5,-1.01", "--mu", "-1.01", "-1 to 1"},
    {"field --theta 90", "--theta", "90", "never 90"},
    {"field --theta 181", "--theta", "181", "0 to 180"},
    {"field --mu 0.5 --theta 60", "--theta", "60", "one of them"},
    {"field --phi north", "--phi", "north", "degrees"},
    {"field --depth 11", "--depth", "11", "thickness"},
    {"field --depth 5 --thickness 10,1", "--depth", "'5'", "thickness"},
    {"field --depth -1", "--depth", "-1", "from 0"},
    {"field --depth 101%", "--depth", "101%", "100%"},
    {"field --depth 25% --thickness inf", "--depth", "25%", "inf"},
    {"field --depth 0%:50%:3", "--depth", "0%:50%:3", "thickness"},
    {"field --depth inf --thickness inf", "--depth", "inf", "thickness"},
    {"field --streams 7", "--streams", "7", "even"},
    {"field --streams 0", "--streams", "0", "even"},
    {"field --streams 1026", "--streams", "1026", "1024"},
    {"field --streams 16.0", "--streams", "16.0", "even"},
    {"field --streams -4", "--streams", "-4", "even"},
    {"field --streams many", "--streams", "many", "auto"},
    {"field --nodes chebyshev", "--nodes", "chebyshev", "mapped"},
    {"field --delta-m maybe", "--delta-m", "maybe", "off"},
    {"field --delta-m off --nodes mapped", "--nodes", "mapped", "gauss"},
    {"field --tol 0", "--tol", "'0'", "between 0 and 1"},
    {"field --tol 1", "--tol", "'1'", "between 0 and 1"},
    {"field --tol 1e-4,1e-6", "--tol", "1e-4,1e-6", "one number"},
    {"field --beam -1", "--beam", "-1", "0 or more"},
    {"field --sky -1", "--sky", "-1", "0 or more"},
    {"field --ground 1.5", "--ground", "1.5", "0 to 1"},
    {"field --method montecarlo", "--method", "montecarlo", "exact"},
    {"field --method exact,", "--method", "''", "exact"},
    {"field --method spp-refine", "--method", "spp-refine",
     "did you mean 'spp-refined'"},
    {"field -j 0", "--jobs", "'0'", "from 1"},
    {"field -j two", "--jobs", "two", "from 1"},
    {"field --progress loud", "--progress", "loud", "never"},
    {"field --resume", "--resume", "-o FILE", ""},
    {"field --resume=yes", "--resume", "no value", ""},
    {"field -o ''", "--output", "empty", ""},
    {"field -o nowhere/field.csv", "--output", "nowhere/field.csv", "No such file"},
    {"field -o .", "--output", "'.'", "directory"},
    {"flux -o nowhere/flux.csv", "--output", "nowhere/flux.csv", "No such file"},
    {"field --albdo 0.5", "--albdo", "did you mean --albedo", "--help"},
    {"field --zebra", "--zebra", "unknown", "--help"},
    {"field -z", "-z", "unknown", "--help"},
    {"field extra", "extra", "unexpected", "field"},
    {"methods --albedo 0.5", "--albedo", "methods", "--help"},
    {"error --albedo 2", "--albedo", "'2'", "0 to 1"},
    {"flux --mu0 nan", "--mu0", "nan", "above 0"},
    {"table", "table", "''", "1, 2"},
    {"table 9", "table", "'9'", "1, 2, 3, 4, 5, figure7, fps, crowns"},
    {"table 1 --rays 5", "--rays", "'5'", "table 3, crowns"},
    {"table fps --tree x.obj", "--tree", "'x.obj'", "table crowns"},
    {"table 3 --tol 0.1", "--tol", "'0.1'", "table 1, 2"},
    {"flux --method spp,spp", "--method", "'spp'", "each method once"},
    {"table 1 2", "table", "'2'", "one N"},
    {"table 1 --albedo 0.5", "--albedo", "table", "--help"},
    {"fields", "fields", "did you mean 'field'", "flux"},
    {"melt", "melt", "unknown subcommand", "field"},
    {"--albedo 0.5", "--albedo", "subcommand", "--help"},
};

static void bad_input_is_exit_2_and_one_line(void **state) {
    size_t failures = 0;

    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        result r = program_run(bad[i].arguments);
        bool good = r.status == 2 && !*r.out && count_lines(r.err) == 1 &&
                    strstr(r.err, bad[i].option) && strstr(r.err, bad[i].value) &&
                    strstr(r.err, bad[i].allowed);
        if (!good)
            print_error("ppscat %s: exit %d, said: %s", bad[i].arguments, r.status,
                        r.err);
        failures += !good;
        result_free(&r);
    }
    assert_int_equal(failures, 0);
}

static void a_value_with_a_line_end_still_gives_one_line(void **state) {
    result r = program_run("field --albedo '0.5\n0.9'");

    (void)state;
    assert_int_equal(r.status, 2);
    assert_int_equal(count_lines(r.err), 1);
    result_free(&r);
}

static void no_subcommand_prints_usage_on_stderr(void **state) {
    result r = program_run("");

    (void)state;
    assert_int_equal(r.status, 2);
    assert_string_equal(r.out, "");
    assert_non_null(strstr(r.err, "Usage: ppscat"));
    result_free(&r);
}

static void version_is_on_stdout(void **state) {
    static const char *const calls[] = {"--version", "field --version"};

    (void)state;
    for (size_t i = 0; i < 2; i++) {
        result r = program_run(calls[i]);
        assert_int_equal(r.status, 0);
        assert_int_equal(strncmp(r.out, "ppscat ", 7), 0);
        assert_string_equal(r.err, "");
        result_free(&r);
    }
}

static void program_help_lists_all_subcommands(void **state) {
    static const char *const calls[] = {"--help", "-h"};

    (void)state;
    for (size_t i = 0; i < 2; i++) {
        result r = program_run(calls[i]);
        assert_int_equal(r.status, 0);
        assert_string_equal(r.err, "");
        for (int s = 0; s < SUB_COUNT; s++)
            assert_non_null(strstr(r.out, subcommand_table[s].summary));
        result_free(&r);
    }
}

static void help_lists_every_option_within_79_columns(void **state) {
    (void)state;
    for (int s = 0; s < SUB_COUNT; s++) {
        char call[64];
        result r;
        snprintf(call, sizeof call, "%s --help", subcommand_table[s].name);
        r = program_run(call);
        assert_int_equal(r.status, 0);
        assert_string_equal(r.err, "");
        for (int i = 0; i < OPT_COUNT; i++) {
            char name[64];
            snprintf(name, sizeof name, "--%s", option_table[i].name);
            if (option_taken_by((option_id)i, (subcommand_id)s))
                assert_non_null(strstr(r.out, name));
        }
        for (const char *line = r.out; line; line = next_line(line))
            assert_true(strcspn(line, "\n") <= 79);
        result_free(&r);
    }
}

static void man_page_has_every_option_and_subcommand(void **state) {
    char *page = read_file(PPSCAT_MAN_PAGE);

    (void)state;
    assert_non_null(page);
    for (int i = 0; i < OPT_COUNT; i++) {
        char name[64], *to = name;
        to += sprintf(to, "\\-\\-");
        for (const char *from = option_table[i].name; *from; from++)
            to += sprintf(to, *from == '-' ? "\\-" : "%c", *from);
        if (!strstr(page, name))
            fail_msg("the man page lacks --%s", option_table[i].name);
    }
    for (int s = 0; s < SUB_COUNT; s++) {
        char name[64];
        snprintf(name, sizeof name, ".B %s", subcommand_table[s].name);
        assert_non_null(strstr(page, name));
    }
    free(page);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_input_is_exit_2_and_one_line),
        cmocka_unit_test(a_value_with_a_line_end_still_gives_one_line),
        cmocka_unit_test(no_subcommand_prints_usage_on_stderr),
        cmocka_unit_test(version_is_on_stdout),
        cmocka_unit_test(program_help_lists_all_subcommands),
        cmocka_unit_test(help_lists_every_option_within_79_columns),
        cmocka_unit_test(man_page_has_every_option_and_subcommand),
    };

    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
