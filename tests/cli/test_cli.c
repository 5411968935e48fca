/* What the program writes: CSV rules, the sidecar, refused rows, write errors.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>
#include <ppscat/ppscat.h>

#include "cli/columns.h"

#define SWEEP                                                                          \
    "--method spp,exact --albedo 0.5,0.9 --g 0,0.5 --thickness 1,10 --mu0 0.25,1 "     \
    "--tol 1e-3 "

/* The header row of a subcommand, from the contract. */
static const struct {
    const char *call, *header;
    size_t rows;
} outputs[] = {
    {"field", "method,albedo,g,thickness,mu0,depth,mu,phi,radiance\n", 3 * 16 * 3},
    {"field --thickness inf", "method,albedo,g,thickness,mu0,depth,mu,phi,radiance\n",
     16 * 3},
    {"field --thickness 1,inf --mu 1 --phi 0",
     "method,albedo,g,thickness,mu0,depth,mu,phi,radiance\n", 4},
    {"field " SWEEP "--mu -1:1:4 --phi 0,60 --depth 0,25%",
     "method,albedo,g,thickness,mu0,depth,mu,phi,radiance\n", 2 * 16 * 2 * 4 * 2},
    {"flux " SWEEP,
     "method,albedo,g,thickness,mu0,depth,flux_up,flux_down,flux_direct,"
     "mean_intensity_diffuse,mean_intensity\n",
     2 * 16 * 3},
    {"error --method spp,spp-refined --theta0 0,60",
     "method,albedo,g,thickness,mu0,rms_abs,rms_rel,max_abs,reflectance_error,"
     "transmittance_error,seconds\n",
     4},
};

static void header_and_rows_are_as_agreed(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++) {
        result r = program_run(outputs[i].call);
        assert_string_equal(r.err, "");
        assert_int_equal(r.status, 0);
        assert_int_equal(strncmp(r.out, outputs[i].header, strlen(outputs[i].header)),
                         0);
        assert_int_equal(count_lines(r.out), outputs[i].rows + 1);
        assert_null(strchr(r.out, '\r'));
        assert_int_equal(r.out[strlen(r.out) - 1], '\n');
        result_free(&r);
    }
}

static void every_method_is_listed(void **state) {
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    result r = program_run("methods");
    const char *line = next_line(r.out);

    (void)state;
    assert_int_equal(r.status, 0);
    assert_int_equal(
        strncmp(r.out, "name,cost,fields,fluxes,thickness_inf,summary,limits\n", 53),
        0);
    assert_int_equal(count_lines(r.out), n + 1);
    for (size_t i = 0; i < n; i++, line = next_line(line)) {
        char *name = csv_field(line, 0);
        assert_string_equal(name, table[i]->name);
        free(name);
    }
    result_free(&r);
}

/* The last column runs fastest. */
static void rows_are_in_the_order_of_the_columns(void **state) {
    static const char *const lists[] = {"spp,single", "0.5,0.9", "0,0.5", "1,10",
                                        "0.25,1",     "0,1",     "-1,1",  "0,90"};
    result r = program_run("field --method spp,single --albedo 0.5,0.9 --g 0,0.5 "
                           "--thickness 1,10 --mu0 0.25,1 --depth 0,1 --mu -1,1 "
                           "--phi 0,90");
    const char *line = next_line(r.out);

    (void)state;
    for (unsigned row = 0; row < 256; row++, line = next_line(line)) {
        assert_non_null(line);
        for (size_t c = 0; c < 8; c++) {
            char *got = csv_field(line, c);
            char *want = csv_field(lists[c], row >> (7 - c) & 1u);
            assert_string_equal(got, want);
            free(got);
            free(want);
        }
    }
    assert_null(line);
    result_free(&r);
}

static void radiances_are_those_of_the_library_to_the_last_bit(void **state) {
    const double tau[] = {0, 0.5, 1}, mu[] = {-0.7, 0.3}, phi[] = {0, 120};
    const pps_slab slab = {0.8, 0.4, 1};
    const pps_grid grid = {3, 2, 2, tau, mu, phi};
    const pps_options options = {.tolerance = 1e-6};
    pps_model *model;
    double radiance[12];
    result r = program_run("field --albedo 0.8 --g 0.4 --thickness 1 --theta0 60 "
                           "--depth 0,0.5,100% --mu -0.7,0.3 --phi 0,120");
    const char *line = next_line(r.out);

    (void)state;
    assert_int_equal(
        pps_model_create(pps_method_find("exact"), &slab, &options, &model), PPS_OK);
    assert_int_equal(pps_model_solve(model, 1, 0.5), PPS_OK);
    assert_int_equal(pps_model_radiance(model, &grid, radiance), PPS_OK);
    pps_model_free(model);
    for (size_t i = 0; i < 12; i++, line = next_line(line)) {
        char *field = csv_field(line, 8);
        assert_true(strtod(field, NULL) == radiance[i]);
        free(field);
    }
    result_free(&r);
}

static void the_beam_scales_light_but_not_ratios(void **state) {
    result one = program_run("flux --method spp --mu0 0.5 --depth 1");
    result two = program_run("flux --method spp --mu0 0.5 --depth 1 --beam 2");

    (void)state;
    assert_int_equal(two.status, 0);
    for (size_t c = 6; c <= 10; c++) {
        char *x = csv_field(next_line(one.out), c),
             *y = csv_field(next_line(two.out), c);
        assert_true(strtod(y, NULL) == 2 * strtod(x, NULL));
        free(x);
        free(y);
    }
    result_free(&one);
    result_free(&two);
    one = program_run("error --method spp");
    two = program_run("error --method spp --beam 2");
    for (size_t c = 5; c <= 9; c++) {
        char *x = csv_field(next_line(one.out), c),
             *y = csv_field(next_line(two.out), c);
        double scale = c == 5 || c == 7 ? 2 : 1; /* rms_abs, max_abs */
        assert_true(strtod(y, NULL) == scale * strtod(x, NULL));
        free(x);
        free(y);
    }
    result_free(&one);
    result_free(&two);
}

static void angles_and_cosines_say_the_same(void **state) {
    result a = program_run("field --method spp --theta0 60,0 --theta 0,60,120,180");
    result b = program_run("field --method spp --mu0 0.5,1 --mu 1,0.5,-0.5,-1");

    (void)state;
    assert_int_equal(a.status, 0);
    assert_string_equal(a.out, b.out);
    result_free(&a);
    result_free(&b);
}

static void the_locale_does_not_matter(void **state) {
    result a = program_run("flux --method spp");
    result b =
        program_shell("LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 \"$P\" flux --method spp");

    (void)state;
    assert_string_equal(a.out, b.out);
    result_free(&a);
    result_free(&b);
}

static void threads_do_not_change_a_byte(void **state) {
    static const char *const calls[] = {"field " SWEEP, "flux " SWEEP};

    (void)state;
    for (size_t i = 0; i < 2; i++) {
        char line[512];
        result one, more;
        snprintf(line, sizeof line, "%s -j 1", calls[i]);
        one = program_run(line);
        snprintf(line, sizeof line, "%s -j 3", calls[i]);
        more = program_run(line);
        assert_int_equal(one.status, 0);
        assert_string_equal(one.out, more.out);
        result_free(&one);
        result_free(&more);
    }
}

/* All but the last column, which is a time. */
static void threads_do_not_change_an_error(void **state) {
    result one = program_run("error " SWEEP "-j 1"),
           more = program_run("error " SWEEP "-j 3");
    const char *a = one.out, *b = more.out;

    (void)state;
    assert_int_equal(one.status, 0);
    for (; a && b; a = next_line(a), b = next_line(b)) {
        for (size_t c = 0; c < 10; c++) {
            char *x = csv_field(a, c), *y = csv_field(b, c);
            assert_string_equal(x, y);
            free(x);
            free(y);
        }
    }
    assert_true(!a && !b);
    result_free(&one);
    result_free(&more);
}

static void exact_has_no_error(void **state) {
    result r = program_run("error --thickness 1,inf --albedo 0,0.9");
    const char *line = next_line(r.out);

    (void)state;
    assert_int_equal(r.status, 0);
    for (; line; line = next_line(line)) {
        char *inf = csv_field(line, 3), *transmitted = csv_field(line, 9);
        bool half_space = strcmp(inf, "inf") == 0;
        for (size_t c = 5; c < 9; c++) {
            char *value = csv_field(line, c);
            assert_string_equal(value, "0");
            free(value);
        }
        assert_string_equal(transmitted, half_space ? "" : "0");
        free(inf);
        free(transmitted);
    }
    result_free(&r);
}

static void refused_rows_stay_empty_and_say_why_once(void **state) {
    result full = program_run("field --method single --mu 1,-1 --phi 0");
    result r = program_run("field --method single --mu 1,-1 --phi 0 --sky 0.5");

    (void)state;
    assert_int_equal(full.status, 0);
    assert_int_equal(r.status, 3);
    assert_int_equal(count_lines(r.out), count_lines(full.out));
    assert_int_equal(count_lines(r.err), 1); /* one a method and reason */
    assert_non_null(strstr(r.err, "single"));
    for (const char *line = next_line(r.out); line; line = next_line(line)) {
        char *value = csv_field(line, 8);
        assert_string_equal(value, "");
        free(value);
    }
    result_free(&full);
    result_free(&r);
}

static void only_what_a_method_cannot_do_is_refused(void **state) {
    result r = program_run("flux --delta-m on --g 0.5,-0.5 --depth 0 -o refused.csv");
    char *csv = read_file("refused.csv");
    char *good = csv_field(next_line(csv), 6), *refused;

    (void)state;
    assert_int_equal(r.status, 3);
    assert_int_equal(count_lines(r.err), 1);
    assert_int_equal(count_lines(csv), 3);
    refused = csv_field(next_line(next_line(csv)), 6);
    assert_true(strtod(good, NULL) > 0);
    assert_string_equal(refused, "");
    free(good);
    free(refused);
    free(csv);
    result_free(&r);
}

static void a_file_appears_complete_with_its_sidecar(void **state) {
    result shown = program_run("flux --method spp"), kept;
    char *csv;

    (void)state;
    kept = program_run("flux --method spp -o flux.csv");
    csv = read_file("flux.csv");
    assert_int_equal(kept.status, 0);
    assert_string_equal(kept.out, "");
    assert_string_equal(csv, shown.out);
    assert_true(file_exists("flux.csv-metadata.json"));
    assert_false(file_exists("flux.csv.part"));
    assert_false(file_exists("flux.csv-metadata.json.part"));
    free(csv);
    result_free(&shown);
    result_free(&kept);
}

static const char *string_at(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));

    assert_non_null(text);
    return text;
}

/* What makes a subcommand quick. */
static const char *quick(int subcommand) {
    switch (subcommand) {
    case SUB_METHODS:
        return "";
    case SUB_TABLE:
        return "1 --tol 0.1";
    case SUB_CHART:
        return "--method spp";
    case SUB_STABILITY:
        return "--method spp --albedo 0.5 --g 0 --thickness 1";
    case SUB_TREE_IRRADIANCE:
        return "bush.obj";
    case SUB_TREE_MODELS:
        return "";
    default:
        return "--tol 0.1";
    }
}

/* Those whose -o is a mesh or a picture have no sidecar. */
static bool writes_csv(int subcommand) {
    return subcommand != SUB_TREE_GROW && subcommand != SUB_TREE_RENDER;
}

static void the_sidecar_describes_every_column(void **state) {
    result bush = program_run("tree grow --crown uniform --leaves 20 -o bush.obj");

    (void)state;
    assert_int_equal(bush.status, 0);
    result_free(&bush);
    for (int s = 0; s < SUB_COUNT; s++) {
        if (!writes_csv(s))
            continue;
        char call[128];
        const column *c = columns_of((subcommand_id)s);
        const char *name = subcommand_table[s].name;
        json_t *json, *columns;
        result r;
        snprintf(call, sizeof call, "%s -o out.csv %s", name, quick(s));
        r = program_run(call);
        assert_int_equal(r.status, 0);
        json = json_load_file("out.csv-metadata.json", 0, NULL);
        assert_non_null(json);
        assert_string_equal(string_at(json, "@context"), "http://www.w3.org/ns/csvw");
        assert_string_equal(string_at(json, "url"), "out.csv");
        columns = json_object_get(json_object_get(json, "tableSchema"), "columns");
        for (size_t i = 0; c->name; i++, c++) {
            json_t *entry = json_array_get(columns, i);
            assert_string_equal(string_at(entry, "name"), c->name);
            assert_true(*string_at(entry, "dc:description"));
            if (strcmp(string_at(entry, "datatype"), "double") == 0)
                assert_true(*string_at(entry, "schema:unitText"));
        }
        json_decref(json);
        result_free(&r);
    }
}

static void the_sidecar_says_how_the_file_was_made(void **state) {
    result r = program_run("flux --streams 16 --g 0,0.5 -o used.csv");
    json_t *json, *note, *used, *command;

    (void)state;
    assert_int_equal(r.status, 0);
    json = json_load_file("used.csv-metadata.json", 0, NULL);
    note = json_array_get(json_object_get(json, "notes"), 0);
    used = json_object_get(note, "used");
    command = json_object_get(note, "command");
    assert_string_equal(string_at(note, "version"), pps_version());
    assert_int_equal(strlen(string_at(note, "date")), strlen("2000-01-01T00:00:00Z"));
    assert_int_equal(json_array_size(command), 8);
    assert_string_equal(json_string_value(json_array_get(command, 3)), "16");
    assert_int_equal(json_integer_value(json_object_get(note, "rows")), 6);
    assert_int_equal(json_integer_value(json_object_get(note, "refused_rows")), 0);
    assert_int_equal(
        json_integer_value(json_object_get(json_object_get(used, "streams"), "min")),
        16);
    assert_true(json_array_size(json_object_get(used, "nodes")) >= 1);
    assert_true(json_array_size(json_object_get(used, "counts")) >= 1);
    json_decref(json);
    result_free(&r);
}

static void a_full_disk_is_exit_1_and_leaves_nothing(void **state) {
    result r = program_shell("trap '' XFSZ; ulimit -f 8\n"
                             "\"$P\" flux --method spp --depth 0:10:5000 -o big.csv");

    (void)state;
    assert_int_equal(r.status, 1);
    assert_int_equal(count_lines(r.err), 1);
    assert_non_null(strstr(r.err, "big.csv"));
    assert_false(file_exists("big.csv"));
    assert_false(file_exists("big.csv.part"));
    assert_false(file_exists("big.csv-metadata.json"));
    result_free(&r);
}

static void a_failed_run_keeps_the_file_that_was_there(void **state) {
    result r = program_shell("echo old >kept.csv; trap '' XFSZ; ulimit -f 8\n"
                             "\"$P\" flux --method spp --depth 0:10:5000 -o kept.csv");
    char *kept = read_file("kept.csv");

    (void)state;
    assert_int_equal(r.status, 1);
    assert_string_equal(kept, "old\n");
    free(kept);
    result_free(&r);
}

static void a_full_device_is_exit_1(void **state) {
    static const char *const calls[] = {
        "flux --method spp >/dev/full",
        "methods >/dev/full",
        "--help >/dev/full",
        "field --help >/dev/full",
        "--version >/dev/full",
        "methods -o /dev/full",
        "flux --method spp -o /dev/full",
        "methods >&-",
    };

    (void)state;
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
        result r = program_run(calls[i]);
        assert_int_equal(r.status, 1);
        assert_int_equal(count_lines(r.err), 1);
        result_free(&r);
    }
}

static void a_closed_pipe_is_exit_1_with_a_message(void **state) {
    result r = program_shell(
        "{ \"$P\" flux --method spp --depth 0:10:9999; echo $? >code; } | true");
    char *code = read_file("code");

    (void)state;
    assert_string_equal(code, "1\n");
    assert_int_equal(count_lines(r.err), 1);
    free(code);
    result_free(&r);
}

static void progress_is_shown_when_asked_for(void **state) {
    result quiet = program_run("flux --method spp");
    result loud = program_run("flux --method spp --mu0 0.1:1:10 --progress always");

    (void)state;
    assert_string_equal(quiet.err, "");
    assert_int_equal(loud.status, 0);
    assert_non_null(strstr(loud.err, "10 / 10 cases"));
    result_free(&quiet);
    result_free(&loud);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(header_and_rows_are_as_agreed),
        cmocka_unit_test(every_method_is_listed),
        cmocka_unit_test(rows_are_in_the_order_of_the_columns),
        cmocka_unit_test(radiances_are_those_of_the_library_to_the_last_bit),
        cmocka_unit_test(the_beam_scales_light_but_not_ratios),
        cmocka_unit_test(angles_and_cosines_say_the_same),
        cmocka_unit_test(the_locale_does_not_matter),
        cmocka_unit_test(threads_do_not_change_a_byte),
        cmocka_unit_test(threads_do_not_change_an_error),
        cmocka_unit_test(exact_has_no_error),
        cmocka_unit_test(refused_rows_stay_empty_and_say_why_once),
        cmocka_unit_test(only_what_a_method_cannot_do_is_refused),
        cmocka_unit_test(a_file_appears_complete_with_its_sidecar),
        cmocka_unit_test(the_sidecar_describes_every_column),
        cmocka_unit_test(the_sidecar_says_how_the_file_was_made),
        cmocka_unit_test(a_full_disk_is_exit_1_and_leaves_nothing),
        cmocka_unit_test(a_failed_run_keeps_the_file_that_was_there),
        cmocka_unit_test(a_full_device_is_exit_1),
        cmocka_unit_test(a_closed_pipe_is_exit_1_with_a_message),
        cmocka_unit_test(progress_is_shown_when_asked_for),
    };

    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
