/* Gathering, alone and against light tracing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include <ppscat/tree/light.h>

#include "plants.h"
#include "support/support.h"

static const double PI = 3.14159265358979323846;

static pps_irradiance *gather(const pps_scene *scene, int samples,
                              pps_trace_options options) {
    pps_irradiance *out;
    assert_int_equal(pps_gather_light(scene, 0, NULL, samples, &options, &out), PPS_OK);
    return out;
}

/* Sun at cosine 0.6: no variance at all. Sky from above, ground from below. */
static void a_leaf_alone_sees_sun_sky_and_ground(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}};
    pps_scene *scene = scene_of(squares(1, at));
    scene->sun = (pps_sun){{0.8, 0, 0.6}, {2}};
    scene->sky = (pps_sky){{1.4}, {0.6}, {0}};
    scene->ground = (pps_ground){true, -1000, {0.5}};
    pps_irradiance *e =
        gather(scene, 1000, (pps_trace_options){.seed = 1, .sources = PPS_SUN});
    assert_close(e->front[0], 1.2, 1e-14, 0);
    assert_true(e->front_error[0] < 1e-15 && e->back[0] == 0);
    pps_irradiance_free(e);
    e = gather(scene, 100000, (pps_trace_options){.seed = 1});
    double sky = PI * (0.6 + 2 / 3.0 * 0.8);
    assert_close(e->front[0], 1.2 + sky, 0, 4.5 * e->front_error[0]);
    assert_close(e->back[0], 0.5 * (1.2 + sky), 0, 4.5 * e->back_error[0]);
    assert_true(e->back_error[0] < 0.01);
    pps_irradiance_free(e);
    pps_scene_free(scene);
}

typedef struct {
    double chi2, mean_off, mean_error; /* mean over faces of the difference */
} comparison;

static comparison compare(const pps_scene *scene, const pps_irradiance *a,
                          const pps_irradiance *b) {
    comparison c = {0, 0, 0};
    size_t n = scene->n_leaves * (size_t)scene->n_bands;
    for (size_t i = 0; i < 2 * n; i++) {
        size_t k = i % n;
        double x = i < n ? a->front[k] : a->back[k],
               y = i < n ? b->front[k] : b->back[k];
        double ex = i < n ? a->front_error[k] : a->back_error[k],
               ey = i < n ? b->front_error[k] : b->back_error[k];
        double variance = ex * ex + ey * ey;
        c.chi2 += (x - y) * (x - y) / variance / (double)(2 * n);
        c.mean_off += (x - y) / (double)(2 * n);
        c.mean_error += variance / (double)(2 * n) / (double)(2 * n);
    }
    c.mean_error = sqrt(c.mean_error);
    return c;
}

/* Open and repeating, with and without ground: leaf by leaf the two references differ by
 * their errors, and in the mean by a fraction of a percent. */
static void tracing_and_gathering_agree(void **state) {
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        pps_scene *scene = three_bands(kind & 1, kind & 2);
        pps_trace_options options = {.rays = 1000000, .seed = 21};
        pps_irradiance *traced, *gathered = gather(scene, 150, options);
        assert_int_equal(pps_trace_light(scene, &options, &traced, NULL), PPS_OK);
        comparison c = compare(scene, traced, gathered);
        assert_close(c.chi2, 1, 0.1, 0);
        /* Bands are correlated: sqrt(3) more than the independent error, at most. */
        assert_close(c.mean_off, 0, 0, 4 * sqrt(3) * c.mean_error);
        assert_true(c.mean_error < 0.002);
        pps_irradiance_free(traced);
        pps_irradiance_free(gathered);
        pps_scene_free(scene);
    }
}

/* Each source, and a limit on bounces, mean the same to both. */
static void they_agree_source_by_source(void **state) {
    (void)state;
    pps_scene *scene = three_bands(false, true);
    for (unsigned source = 1; source < PPS_ALL_LIGHT; source *= 2) {
        pps_trace_options options = {
            .rays = 300000, .seed = source, .sources = source, .bounces = 2};
        pps_irradiance *traced, *gathered = gather(scene, 60, options);
        assert_int_equal(pps_trace_light(scene, &options, &traced, NULL), PPS_OK);
        double a = 0, b = 0, variance = 0;
        for (size_t i = 0; i < 3 * scene->n_leaves; i++) {
            a += traced->front[i] + traced->back[i];
            b += gathered->front[i] + gathered->back[i];
            variance += pow(traced->front_error[i], 2) + pow(traced->back_error[i], 2) +
                        pow(gathered->front_error[i], 2) +
                        pow(gathered->back_error[i], 2);
        }
        assert_true(a > 0);
        assert_close(a, b, 0, 4 * sqrt(3 * variance));
        assert_close(a, b, 0.02, 0);
        pps_irradiance_free(traced);
        pps_irradiance_free(gathered);
    }
    pps_scene_free(scene);
}

static void only_leaves_asked_for_are_gathered(void **state) {
    (void)state;
    pps_scene *scene = three_bands(true, false);
    const size_t leaf[] = {5, 100};
    pps_trace_options one = {.seed = 2, .threads = 1}, four = {.seed = 2, .threads = 4};
    pps_irradiance *few, *all = gather(scene, 20, four);
    assert_int_equal(pps_gather_light(scene, 2, leaf, 20, &one, &few), PPS_OK);
    for (size_t i = 0; i < scene->n_leaves; i++) {
        if (i == 5 || i == 100) { /* bit by bit, whatever the threads */
            assert_true(few->front[3 * i] == all->front[3 * i]);
            assert_true(few->back_error[3 * i + 2] == all->back_error[3 * i + 2]);
        } else {
            assert_true(isnan(few->front[3 * i]) && isnan(few->back_error[3 * i]));
        }
    }
    pps_irradiance_free(few);
    pps_irradiance_free(all);

    const size_t beyond[] = {scene->n_leaves};
    assert_int_equal(pps_gather_light(scene, 1, beyond, 20, &one, &few),
                     PPS_ERR_ARGUMENT);
    assert_null(few);
    assert_int_equal(pps_gather_light(scene, 2, leaf, 0, &one, &few), PPS_ERR_ARGUMENT);
    pps_scene_free(scene);
}

static bool never(void *user, uint64_t done, uint64_t total) {
    *(uint64_t *)user = done;
    return total == 0;
}

static void work_can_be_stopped(void **state) {
    (void)state;
    pps_scene *scene = three_bands(false, false);
    uint64_t done = 0;
    pps_trace_options options = {.progress = never, .user = &done, .threads = 1};
    pps_irradiance *e;
    assert_int_equal(pps_gather_light(scene, 0, NULL, 1, &options, &e),
                     PPS_ERR_CANCELLED);
    assert_null(e);
    assert_int_equal(done, 1);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_leaf_alone_sees_sun_sky_and_ground),
        cmocka_unit_test(tracing_and_gathering_agree),
        cmocka_unit_test(they_agree_source_by_source),
        cmocka_unit_test(only_leaves_asked_for_are_gathered),
        cmocka_unit_test(work_can_be_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
