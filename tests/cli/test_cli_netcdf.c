/* --format netcdf holds what the CSV holds, one axis a parameter.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <netcdf.h>

enum { MOST_AXES = 8 };

/* Sweeps without refusals, their axes, and the first column of results. */
static const struct {
    const char *call;
    int n_axes;
    size_t length[MOST_AXES];
    const char *depth_axis, *variable;
    size_t column;
} sweeps[] = {
    {"flux --method spp,exact --albedo 0.5,0.9 --g 0,0.5 --thickness 1,10 --mu0 0.25,1",
     6,
     {2, 2, 2, 2, 2, 3},
     "share",
     "flux_up",
     6},
    {"flux --mu0 0.1:1:7 --thickness 1,3 --depth 0,0.5,1",
     6,
     {1, 1, 1, 2, 7, 3},
     "depth",
     "flux_up",
     6},
    {"flux --thickness 1,3 --depth 0.5,100%",
     6,
     {1, 1, 1, 2, 1, 2},
     "level",
     "flux_up",
     6},
    {"field --method spp,exact --thickness 1,10 --mu -1:1:6 --phi 0:180:5",
     8,
     {2, 1, 1, 2, 1, 3, 6, 5},
     "share",
     "radiance",
     8},
    {"field --method hemispheric,spp --mu 0.01:1:100 --phi 0:180:91 --depth 0:10:11 "
     "--mu0 "
     "0.5,1", /* more than one chunk, and more than one unit a case */
     8,
     {2, 1, 1, 1, 2, 11, 100, 91},
     "depth",
     "radiance",
     8},
    {"error --method exact,spp,spp-refined --albedo 0.5,0.9 --mu0 0.25,1 --streams 16",
     5,
     {3, 2, 1, 1, 2},
     NULL,
     "rms_abs",
     5},
};
enum { N_SWEEPS = sizeof sweeps / sizeof sweeps[0] };

static void good(int status) {
    if (status)
        fail_msg("%s", nc_strerror(status));
}

static int make(const char *call, const char *file) {
    char line[512];
    result r;
    int id;

    snprintf(line, sizeof line, "%s --format netcdf -o %s", call, file);
    r = program_run(line);
    if (r.status != 0 && r.status != 3)
        fail_msg("%s: %s", line, r.err);
    result_free(&r);
    good(nc_open(file, NC_NOWRITE, &id));
    return id;
}

static int variable_of(int id, const char *name) {
    int variable;

    good(nc_inq_varid(id, name, &variable));
    return variable;
}

static void every_value_is_that_of_the_csv(void **state) {
    (void)state;
    for (size_t s = 0; s < N_SWEEPS; s++) {
        int id = make(sweeps[s].call, "out.nc");
        int variable = variable_of(id, sweeps[s].variable);
        result csv = program_run(sweeps[s].call);
        const char *line = next_line(csv.out);
        size_t n = 1;
        double *value;
        for (int i = 0; i < sweeps[s].n_axes; i++)
            n *= sweeps[s].length[i];
        value = calloc(n, sizeof *value);
        assert_non_null(value);
        good(nc_get_var_double(id, variable, value));
        for (size_t i = 0; i < n; i++, line = next_line(line)) {
            char *field = csv_field(line, sweeps[s].column);
            assert_true(strtod(field, NULL) == value[i]);
            free(field);
        }
        assert_null(line);
        free(value);
        result_free(&csv);
        good(nc_close(id));
    }
}

static void every_parameter_is_an_axis_with_its_coordinate(void **state) {
    static const char *const names[] = {"method", "albedo", "g",  "thickness",
                                        "mu0",    NULL,     "mu", "phi"};

    (void)state;
    for (size_t s = 0; s < N_SWEEPS; s++) {
        int id = make(sweeps[s].call, "out.nc"), n, axis[NC_MAX_VAR_DIMS];
        good(nc_inq_var(id, variable_of(id, sweeps[s].variable), NULL, NULL, &n, axis,
                        NULL));
        assert_int_equal(n, sweeps[s].n_axes);
        for (int i = 0; i < n; i++) {
            const char *want = i == 5 ? sweeps[s].depth_axis : names[i];
            char name[NC_MAX_NAME + 1], text[256] = "";
            size_t length;
            int own, coordinate = variable_of(id, want);
            good(nc_inq_dim(id, axis[i], name, &length));
            assert_string_equal(name, want);
            assert_int_equal(length, sweeps[s].length[i]);
            good(nc_inq_vardimid(id, coordinate, &own));
            assert_int_equal(own, axis[i]);
            good(nc_get_att_text(id, coordinate, "long_name", text));
            assert_true(*text);
        }
        good(nc_close(id));
    }
}

static void axes_have_the_values_of_the_lists(void **state) {
    int id = make(sweeps[0].call, "out.nc");
    double mu0[2], share[3], depth[6];
    char *method[2], units[16] = "", text[16] = "";

    (void)state;
    good(nc_get_var_double(id, variable_of(id, "mu0"), mu0));
    assert_true(mu0[0] == 0.25 && mu0[1] == 1);
    good(nc_get_var_double(id, variable_of(id, "share"), share));
    assert_true(share[0] == 0 && share[1] == 0.5 && share[2] == 1);
    good(nc_get_var_double(id, variable_of(id, "depth"), depth));
    assert_true(depth[2] == 1 && depth[4] == 5 && depth[5] == 10);
    good(nc_get_var_string(id, variable_of(id, "method"), method));
    assert_string_equal(method[0], "spp");
    assert_string_equal(method[1], "exact");
    good(nc_free_string(2, method));
    good(nc_get_att_text(id, variable_of(id, "mean_intensity"), "units", units));
    assert_string_equal(units, "1/sr");
    good(nc_get_att_text(id, NC_GLOBAL, "Conventions", text));
    assert_string_equal(text, "CF-1.8");
    good(nc_close(id));
}

/* A half-space has no level but the first; `single` refuses sky light. */
static void what_is_missing_is_the_fill_value(void **state) {
    int id = make("flux --method single,exact --thickness 1,inf --sky 1", "out.nc");
    int variable = variable_of(id, "flux_up");
    double value[12], fill;

    (void)state;
    good(nc_get_att_double(id, variable, "_FillValue", &fill));
    good(nc_get_var_double(id, variable, value));
    for (size_t i = 0; i < 12; i++) {
        bool missing = i < 6 || i > 9;
        assert_true((value[i] == fill) == missing);
    }
    good(nc_close(id));
}

static void deflated_values_are_the_same(void **state) {
    int plain = make(sweeps[3].call, "plain.nc"), packed;
    double a[360], b[360];
    char call[256];
    int on, level;

    (void)state;
    snprintf(call, sizeof call, "%s --deflate 4", sweeps[3].call);
    packed = make(call, "packed.nc");
    good(
        nc_inq_var_deflate(packed, variable_of(packed, "radiance"), NULL, &on, &level));
    assert_true(on == 1 && level == 4);
    good(nc_get_var_double(plain, variable_of(plain, "radiance"), a));
    good(nc_get_var_double(packed, variable_of(packed, "radiance"), b));
    assert_memory_equal(a, b, sizeof a);
    good(nc_close(plain));
    good(nc_close(packed));
}

/* Killed, then resumed with -j 1: the same numbers, though the date differs. Photons take
 * long enough to be killed amid them. */
static void a_killed_run_goes_on(void **state) {
    const char *sweep =
        "flux --method mc --photons 100 --albedo 0.5:1:40 --thickness 1:10:10 "
        "--mu0 0.02:1:50 --format netcdf";
    char line[512];
    result r;
    bool left = false;
    static double a[60000], b[60000];
    int whole, killed;

    (void)state;
    for (double seconds = 0.3; !left && seconds < 20; seconds *= 1.3) {
        snprintf(line, sizeof line,
                 "rm -f k.nc*; timeout -s KILL %.2f \"$P\" %s -o k.nc; test -f "
                 "k.nc.part-values && grep -q '\"units\": [1-9]' k.nc.part-journal",
                 seconds, sweep);
        r = program_shell(line);
        left = r.status == 0;
        result_free(&r);
    }
    assert_true(left);
    snprintf(line, sizeof line, "%s -o k.nc --resume -j 1", sweep);
    r = program_run(line);
    assert_int_equal(r.status, 0);
    assert_false(file_exists("k.nc.part-values"));
    assert_false(file_exists("k.nc.part-journal"));
    result_free(&r);
    whole = make("flux --method mc --photons 100 --albedo 0.5:1:40 --thickness 1:10:10 "
                 "--mu0 0.02:1:50",
                 "w.nc");
    good(nc_open("k.nc", NC_NOWRITE, &killed));
    good(nc_get_var_double(whole, variable_of(whole, "flux_down"), a));
    good(nc_get_var_double(killed, variable_of(killed, "flux_down"), b));
    assert_memory_equal(a, b, sizeof a);
    good(nc_close(whole));
    good(nc_close(killed));
}

static void it_needs_a_file(void **state) {
    static const char *const calls[] = {
        "flux --format netcdf", "flux --format netcdf -o /dev/null",
        "flux --format netcdf -o x.nc --deflate 10", "flux -o x.csv --deflate 1"};

    (void)state;
    for (size_t i = 0; i < 4; i++) {
        result r = program_run(calls[i]);
        assert_int_equal(r.status, 2);
        assert_int_equal(count_lines(r.err), 1);
        result_free(&r);
    }
    assert_false(file_exists("x.nc"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value_is_that_of_the_csv),
        cmocka_unit_test(every_parameter_is_an_axis_with_its_coordinate),
        cmocka_unit_test(axes_have_the_values_of_the_lists),
        cmocka_unit_test(what_is_missing_is_the_fill_value),
        cmocka_unit_test(deflated_values_are_the_same),
        cmocka_unit_test(a_killed_run_goes_on),
        cmocka_unit_test(it_needs_a_file),
    };

    return cmocka_run_group_tests(tests, program_setup, program_teardown);
}
