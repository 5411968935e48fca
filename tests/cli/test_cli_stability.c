/* The stability map: a sample of its hard places, or with an argument all of them. No
 * method gives a number that is not finite; what states an accuracy keeps it or refuses.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/ppscat.h>

static const char header[] = "method,albedo,g,thickness,mu0,status,error,seconds\n";

typedef struct {
    char method[40], status[16];
    double albedo, g, thickness, mu0, error; /* NAN: none */
} cell;

static double number(const char *line, size_t i) {
    char *text = csv_field(line, i);
    double x = *text ? strtod(text, NULL) : (double)NAN;

    free(text);
    return x;
}

static cell read_cell(const char *line) {
    cell c = {.albedo = number(line, 1),
              .g = number(line, 2),
              .thickness = number(line, 3),
              .mu0 = number(line, 4),
              .error = number(line, 6)};
    char *method = csv_field(line, 0), *status = csv_field(line, 5);

    snprintf(c.method, sizeof c.method, "%s", method);
    snprintf(c.status, sizeof c.status, "%s", status);
    free(method);
    free(status);
    return c;
}

static bool has(const cell *c, const char *status) {
    return strcmp(c->status, status) == 0;
}

static bool is(const cell *c, const char *method) {
    return strcmp(c->method, method) == 0;
}

/* ---- what a method may do ---- */

/* Where `exact` at 1e-6 may refuse: at strong peaks, which 256 streams do not resolve. */
static bool peaked(const cell *c) { return fabs(c->g) >= 0.9; }

/* Where `adding` may: beyond 320 nodes, and where no more than e^-900 of the light comes
 * through, which is no number. */
static bool beyond_adding(const cell *c) {
    return fabs(c->g) >= 0.99 || (c->g == 0 && c->thickness == 1000);
}

static bool always(const cell *c) {
    (void)c;
    return true;
}

/* Methods that state an accuracy, and where they may refuse. */
static const struct {
    const char *method;
    bool (*may_refuse)(const cell *c);
} accurate[] = {{"exact", peaked}, {"auto", peaked},        {"adding", beyond_adding},
                {"rk", always},    {"rk-shooting", always}, {"mc", always}};
enum { N_ACCURATE = sizeof accurate / sizeof accurate[0] };

/* Closed forms: by their `limits` the reflectance is off by at most that share of what
 * falls in (more than all of it where they state none), and below 0 where they say so. */
static const struct {
    const char *method;
    double share;
    bool negative;
} approximate[] = {{"spp", 0.35, false},
                   {"spp-printed", INFINITY, false},
                   {"spp-refined", INFINITY, false},
                   {"spp-literal", INFINITY, true},
                   {"single", 1, false},
                   {"hemispheric", 0.1, false},
                   {"eddington", 0.16, true},
                   {"fourstream", 0.1, false},
                   {"twostream-eddington", 0.18, true},
                   {"twostream-eddington-delta", 0.18, true},
                   {"twostream-quadrature", 0.18, true},
                   {"twostream-quadrature-delta", 0.18, true},
                   {"twostream-pifm", 0.18, true},
                   {"twostream-pifm-delta", 0.18, true},
                   {"twostream-hemispheric-mean", 0.3, true},
                   {"twostream-hemispheric-mean-delta", 0.45, true}};
enum { N_APPROXIMATE = sizeof approximate / sizeof approximate[0] };

/* The reflectance by `exact`, NAN where it refuses; its model is kept for cells of the same
 * albedo and g. */
typedef struct {
    pps_model *model;
    double albedo, g;
} reflector;

static double reflectance(reflector *r, const cell *c) {
    pps_slab slab = {c->albedo, c->g, c->thickness};
    pps_options options = {.tolerance = 1e-4};
    pps_flux flux;
    double top = 0;

    if (!r->model || r->albedo != c->albedo || r->g != c->g) {
        pps_model_free(r->model);
        assert_int_equal(
            pps_model_create(pps_method_find("exact"), &slab, &options, &r->model),
            PPS_OK);
        r->albedo = c->albedo;
        r->g = c->g;
    }
    assert_int_equal(pps_model_solve(r->model, c->thickness, c->mu0), PPS_OK);
    pps_status status = pps_model_flux(r->model, 1, &top, &flux);
    assert_true(status == PPS_OK || (status == PPS_ERR_TOLERANCE && peaked(c)));
    return status ? (double)NAN : flux.up / c->mu0;
}

static bool keeps_accuracy(const cell *c, size_t i) {
    return has(c, "ok") || (has(c, "refused") && accurate[i].may_refuse(c));
}

static bool keeps_limits(reflector *r, const cell *c, size_t i) {
    if (has(c, "refused"))
        return true;
    if (has(c, "negative") && !approximate[i].negative)
        return false;
    if (isinf(approximate[i].share) || isnan(c->error))
        return true;
    return !(c->error * reflectance(r, c) > approximate[i].share); /* NAN: unknown */
}

/* Whether a cell is as the method promises. */
static bool allowed(reflector *r, const cell *c) {
    if (has(c, "not_finite") || has(c, "too_slow"))
        return false;
    for (size_t i = 0; i < N_ACCURATE; i++) {
        if (is(c, accurate[i].method))
            return keeps_accuracy(c, i);
    }
    for (size_t i = 0; i < N_APPROXIMATE; i++) {
        if (is(c, approximate[i].method))
            return keeps_limits(r, c, i);
    }
    return false; /* a method nobody promises anything for */
}

/* The rows, and those of them that are ok. */
static void assert_map(const result *r, size_t rows, size_t least_ok) {
    reflector exact = {0};
    size_t failures = 0, n = 0, ok = 0;

    assert_true(r->status == 0 || r->status == 3);
    assert_int_equal(strncmp(r->out, header, strlen(header)), 0);
    for (const char *line = next_line(r->out); line; line = next_line(line), n++) {
        cell c = read_cell(line);
        bool good = allowed(&exact, &c);
        if (!good)
            print_error("%.*s\n", (int)strcspn(line, "\n"), line);
        failures += !good;
        ok += has(&c, "ok");
    }
    pps_model_free(exact.model);
    assert_int_equal(failures, 0);
    assert_int_equal(n, rows);
    assert_true(ok >= least_ok);
}

/* ---- walks ---- */

static void exact_is_right_at_the_limits(void **state) {
    result r = program_run("stability --method exact,auto --albedo "
                           "0,0.9999999,0.999999999999999,1 --g -0.3,0.5 "
                           "--thickness 1e-9,1e-3,1,1e6,inf --mu0 1e-4,0.6");

    (void)state;
    assert_map(&r, 2 * 4 * 2 * 5 * 2, 2 * 4 * 2 * 5 * 2);
    result_free(&r);
}

/* mu0 = 1/k of the 32 streams that albedo 0.8 is solved by at first, and of 16, the middle
 * nodes of 16 streams, and their neighbours. */
static void special_beams_are_nothing_special(void **state) {
    result r = program_run(
        "stability --method exact,adding,hemispheric --albedo 0.8 --g 0.5 --thickness "
        "1e-3,1,10,inf --mu0 0.98210158749048437,0.98210158749049,0.9821015876,"
        "0.59171732124782490,0.5917173212478308,0.6");

    (void)state;
    assert_map(&r, 3 * 4 * 6, 3 * 4 * 6);
    result_free(&r);
}

static void every_method_keeps_what_it_states(void **state) {
    result r = program_run("stability --albedo 0,0.999999999999,1 --g 0.5,-0.4 "
                           "--thickness 1e-9,1,1e3,inf --mu0 0.05,0.6 --tol 1e-4 "
                           "--photons 300");
    size_t methods;

    (void)state;
    pps_method_table(&methods);
    assert_int_equal(methods, N_ACCURATE + N_APPROXIMATE);
    assert_map(&r, methods * 3 * 2 * 4 * 2, methods * 3 * 2 * 4 * 2 / 2);
    result_free(&r);
}

static void refused_cells_are_empty_and_say_why(void **state) {
    result r = program_run("stability --method exact --albedo 0.9 --g 0.99 "
                           "--thickness 1e-3 --tol 1e-7");
    cell c = read_cell(next_line(r.out));

    (void)state;
    assert_int_equal(r.status, 3);
    assert_int_equal(count_lines(r.err), 1);
    assert_true(has(&c, "refused") && isnan(c.error));
    result_free(&r);
}

/* The judge is not the judged: a method whose numbers are known to be off is found out. */
static void what_is_wrong_is_called_so(void **state) {
    result r = program_run("stability --method exact,spp-printed --albedo 1 --g -0.9 "
                           "--thickness 10 --streams 8 --mu0 0.6");

    (void)state;
    for (const char *line = next_line(r.out); line; line = next_line(line)) {
        cell c = read_cell(line);
        assert_true(has(&c, "inaccurate"));
        assert_true(c.error > 1e-4);
    }
    result_free(&r);
}

static void threads_do_not_change_a_verdict(void **state) {
    static const char call[] = "stability --method exact,spp,single --albedo 0.9,1 "
                               "--g 0,0.5 --thickness 1e-3,1 --mu0 0.6 -j %d";
    char one[256], two[256];
    result a, b;
    const char *x, *y;

    (void)state;
    snprintf(one, sizeof one, call, 1);
    snprintf(two, sizeof two, call, 3);
    a = program_run(one);
    b = program_run(two);
    for (x = a.out, y = b.out; x && y; x = next_line(x), y = next_line(y)) {
        for (size_t i = 0; i < 7; i++) {
            char *left = csv_field(x, i), *right = csv_field(y, i);
            assert_string_equal(left, right);
            free(left);
            free(right);
        }
    }
    assert_true(!x && !y);
    result_free(&a);
    result_free(&b);
}

static void the_whole_map_holds(void **state) {
    result r = program_run("stability");
    size_t methods;

    (void)state;
    pps_method_table(&methods);
    assert_map(&r, methods * 901, methods * 901 / 2);
    result_free(&r);
}

int main(int argc, char **argv) {
    const struct CMUnitTest sample[] = {
        cmocka_unit_test(exact_is_right_at_the_limits),
        cmocka_unit_test(special_beams_are_nothing_special),
        cmocka_unit_test(every_method_keeps_what_it_states),
        cmocka_unit_test(refused_cells_are_empty_and_say_why),
        cmocka_unit_test(what_is_wrong_is_called_so),
        cmocka_unit_test(threads_do_not_change_a_verdict),
    };
    const struct CMUnitTest whole[] = {cmocka_unit_test(the_whole_map_holds)};

    (void)argv;
    if (argc > 1)
        return cmocka_run_group_tests(whole, program_setup, program_teardown);
    return cmocka_run_group_tests(sample, program_setup, program_teardown);
}
