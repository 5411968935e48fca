/* Light tracing: what is known exactly, energy, and the limit of a turbid slab.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/light.h>

#include "plants.h"
#include "support/support.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

static pps_irradiance *trace(const pps_scene *scene, pps_trace_options options,
                             pps_energy *energy) {
    pps_irradiance *out;
    assert_int_equal(pps_trace_light(scene, &options, &out, energy), PPS_OK);
    return out;
}

static void set_optics(pps_scene *scene, double reflectance, double transmittance) {
    for (int face = 0; face < 2; face++) {
        for (int b = 0; b < scene->n_bands; b++) {
            scene->prototype[0].optics.reflectance[face][b] = reflectance;
            scene->prototype[0].optics.transmittance[face][b] = transmittance;
        }
    }
}

static void set_sun(pps_scene *scene, double x, double y, double z) {
    double to[3] = {x, y, z};
    vec_normalize(to);
    memcpy(scene->sun.to, to, sizeof to);
}

/* launched + chance = leaves + wood + ground + escaped */
static void assert_balance(const pps_energy *e, int n_bands) {
    for (int b = 0; b < n_bands; b++) {
        assert_close(e->leaves[b] + e->wood[b] + e->ground[b] + e->escaped[b],
                     e->launched[b] + e->chance[b], 1e-12, 0);
    }
}

/* Value within 4.5 standard errors; prints by assert_close. */
static void assert_within(double got, double want, double error) {
    assert_close(got, want, 0, 4.5 * error);
}

/* ---- few leaves ---- */

/* Three leaves that do not shade each other: level, and turned over by the scene's sun. */
static void a_leaf_alone_has_the_cosine(void **state) {
    (void)state;
    for (int k = 0; k < 3; k++) {
        square at[] = {{0, 0, 0, LEAF}};
        pps_scene *scene = scene_of(squares(1, at));
        const double sun[3][3] = {{0, 0, 1}, {1, -2, 0.5}, {0.3, 0.4, -2}};
        set_sun(scene, sun[k][0], sun[k][1], sun[k][2]);
        scene->sun.irradiance[0] = 3;
        pps_irradiance *e =
            trace(scene, (pps_trace_options){.rays = 1000000, .seed = 5}, NULL);
        double cosine = scene->sun.to[2], lit = cosine > 0 ? e->front[0] : e->back[0];
        double error = cosine > 0 ? e->front_error[0] : e->back_error[0];
        assert_close(lit, 3 * fabs(cosine), 0.01, 0);
        assert_within(lit, 3 * fabs(cosine), error);
        assert_true(error < 0.01 * lit);
        assert_true((cosine > 0 ? e->back[0] : e->front[0]) == 0);
        pps_irradiance_free(e);
        pps_scene_free(scene);
    }
}

/* A black leaf at height 1 over a wide ground, sun overhead: from below it gets what the
 * ground reflects but for its own shadow, which it sees under the form factor of two unit
 * squares at distance 1. */
static void the_ground_around_lights_a_leaf_from_below(void **state) {
    (void)state;
    const double form_factor = 0.199824895698387;
    square at[] = {{0, 0, 1, LEAF}};
    pps_scene *scene = scene_of(squares(1, at));
    set_optics(scene, 0, 0);
    scene->sun.irradiance[0] = 2;
    scene->ground = (pps_ground){true, 0, {0.4}};
    pps_energy energy;
    pps_irradiance *e =
        trace(scene, (pps_trace_options){.rays = 1000000, .seed = 1}, &energy);
    assert_within(e->back[0], 0.4 * 2 * (1 - form_factor), e->back_error[0]);
    assert_true(e->back_error[0] < 0.006);
    assert_within(e->front[0], 2, e->front_error[0]);
    assert_balance(&energy, 1);
    pps_irradiance_free(e);

    /* One bounce is enough for that; without indirect light there is none. */
    e = trace(scene, (pps_trace_options){.rays = 300000, .seed = 1, .bounces = 1},
              NULL);
    assert_within(e->back[0], 0.4 * 2 * (1 - form_factor), e->back_error[0]);
    pps_irradiance_free(e);
    e = trace(scene, (pps_trace_options){.rays = 100000, .sources = PPS_SUN}, &energy);
    assert_true(e->back[0] == 0);
    assert_true(energy.escaped[0] == 0);
    pps_irradiance_free(e);
    pps_scene_free(scene);
}

/* High above the ground under a graded sky without sun: pi (horizon + 2/3 rise) from
 * above, what the ground makes of it from below. Without ground, the sky below. */
static void sky_and_ground_light_a_leaf_high_up(void **state) {
    (void)state;
    for (int ground = 0; ground < 2; ground++) {
        square at[] = {{0, 0, 60, LEAF}};
        pps_scene *scene = scene_of(squares(1, at));
        set_optics(scene, 0.3, 0.5);
        scene->sun.irradiance[0] = 0;
        scene->sky = (pps_sky){{1.4}, {0.6}, {0.25}};
        scene->ground = (pps_ground){ground, 0, {0.5}};
        pps_energy energy;
        pps_irradiance *e =
            trace(scene, (pps_trace_options){.rays = 700000, .seed = 2}, &energy);
        double sky = PI * (0.6 + 2 / 3.0 * 0.8);
        assert_within(e->front[0], sky, e->front_error[0]);
        assert_within(e->back[0], ground ? 0.5 * sky : 0.25 * PI, e->back_error[0]);
        assert_true(e->front_error[0] < 0.01 * sky && e->back_error[0] < 0.02 * sky);
        assert_balance(&energy, 1);
        pps_irradiance_free(e);
        pps_scene_free(scene);
    }
}

/* Two wide sheets, each the other's only neighbour: a series of reflections. Endless level
 * leaves with sun overhead; everything is one-dimensional. */
static void faces_have_optics_of_their_own(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, LEAF}};
    pps_scene *scene = scene_of(squares(1, at));
    scene->period[0] = scene->period[1] = 1;
    pps_leaf_optics *o = &scene->prototype[0].optics;
    o->reflectance[PPS_FRONT][0] = 0.2;
    o->transmittance[PPS_FRONT][0] = 0.5;
    o->reflectance[PPS_BACK][0] = 0.6;
    o->transmittance[PPS_BACK][0] = 0.1;
    scene->ground = (pps_ground){true, -0.5, {0.3}};
    pps_energy energy;
    pps_irradiance *e =
        trace(scene, (pps_trace_options){.rays = 1000000, .seed = 3}, &energy);
    double below = 0.5 * 0.3 / (1 - 0.3 * 0.6); /* 0.5 down, and again and again */
    assert_close(e->front[0], 1, 1e-9, 0);
    assert_within(e->back[0], below, e->back_error[0]);
    assert_within(energy.escaped[0], 0.2 + 0.1 * below, 2 * e->back_error[0]);
    assert_within(energy.leaves[0], 0.3 + 0.3 * below, 2 * e->back_error[0]);
    assert_balance(&energy, 1);
    pps_irradiance_free(e);
    pps_scene_free(scene);
}

/* Half of every leaf is cut out: half the power, the same irradiance of what is there. */
static void holes_take_power_not_irradiance(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, LEAF}};
    pps_mesh *mesh = squares(1, at);
    cut_right_half(mesh);
    pps_scene *scene = scene_of(mesh);
    scene->period[0] = scene->period[1] = 1;
    set_optics(scene, 0, 0);
    pps_energy energy;
    pps_irradiance *e =
        trace(scene, (pps_trace_options){.rays = 400000, .seed = 3}, &energy);
    assert_close(energy.leaves[0], 0.5, 0.01, 0);
    assert_close(e->front[0], 1, 0.01, 0);
    pps_irradiance_free(e);
    pps_scene_free(scene);
}

/* ---- energy ---- */

static void energy_is_conserved(void **state) {
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        pps_scene *scene = three_bands(kind & 1, kind & 2);
        double launched[3] = {0}, sum[3] = {0}, squares_sum[3] = {0};
        enum { SEEDS = 12 };
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            pps_energy e;
            pps_trace_options options = {.rays = 10000, .seed = seed};
            pps_irradiance_free(trace(scene, options, &e));
            assert_balance(&e, 3);
            for (int b = 0; b < 3; b++) {
                assert_true(e.wood[b] > 0 && (e.ground[b] > 0) == (kind >> 1));
                launched[b] += e.launched[b];
                sum[b] += e.chance[b];
                squares_sum[b] += e.chance[b] * e.chance[b];
            }
        }
        for (int b = 0; b < 3; b++) { /* chance is there, small, and averages out */
            double deviation = sqrt(squares_sum[b] - sum[b] * sum[b] / SEEDS);
            assert_true(deviation > 1e-6 * launched[b]);
            assert_within(sum[b], 0, deviation);
            assert_close(sum[b] / launched[b], 0, 0, 2e-3);
        }
        pps_scene_free(scene);
    }
}

/* Nothing absorbs: all that is launched escapes, however often it is scattered. */
static void white_leaves_over_white_ground_keep_nothing(void **state) {
    (void)state;
    pps_scene *scene = layer_scene(3, 3000, 2);
    set_optics(scene, 0.5, 0.5);
    scene->ground = (pps_ground){true, -0.1, {1}};
    pps_energy e;
    pps_irradiance_free(
        trace(scene, (pps_trace_options){.rays = 100000, .seed = 9}, &e));
    assert_balance(&e, 1);
    assert_close(e.escaped[0], 1, 1e-3, 0);
    assert_close(e.leaves[0] + e.ground[0], 0, 0, 1e-14);
    pps_scene_free(scene);
}

/* ---- sums ---- */

static void sources_add_up(void **state) {
    (void)state;
    pps_scene *scene = three_bands(false, true);
    size_t n = scene->n_leaves * 3;
    pps_trace_options options = {.rays = 300000, .seed = 1};
    pps_irradiance *all = trace(scene, options, NULL);
    double *sum = calloc(n, sizeof *sum), *variance = calloc(n, sizeof *variance);
    for (unsigned source = 1; source < PPS_ALL_LIGHT; source *= 2) {
        options.sources = source;
        options.seed++;
        pps_irradiance *one = trace(scene, options, NULL);
        double mean = 0;
        for (size_t i = 0; i < n; i++) {
            sum[i] += one->front[i];
            variance[i] += one->front_error[i] * one->front_error[i];
            mean += one->front[i] / (double)n;
        }
        assert_true(mean > 0.005);
        pps_irradiance_free(one);
    }
    double chi2 = 0;
    for (size_t i = 0; i < n; i++) {
        double d = sum[i] - all->front[i];
        variance[i] += all->front_error[i] * all->front_error[i];
        chi2 += d * d / variance[i];
    }
    /* Bands of a leaf are correlated, so the spread of chi^2 is up to 3 times as wide. */
    assert_close(chi2 / (double)n, 1, 0, 4 * sqrt(6 / (double)n));
    free(sum);
    free(variance);
    pps_irradiance_free(all);
    pps_scene_free(scene);
}

/* The spread over seeds is what the standard errors say. */
static void standard_errors_hold(void **state) {
    (void)state;
    enum { SEEDS = 16 };
    pps_scene *scene = three_bands(true, true);
    size_t n = scene->n_leaves * 3;
    double *sum = calloc(n, sizeof *sum), *sum2 = calloc(n, sizeof *sum2),
           *claimed = calloc(n, sizeof *claimed);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        pps_irradiance *e =
            trace(scene, (pps_trace_options){.rays = 100000, .seed = seed}, NULL);
        for (size_t i = 0; i < n; i++) {
            sum[i] += e->back[i];
            sum2[i] += e->back[i] * e->back[i];
            claimed[i] += e->back_error[i] * e->back_error[i] / SEEDS;
        }
        pps_irradiance_free(e);
    }
    double ratio = 0;
    for (size_t i = 0; i < n; i++) {
        double mean = sum[i] / SEEDS;
        ratio += (sum2[i] / SEEDS - mean * mean) * SEEDS / (SEEDS - 1) / claimed[i];
    }
    assert_close(ratio / (double)n, 1, 0.05, 0);
    free(sum);
    free(sum2);
    free(claimed);
    pps_scene_free(scene);
}

static void threads_never_change_a_bit(void **state) {
    (void)state;
    pps_scene *scene = three_bands(true, true);
    size_t n = 4 * scene->n_leaves * 3;
    pps_energy one_energy, many_energy;
    pps_irradiance *one =
        trace(scene, (pps_trace_options){.rays = 50000, .seed = 3, .threads = 1},
              &one_energy);
    pps_irradiance *many =
        trace(scene, (pps_trace_options){.rays = 50000, .seed = 3, .threads = 7},
              &many_energy);
    assert_memory_equal(one->front, many->front, n * sizeof *one->front);
    assert_memory_equal(&one_energy, &many_energy, sizeof one_energy);
    pps_irradiance_free(many);
    many = trace(scene, (pps_trace_options){.rays = 50000, .seed = 4}, NULL);
    assert_memory_not_equal(one->front, many->front, n * sizeof *one->front);
    pps_irradiance_free(one);
    pps_irradiance_free(many);
    pps_scene_free(scene);
}

/* ---- the turbid slab ---- */

typedef struct {
    double reflected, transmitted;
} slab_flux;

static double height_after_lambert(const double n[3], double side, uint64_t *seed,
                                   double out[3]) {
    double x[3], y[3], u = support_random(seed), v = 2 * PI * support_random(seed);
    vec_frame(n, x, y);
    for (int i = 0; i < 3; i++) {
        out[i] = side * sqrt(u) * n[i] + sqrt(1 - u) * (cos(v) * x[i] + sin(v) * y[i]);
    }
    return out[2];
}

/* Photons in a medium of infinitely small leaves of random orientation, r = t = albedo/2,
 * thickness `tau` = half the leaf-area index, along mu0: an independent walk. */
static slab_flux turbid(double albedo, double tau, double mu0, int photons) {
    slab_flux f = {0, 0};
    uint64_t seed = 77;
    for (int i = 0; i < photons; i++) {
        double d[3] = {sqrt(1 - mu0 * mu0), 0, mu0}, depth = 0, weight = 1;
        for (;;) {
            depth -= log(1 - support_random(&seed)) * d[2];
            if (depth < 0 || depth > tau) {
                *(depth < 0 ? &f.reflected : &f.transmitted) += weight / photons;
                break;
            }
            double n[3], c; /* a leaf is met with probability |n.d| */
            do {
                double a = 2 * PI * support_random(&seed);
                n[2] = 2 * support_random(&seed) - 1;
                n[0] = sqrt(1 - n[2] * n[2]) * cos(a);
                n[1] = sqrt(1 - n[2] * n[2]) * sin(a);
                c = vec_dot(n, d);
            } while (support_random(&seed) > fabs(c));
            weight *= albedo;
            height_after_lambert(n, support_random(&seed) < 0.5 ? 1 : -1, &seed, d);
        }
    }
    return f;
}

static void a_layer_of_small_leaves_is_a_turbid_slab(void **state) {
    (void)state;
    const double L = 3, albedo = 0.9, mu0 = 0.6;
    pps_scene *scene = layer_scene(L, 60000, 12);
    set_optics(scene, albedo / 2, albedo / 2);
    set_sun(scene, -0.8, 0, mu0);
    scene->ground = (pps_ground){true, -0.1, {0}};
    pps_energy e;
    pps_irradiance_free(trace(
        scene, (pps_trace_options){.rays = 400000, .seed = 1, .sources = PPS_SUN}, &e));
    /* uncollided: the layer's own gaps differ from the mean by about 0.3 % of the light */
    assert_close(e.ground[0] / mu0, exp(-L / 2 / mu0), 0, 0.004);
    pps_irradiance_free(
        trace(scene, (pps_trace_options){.rays = 400000, .seed = 2}, &e));
    slab_flux want = turbid(albedo, L / 2, mu0, 400000);
    /* rays: 0.1 % of the light; leaves of finite size return a little more straight back */
    assert_close(e.escaped[0] / mu0, want.reflected, 0, 0.006);
    assert_close(e.ground[0] / mu0, want.transmitted, 0, 0.006);
    pps_scene_free(scene);
}

/* ---- options ---- */

typedef struct {
    uint64_t done, calls;
} watcher;

static bool until_half(void *user, uint64_t done, uint64_t total) {
    watcher *w = user;
    assert_true(done >= w->done && done <= total);
    w->done = done;
    w->calls++;
    return done < total / 2;
}

static bool to_the_end(void *user, uint64_t done, uint64_t total) {
    watcher *w = user;
    w->done = done;
    w->calls++;
    return done <= total;
}

static void work_can_be_watched_and_stopped(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 1, 50, 1);
    pps_irradiance *e;
    watcher w = {0, 0};
    pps_trace_options options = {
        .rays = 200000, .progress = until_half, .user = &w, .threads = 2};
    assert_int_equal(pps_trace_light(scene, &options, &e, NULL), PPS_ERR_CANCELLED);
    assert_null(e);
    assert_true(w.done >= 100000 && w.done < 200000);
    w = (watcher){0, 0};
    options.progress = to_the_end;
    pps_irradiance_free(trace(scene, options, NULL));
    assert_true(w.calls >= 2);
    assert_true(w.done == 200000);
    pps_scene_free(scene);
}

static void what_cannot_be_done_is_refused(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 1, 50, 1);
    const pps_trace_options bad[] = {
        {.bounces = -1}, {.sources = 16}, {.rays = ((uint64_t)1 << 40) + 1}};
    pps_irradiance *e;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(pps_trace_light(scene, &bad[i], &e, NULL), PPS_ERR_ARGUMENT);
        assert_null(e);
    }
    scene->sun.irradiance[0] = 0; /* no light at all is no error */
    assert_int_equal(pps_trace_light(scene, NULL, &e, NULL), PPS_OK);
    assert_true(e->front[0] == 0 && e->front_error[0] == 0);
    pps_irradiance_free(e);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_leaf_alone_has_the_cosine),
        cmocka_unit_test(the_ground_around_lights_a_leaf_from_below),
        cmocka_unit_test(sky_and_ground_light_a_leaf_high_up),
        cmocka_unit_test(faces_have_optics_of_their_own),
        cmocka_unit_test(holes_take_power_not_irradiance),
        cmocka_unit_test(energy_is_conserved),
        cmocka_unit_test(white_leaves_over_white_ground_keep_nothing),
        cmocka_unit_test(sources_add_up),
        cmocka_unit_test(standard_errors_hold),
        cmocka_unit_test(threads_never_change_a_bit),
        cmocka_unit_test(a_layer_of_small_leaves_is_a_turbid_slab),
        cmocka_unit_test(work_can_be_watched_and_stopped),
        cmocka_unit_test(what_cannot_be_done_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
