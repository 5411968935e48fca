/* The units of a sweep cover the grid once, in order, also beyond 2^32 of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "program.h"

#include <stdlib.h>
#include <string.h>

#include "cli/plan.h"

/* A grid of lists with values 1, 2, .. */
typedef struct {
    case_grid grid;
    const pps_method *method[2];
} example;

enum { LONGEST = 70000 };
static double counting[LONGEST];

static number_list list(size_t n) { return (number_list){.n = n, .value = counting}; }

static example make(size_t methods, size_t albedos, size_t g, size_t thicknesses,
                    size_t mu0, size_t depths, size_t mu, size_t phi) {
    example e = {.method = {pps_method_find("exact"), pps_method_find("spp")}};

    for (size_t i = 0; i < LONGEST; i++)
        counting[i] = (double)(i + 1);
    e.grid = (case_grid){.n_methods = methods,
                         .albedo = list(albedos),
                         .g = list(g),
                         .thickness = list(thicknesses),
                         .mu0 = list(mu0),
                         .max_depths = depths,
                         .mu = list(mu),
                         .phi = list(phi)};
    e.grid.depth = calloc(thicknesses, sizeof *e.grid.depth);
    assert_non_null(e.grid.depth);
    for (size_t i = 0; i < thicknesses; i++) /* the last, as a half-space, has one */
        e.grid.depth[i] =
            (depth_list){i + 1 < thicknesses ? depths : 1, counting, NULL};
    return e;
}

/* Walk all rows by units and by plain loops side by side. */
static void check_cover(example *e, row_shape shape) {
    const case_grid *grid = &e->grid;
    size_t methods = shape == ROWS_CASE ? 1 : grid->n_methods;
    size_t n_mu = shape == ROWS_DIRECTIONS ? grid->mu.n : 1;
    size_t n_phi = shape == ROWS_DIRECTIONS ? grid->phi.n : 1;
    uint64_t at = 0, row = 0, rows = 0;
    sweep_unit unit = {0};
    sweep_plan plan;

    e->grid.method = e->method;
    plan_init(&plan, grid, shape);
    for (size_t m = 0; m < methods; m++)
        for (size_t a = 0; a < grid->albedo.n; a++)
            for (size_t g = 0; g < grid->g.n; g++)
                for (size_t w = 0; w < grid->thickness.n; w++)
                    for (size_t b = 0; b < grid->mu0.n; b++) {
                        size_t n_depths = shape == ROWS_CASE ? 1 : grid->depth[w].n;
                        for (size_t r = 0; r < n_depths * n_mu * n_phi; r++, row++) {
                            size_t k = r / (n_mu * n_phi), i = r % n_phi;
                            size_t j = r / n_phi % n_mu, own;
                            while (row == rows) { /* the next unit that has rows */
                                unit = plan_unit(&plan, at++);
                                rows += plan_rows(&plan, &unit);
                                own = plan_rows(&plan, &unit);
                                assert_true(own <= UNIT_ROWS);
                            }
                            assert_true(unit.i_method == m && unit.i_albedo == a);
                            assert_true(unit.i_g == g && unit.i_thickness == w);
                            assert_true(b - unit.mu0.first < unit.mu0.n);
                            assert_true(unit.mu0.value[b - unit.mu0.first] ==
                                        grid->mu0.value[b]);
                            if (shape == ROWS_CASE)
                                continue;
                            assert_true(k - unit.depth.first < unit.depth.n);
                            if (shape == ROWS_DIRECTIONS)
                                assert_true(j - unit.mu.first < unit.mu.n &&
                                            i - unit.phi.first < unit.phi.n);
                        }
                    }
    for (; at < plan.n_units; at++) { /* what is left are depths of the half-space */
        unit = plan_unit(&plan, at);
        assert_int_equal(plan_rows(&plan, &unit), 0);
    }
    assert_true(at == plan.n_units && row == rows);
    free(e->grid.depth);
}

static void units_cover_the_rows_in_order(void **state) {
    static const size_t sizes[][8] = {
        {2, 3, 2, 4, 5, 3, 4, 3},     {1, 1, 1, 1, 1, 1, 1, 1},
        {1, 1, 1, 2, 200, 7, 5, 1},   {2, 1, 1, 2, 3, 40, 30, 20},
        {1, 1, 1, 1, 2, 3, 200, 150}, {1, 1, 1, 2, 1, 2, 3, 40000},
        {1, 2, 1, 1, 1, 20000, 1, 2}, {1, 1, 1, 3, 1, 40000, 1, 1},
        {1, 1, 1, 1, 1, 1, 20000, 3},
    };

    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        for (int shape = ROWS_CASE; shape <= ROWS_DIRECTIONS; shape++) {
            const size_t *n = sizes[i];
            example e = make(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]);
            check_cover(&e, (row_shape)shape);
        }
    }
}

/* 7e4 albedos, g and mu0 and 2 methods: 6.9e14 rows. */
static void numbers_beyond_32_bits_are_right(void **state) {
    example e = make(2, LONGEST, LONGEST, 1, LONGEST, 1, 1, 1);
    uint64_t parts = (LONGEST + UNIT_BEAMS - 1) / UNIT_BEAMS;
    const size_t where[][4] = {{0, 0, 0, 0},
                               {1, 12345, 54321, 777},
                               {0, LONGEST - 1, LONGEST - 1, parts - 1},
                               {1, LONGEST - 1, LONGEST - 1, parts - 1}};
    sweep_plan plan;

    (void)state;
    e.grid.method = e.method;
    plan_init(&plan, &e.grid, ROWS_DEPTHS);
    assert_true(plan.cases == UINT64_C(2) * LONGEST * LONGEST * LONGEST);
    assert_true(plan.n_units == UINT64_C(2) * LONGEST * LONGEST * parts);
    for (size_t i = 0; i < 4; i++) {
        const size_t *w = where[i];
        uint64_t index =
            ((w[0] * (uint64_t)LONGEST + w[1]) * LONGEST + w[2]) * parts + w[3];
        sweep_unit unit = plan_unit(&plan, index);
        assert_true(unit.method == e.method[w[0]]);
        assert_true(unit.albedo == (double)(w[1] + 1) && unit.g == (double)(w[2] + 1));
        assert_true(unit.mu0.first == w[3] * UNIT_BEAMS);
    }
    free(e.grid.depth);
}

/* A method sees the same mu0 together whatever the sweep is split into. */
static void a_unit_is_bounded(void **state) {
    example e = make(1, 1, 1, 1, 1000, 3, 10, 10);
    sweep_plan plan;

    (void)state;
    e.grid.method = e.method;
    plan_init(&plan, &e.grid, ROWS_DIRECTIONS);
    assert_int_equal(plan.mu0_step, UNIT_ROWS / 300);
    plan_init(&plan, &e.grid, ROWS_DEPTHS);
    assert_int_equal(plan.mu0_step, UNIT_BEAMS);
    free(e.grid.depth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_cover_the_rows_in_order),
        cmocka_unit_test(numbers_beyond_32_bits_are_right),
        cmocka_unit_test(a_unit_is_bounded),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
