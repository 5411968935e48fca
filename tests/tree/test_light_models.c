/* Light models against Monte Carlo on statistical crowns: Table 3 of the SPP paper, and
 * what `lattice` and the best closed form are held to. Seeds that none was designed on.
 *
 * Without arguments a sample of the cases; else every case (label slow):
 *     test_light_models SEEDS [RAYS [FIRST_SEED [POINTS_A_LEAF]]]
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/experiment.h>

#include "plants.h"
#include "support/support.h"

enum { CONTENDERS_MAX = 32 };
static int n_seeds = 1;
static bool whole = false;
static uint64_t n_rays = 500000, first_seed = 7001;
static int samples = 0; /* points a leaf; 0: the default */

/* Means over seeds of all that was scored. */
typedef struct {
    pps_score of[CONTENDERS_MAX * PPS_BANDS_MAX];
} scores;

/* The contenders before those that light leaf by leaf, which test_leaf_models is about. */
static const pps_contender *cell_models(size_t *n) {
    size_t all;
    const pps_contender *contender = pps_contender_table(&all);
    for (*n = 0; *n < all && !contender[*n].model->takes_attenuations; ++*n) {
    }
    return contender;
}

static void add_score(pps_score *sum, const pps_score *one, double share) {
    for (int k = 0; k < PPS_SCORE_LEVELS; k++) {
        sum->category[k] += share * one->category[k];
        sum->by_count[k] += share * one->by_count[k];
        sum->faces[k] += share * one->faces[k];
        sum->categories[k] += one->categories[k];
    }
    sum->brightness += share * one->brightness;
    sum->leaves += share * one->leaves;
    sum->seconds_per_leaf += share * one->seconds_per_leaf;
    sum->seconds_per_cell += share * one->seconds_per_cell;
}

static void run(const pps_experiment *given, int seeds, scores *mean) {
    size_t n;
    const pps_contender *contenders = cell_models(&n);
    memset(mean, 0, sizeof *mean);
    for (int s = 0; s < seeds; s++) {
        static pps_score one[CONTENDERS_MAX * PPS_BANDS_MAX];
        pps_experiment e = *given;
        e.crown.seed = e.seed = first_seed + (uint64_t)s;
        e.samples = samples;
        e.rays = n_rays;
        assert_int_equal(pps_experiment_run(&e, n, contenders, one), PPS_OK);
        for (size_t i = 0; i < n * (size_t)e.n_bands; i++) {
            add_score(&mean->of[i], &one[i], 1.0 / seeds);
        }
    }
}

static const pps_score *score_of(const scores *s, const char *label, int n_bands,
                                 int band) {
    size_t n;
    const pps_contender *contenders = cell_models(&n);
    for (size_t i = 0; i < n; i++) {
        if (strcmp(contenders[i].label, label) == 0) {
            return &s->of[i * (size_t)n_bands + (size_t)band];
        }
    }
    fail_msg("no contender %s", label);
    return NULL;
}

static void print_all(const char *name, const scores *s, int n_bands, int band) {
    size_t n;
    const pps_contender *contenders = cell_models(&n);
    for (size_t i = 0; i < n; i++) {
        const pps_score *at = &s->of[i * (size_t)n_bands + (size_t)band];
        printf("%-34s %-16s %5.1f %5.1f  %5.1f %5.1f  %5.1f  %.3f\n", name,
               contenders[i].label, 100 * at->category[0], 100 * at->category[1],
               100 * at->by_count[0], 100 * at->by_count[1], 100 * at->faces[0],
               at->brightness);
    }
}

/* ---- Table 3 ---- */

static void table_3_has_the_papers_order_and_levels(void **state) {
    (void)state;
    static const struct {
        double index, period, sppg, spp[2], ss[2]; /* percent */
    } rows[] = {
        {0.8, 0, 20, {45, 65}, {18, 32}},
        {0.8, 2.5, 14, {27, 40}, {29, 44}},
        {1.2, 0, 20, {45, 65}, {18, 32}},
        {1.2, 2.5, 14, {27, 40}, {29, 44}},
    };
    for (int i = 0; i < (whole ? 4 : 2); i++) {
        pps_experiment e = {.crown = {.leaf_area_index = rows[i].index},
                            .period = rows[i].period,
                            .n_bands = 1,
                            .albedo = {0.95}};
        scores s;
        char name[64];
        run(&e, whole ? n_seeds : 3, &s);
        snprintf(name, sizeof name, "Table 3, index %g period %g", rows[i].index,
                 rows[i].period);
        print_all(name, &s, 1, 0);
        double sppg = 100 * score_of(&s, "SPPG", 1, 0)->category[0],
               spp = 100 * score_of(&s, "SPP", 1, 0)->category[0],
               ss = 100 * score_of(&s, "SS", 1, 0)->category[0];
        assert_true(sppg <= rows[i].sppg && sppg < spp && sppg < ss);
        assert_true(spp >= rows[i].spp[0] && spp <= rows[i].spp[1]);
        assert_true(ss >= rows[i].ss[0] && ss <= rows[i].ss[1]);
    }
}

/* ---- beyond the paper ---- */

typedef struct {
    const char *name;
    pps_crown_shape shape;
    double index, period, zenith;
    bool sky, sample;
} crown_case;

static const crown_case cases[] = {
    {"round .8", PPS_CROWN_UNIFORM, 0.8, 0, 0, false, false},
    {"round .8 period 2.5", PPS_CROWN_UNIFORM, 0.8, 2.5, 0, false, false},
    {"round 1.2 sun 30", PPS_CROWN_UNIFORM, 1.2, 0, 30, false, false},
    {"round 4", PPS_CROWN_UNIFORM, 4, 0, 0, false, false},
    {"round 4 period 2", PPS_CROWN_UNIFORM, 4, 2, 0, false, true},
    {"round 4 sun 60", PPS_CROWN_UNIFORM, 4, 0, 60, false, false},
    {"round 8", PPS_CROWN_UNIFORM, 8, 0, 0, false, false},
    {"round 2 sky", PPS_CROWN_UNIFORM, 2, 0, 0, true, true},
    {"round 4 period 2 sky", PPS_CROWN_UNIFORM, 4, 2, 0, true, false},
    {"tall 4", PPS_CROWN_TALL, 4, 0, 0, false, false},
    {"tall 4 period 2.5 sun 30", PPS_CROWN_TALL, 4, 2.5, 30, false, false},
    {"hollow 2 sun 60", PPS_CROWN_HOLLOW, 2, 0, 60, false, true},
    {"hollow 4 period 2.5", PPS_CROWN_HOLLOW, 4, 2.5, 0, false, false},
    {"clumped 1.2", PPS_CROWN_CLUMPED, 1.2, 0, 0, false, false},
    {"clumped 8", PPS_CROWN_CLUMPED, 8, 0, 0, false, false},
    {"clumped 8 period 2", PPS_CROWN_CLUMPED, 8, 2, 0, false, false},
};

/* A bar, printed where it is missed; all cases are shown before the test fails. */
static int misses(const char *what, double error, double bar) {
    bool missed = !(error <= bar);
    if (missed) {
        printf("    missed: %s %.2f %%, bar %.2f %%\n", what, 100 * error, 100 * bar);
    }
    return missed;
}

/* How many bars are missed. Sample: categories of 100 triangles, for 20 are 10 leaves and
 * few rays. */
static int check(const crown_case *c, const scores *s, int band) {
    const pps_score *lattice = score_of(s, "lattice", 3, band),
                    *closed = score_of(s, "self-consistent", 3, band);
    int level = whole ? 0 : 1;
    printf("%-26s band %d  lattice %4.1f %4.1f %4.1f %.3f  self-consistent %4.1f %4.1f "
           "%.3f  SPPG %4.1f %4.1f %.3f\n",
           c->name, band, 100 * lattice->category[level], 100 * lattice->by_count[0],
           100 * lattice->faces[0], lattice->brightness, 100 * closed->category[level],
           100 * closed->by_count[0], closed->brightness,
           100 * score_of(s, "SPPG", 3, band)->category[level],
           100 * score_of(s, "SPPG", 3, band)->by_count[0],
           score_of(s, "SPPG", 3, band)->brightness);
    return misses("lattice by category", lattice->category[level], 0.06) +
           misses("lattice by count", lattice->by_count[0], 0.03) +
           misses("lattice one-sided", lattice->faces[0], 0.08) +
           misses("lattice mean", fabs(lattice->brightness - 1), 0.03) +
           misses("self-consistent by category", closed->category[level],
                  c->index <= 1.2 ? 0.09 : 0.22) +
           misses("self-consistent mean", fabs(closed->brightness - 1), 0.07);
}

static void lattice_and_the_best_closed_form_hold_their_errors(void **state) {
    (void)state;
    int missed = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pps_experiment e = {
            .crown = {.shape = cases[i].shape, .leaf_area_index = cases[i].index},
            .period = cases[i].period,
            .zenith = cases[i].zenith,
            .sky = cases[i].sky,
            .n_bands = 3,
            .albedo = {0.5, 0.8, 0.95}};
        if (!whole && !cases[i].sample) {
            continue;
        }
        scores s;
        run(&e, n_seeds, &s);
        for (int b = 0; b < 3; b++) {
            missed += check(&cases[i], &s, b);
        }
        fflush(stdout);
    }
    assert_int_equal(missed, 0);
}

/* An oak by ez-tree: cut-out cards along branches, wood. */
static void both_hold_on_a_tree_made_by_others(void **state) {
    (void)state;
    static const double albedo[3] = {0.5, 0.8, 0.95};
    pps_mesh *mesh;
    pps_scene *scene;
    pps_cells *cells;
    pps_irradiance *truth;
    assert_int_equal(pps_mesh_read(TREES "/oak_small.obj", NULL, &mesh, NULL), PPS_OK);
    assert_int_equal(pps_scene_single(mesh, 0.5, &scene), PPS_OK);
    set_albedos(scene, 3, albedo);
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    pps_cells_options options = {.samples = samples, .seed = first_seed};
    pps_trace_options trace = {.rays = n_rays, .seed = first_seed};
    assert_int_equal(pps_cells_create(scene, &options, &cells), PPS_OK);
    assert_int_equal(pps_cells_set_sun(cells, scene, &options), PPS_OK);
    assert_int_equal(pps_trace_light(scene, &trace, &truth, NULL), PPS_OK);
    scores s;
    size_t n;
    const pps_contender *contenders = cell_models(&n);
    assert_int_equal(pps_score_models(scene, cells, truth, 0, n, contenders, 1, s.of),
                     PPS_OK);
    for (int b = 0; b < 3; b++) {
        print_all("oak_small.obj", &s, 3, b);
        static const char *const held[] = {"lattice", "self-consistent"};
        for (int k = 0; k < 2; k++) {
            const pps_score *at = score_of(&s, held[k], 3, b);
            assert_true(at->by_count[0] <= 0.16);
            assert_close(at->brightness, 1, 0, 0.07);
        }
    }
    pps_irradiance_free(truth);
    pps_cells_free(cells);
    pps_scene_free(scene);
}

int main(int argc, char **argv) {
    if (argc > 1) {
        whole = true;
        n_seeds = atoi(argv[1]);
        n_rays = argc > 2 ? strtoull(argv[2], NULL, 10) : 2000000;
        first_seed = argc > 3 ? strtoull(argv[3], NULL, 10) : first_seed;
        samples = argc > 4 ? atoi(argv[4]) : 0;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_3_has_the_papers_order_and_levels),
        cmocka_unit_test(both_hold_on_a_tree_made_by_others),
        cmocka_unit_test(lattice_and_the_best_closed_form_hold_their_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
