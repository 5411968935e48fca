/* Rays: exact counts, alpha, instances, walls of a repeating scene, against brute force.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>
#include <ppscat/tree/scene.h>

#include "plants.h"
#include "support/support.h"
#include "tree/alpha.h"
#include "tree/rays.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

static pps_rays *make_rays(const pps_scene *scene) {
    pps_rays *rays;
    assert_int_equal(pps_rays_create(scene, &rays), PPS_OK);
    return rays;
}

/* One after the other: arguments of a call may be worked out in any order. */
static void draw(int n, double *u, uint64_t *seed) {
    for (int i = 0; i < n; i++) {
        u[i] = support_random(seed);
    }
}

static pps_line line_from(double x, double y, double z, double dx, double dy,
                          double dz) {
    pps_line line = {{x, y, z}, {dx, dy, dz}, 0, INFINITY};
    vec_normalize(line.direction);
    return line;
}

/* Leaves at z = 0 .. 6, wood below them at -1. */
static void a_stack_of_sheets_is_counted_exactly(void **state) {
    (void)state;
    enum { N = 7 };
    square at[N + 1];
    for (int i = 0; i < N; i++) {
        at[i] = (square){0, 0, i, LEAF};
    }
    at[N] = (square){0, 0, -1, WOOD};
    pps_scene *scene = scene_of(squares(N + 1, at));
    pps_rays *rays = make_rays(scene);
    uint64_t seed = 1;
    for (int i = 0; i < 1000; i++) {
        double x = 0.3 + 0.4 * support_random(&seed),
               y = 0.3 + 0.4 * support_random(&seed);
        for (int k = 0; k < N; k++) {
            double point[3] = {x, y, k}, normal[3] = {0, 0, 1};
            double up[3] = {0.01, 0.02, 1}, down[3] = {0.01, -0.02, -1};
            vec_normalize(up);
            vec_normalize(down);
            pps_line above = pps_rays_leave(rays, point, normal, up);
            pps_line below = pps_rays_leave(rays, point, normal, down);
            bool wood;
            assert_int_equal(pps_rays_count(rays, &above, &wood), N - 1 - k);
            assert_false(wood);
            assert_int_equal(pps_rays_occluded(rays, &above), k < N - 1);
            assert_int_equal(pps_rays_count(rays, &below, &wood), k);
            assert_true(wood);
            assert_true(pps_rays_occluded(rays, &below));
        }
    }
    pps_rays_free(rays);
    pps_scene_free(scene);
}

static void near_and_far_end_a_line(void **state) {
    (void)state;
    square at[] = {{0, 0, 1, LEAF}, {0, 0, 2, LEAF}, {0, 0, 3, LEAF}};
    pps_scene *scene = scene_of(squares(3, at));
    for (int periodic = 0; periodic < 2; periodic++) {
        scene->period[0] = scene->period[1] = periodic ? 1.5 : 0;
        pps_rays *rays = make_rays(scene);
        pps_line line = line_from(0.6, 0.4, 0, 0, 0, 1);
        pps_hit hit;
        bool wood;
        line.near = 1.5;
        line.far = 2.5;
        assert_int_equal(pps_rays_count(rays, &line, &wood), 1);
        assert_true(pps_rays_nearest(rays, &line, &hit));
        assert_close(hit.distance, 2, 1e-6, 0);
        line.far = 1.9;
        assert_false(pps_rays_occluded(rays, &line));
        assert_false(pps_rays_nearest(rays, &line, &hit));
        pps_rays_free(rays);
    }
    pps_scene_free(scene);
}

static void a_hit_tells_where_and_which_face(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, LEAF}, {0, 0, 5, WOOD}};
    pps_scene *scene = scene_of(squares(2, at));
    scene->instance = realloc(scene->instance, 2 * sizeof *scene->instance);
    scene->n_instances = 2;
    scene->instance[1] = (pps_instance){0, {1000, 0, 1}, 90, 2};
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    pps_rays *rays = make_rays(scene);
    pps_hit hit;
    /* The second leaf covers -2 < x - 1000 < 0, 0 < y < 2 at z = 1. */
    pps_line up = line_from(998.6, 0.5, 0, 0, 0, 1);
    assert_true(pps_rays_nearest(rays, &up, &hit));
    assert_close(hit.distance, 1, 1e-4, 0);
    assert_int_equal(hit.leaf, 1);
    assert_int_equal(hit.instance, 1);
    assert_false(hit.front);
    assert_close(hit.normal[2], 1, 1e-12, 0);
    assert_close(hit.point[0], 998.6, 0, 1e-3);
    assert_close(hit.point[2], 1, 0, 2e-4); /* of 1000 m, in single precision */
    pps_line down = line_from(998.6, 0.5, 12, 0, 0, -1);
    assert_true(pps_rays_nearest(rays, &down, &hit));
    assert_true(hit.leaf == SIZE_MAX);
    assert_true(hit.front);
    assert_close(hit.point[2], 11, 0, 2e-4);
    pps_rays_free(rays);
    pps_scene_free(scene);
}

/* ---- against every triangle in turn ---- */

/* The first instance of the scene, its mesh moved and turned to where it stands. */
static pps_mesh *mesh_in_place(const pps_scene *scene) {
    pps_mesh *mesh;
    pps_crown crown = {PPS_CROWN_CLUMPED, 6, 3000, 5};
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    for (size_t i = 0; i < mesh->n_vertices; i++) {
        double at[3];
        pps_instance_point(&scene->instance[0], mesh->position[i], at);
        memcpy(mesh->position[i], at, sizeof at);
    }
    return mesh;
}

static bool meets(const pps_mesh *mesh, size_t t, const pps_line *line,
                  double *distance, double normal[3]) {
    const uint32_t *c = mesh->triangle[t];
    double ab[3], ac[3], h[3], s[3], q[3];
    vec_sub(mesh->position[c[1]], mesh->position[c[0]], ab);
    vec_sub(mesh->position[c[2]], mesh->position[c[0]], ac);
    vec_cross(ab, ac, normal);
    vec_normalize(normal);
    vec_cross(line->direction, ac, h);
    double det = vec_dot(ab, h);
    vec_sub(line->origin, mesh->position[c[0]], s);
    double u = vec_dot(s, h) / det;
    vec_cross(s, ab, q);
    double v = vec_dot(line->direction, q) / det;
    *distance = vec_dot(ac, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && *distance >= line->near &&
           *distance <= line->far && pps_alpha_there(mesh, t, u, v);
}

/* A line from above the middle of the crown, on to anywhere. */
static pps_line line_in_crown(const pps_scene *scene, uint64_t *seed) {
    double u[6];
    draw(6, u, seed);
    double from[3] = {0.6 * u[0], -0.6 * u[1], 2 * u[2] - 1};
    pps_instance_point(&scene->instance[0], from, from);
    return line_from(from[0], from[1], from[2], u[3] - 0.5, u[4] - 0.5, u[5] - 0.5);
}

static void check_against_every_triangle(const pps_scene *scene) {
    pps_mesh *mesh = mesh_in_place(scene);
    pps_rays *rays = make_rays(scene);
    uint64_t seed = 2;
    int differ = 0, sum = 0;
    for (int i = 0; i < 2000; i++) {
        pps_line line = line_in_crown(scene, &seed);
        int want = 0;
        double nearest = INFINITY, normal[3] = {0, 0, 0};
        for (size_t t = 0; t < mesh->n_triangles; t++) {
            double d, n[3];
            if (meets(mesh, t, &line, &d, n)) {
                want++;
                memcpy(normal, d < nearest ? n : normal, sizeof normal);
                nearest = fmin(nearest, d);
            }
        }
        bool wood;
        pps_hit hit;
        differ += pps_rays_count(rays, &line, &wood) != want;
        assert_false(wood);
        assert_int_equal(pps_rays_nearest(rays, &line, &hit), want > 0);
        assert_int_equal(pps_rays_occluded(rays, &line), want > 0);
        if (want) {
            double slope = vec_dot(line.direction, normal); /* errors are across it */
            assert_close(hit.distance * slope, nearest * slope, 0, 1e-6);
            assert_close(vec_dot(hit.normal, normal), 1, 1e-5, 0);
            assert_int_equal(hit.instance, 0);
        }
        sum += want;
    }
    assert_in_range(sum, 3000, 30000); /* the test means something */
    assert_in_range(differ, 0, 2);     /* rays within rounding of an edge */
    pps_rays_free(rays);
    pps_mesh_free(mesh);
}

/* Whether a mesh stands once, or is one of two that are turned and scaled. */
static void triangles_are_counted_once(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 6, 3000, 5);
    check_against_every_triangle(scene);
    scene->instance[0] = (pps_instance){0, {3, -2, 1}, 77, 0.6};
    check_against_every_triangle(scene);
    scene->instance = realloc(scene->instance, 2 * sizeof *scene->instance);
    scene->n_instances = 2;
    scene->instance[1] = (pps_instance){0, {-9, 0, 0}, 30, 0.001}; /* out of the way */
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    check_against_every_triangle(scene);
    pps_scene_free(scene);
}

static void holes_let_rays_through(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, LEAF}, {0, 0, 1, LEAF}};
    pps_mesh *mesh = squares(2, at);
    cut_right_half(mesh);
    pps_scene *scene = scene_of(mesh);
    pps_rays *rays = make_rays(scene);
    pps_line left = line_from(0.3, 0.6, -1, 0, 0, 1),
             right = line_from(0.7, 0.6, -1, 0, 0, 1);
    bool wood;
    pps_hit hit;
    assert_int_equal(pps_rays_count(rays, &left, &wood), 2);
    assert_int_equal(pps_rays_count(rays, &right, &wood), 0);
    assert_true(pps_rays_occluded(rays, &left));
    assert_false(pps_rays_occluded(rays, &right));
    assert_true(pps_rays_nearest(rays, &left, &hit));
    assert_false(pps_rays_nearest(rays, &right, &hit));
    pps_rays_free(rays);
    pps_scene_free(scene);
}

/* From every hit on along a random direction, grazing ones too. */
static void lines_that_leave_a_surface_do_not_meet_it(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 1, 2000, 6);
    scene->instance[0] = (pps_instance){0, {40, 70, -30}, 77, 0.2};
    pps_rays *rays = make_rays(scene);
    uint64_t seed = 7;
    int hits = 0;
    for (int i = 0; i < 100000; i++) {
        double d[3];
        for (int k = 0; k < 3; k++) {
            d[k] = support_random(&seed) - 0.5;
        }
        pps_line line = line_from(40 - 2 * d[0], 70 - 2 * d[1], -30 - 2 * d[2],
                                  d[0] + 0.2 * support_random(&seed) - 0.1, d[1], d[2]);
        pps_hit first, next;
        if (pps_rays_nearest(rays, &line, &first)) {
            double out[3], x[3], y[3], a = 2 * PI * support_random(&seed);
            vec_frame(first.normal, x, y);
            for (int k = 0; k < 3; k++) { /* down to 1e-6 of a radian */
                out[k] = cos(a) * x[k] + sin(a) * y[k] +
                         pow(10, -6 * support_random(&seed)) * (i % 2 ? 1 : -1) *
                             first.normal[k];
            }
            vec_normalize(out);
            line = pps_rays_leave(rays, first.point, first.normal, out);
            hits++;
            if (pps_rays_nearest(rays, &line, &next)) {
                assert_true(next.triangle != first.triangle);
            }
        }
    }
    assert_in_range(hits, 20000, 100000);
    pps_rays_free(rays);
    pps_scene_free(scene);
}

/* ---- repeating scenes ---- */

/* An open scene with 15 x 15 copies stands for the endless one, for lines that stay in it;
 * the middle one is wider than the cell, so copies overlap. */
static void a_repeating_scene_is_many_copies(void **state) {
    (void)state;
    enum { REACH = 7, N = 2 * REACH + 1 };
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 2, 300, 9);
    scene->instance[0] = (pps_instance){0, {5, -3, 2}, 30, 1};
    scene->period[0] = 1.7;
    scene->period[1] = 2.9;
    pps_rays *rays = make_rays(scene);
    pps_scene *many = crown_scene(PPS_CROWN_UNIFORM, 2, 300, 9);
    many->instance = realloc(many->instance, N * N * sizeof *many->instance);
    many->n_instances = N * N;
    for (int i = 0; i < N * N; i++) {
        int x = i % N - REACH, y = i / N - REACH;
        many->instance[i] = (pps_instance){0, {5 + 1.7 * x, -3 + 2.9 * y, 2}, 30, 1};
    }
    assert_int_equal(pps_scene_index(many), PPS_OK);
    pps_rays *all = make_rays(many);
    uint64_t seed = 3;
    int differ = 0, sum = 0;
    for (int i = 0; i < 4000; i++) {
        double u[6];
        draw(6, u, &seed);
        pps_line line = line_from(5 + 3 * u[0], -3 - u[1], 2 * u[2] + 1, u[3] - 0.5,
                                  u[4] - 0.5, 0.3 * u[5] - 0.15);
        line.far = 7;
        bool wood;
        pps_hit here, there;
        int got = pps_rays_count(rays, &line, &wood),
            want = pps_rays_count(all, &line, &wood);
        differ += got != want;
        sum += want;
        bool hit = pps_rays_nearest(rays, &line, &here);
        assert_int_equal(hit, pps_rays_nearest(all, &line, &there));
        assert_int_equal(pps_rays_occluded(rays, &line), hit);
        if (hit) {
            assert_close(here.distance, there.distance, 1e-5, 1e-5);
            assert_int_equal(here.triangle, there.triangle);
            for (int k = 0; k < 2;
                 k++) { /* whole periods apart, as near as distances */
                double period = scene->period[k],
                       apart = here.point[k] - there.point[k];
                assert_close(apart, period * round(apart / period), 0, 1e-5);
            }
        }
    }
    assert_in_range(sum, 5000, 50000);
    assert_in_range(differ, 0, 8); /* at edges, and at the line's far end */
    pps_rays_free(all);
    pps_rays_free(rays);
    pps_scene_free(many);
    pps_scene_free(scene);
}

/* A slanted line through a sheet that fills the plane meets it once, on whatever path. */
static void walls_leak_nothing(void **state) {
    (void)state;
    square at[] = {{0, 0, 0, LEAF}, {0, 0, 0.5, LEAF}};
    pps_scene *scene = scene_of(squares(2, at));
    scene->period[0] = scene->period[1] = 1;
    pps_rays *rays = make_rays(scene);
    uint64_t seed = 4;
    for (int i = 0; i < 20000; i++) {
        double u[5];
        draw(5, u, &seed);
        pps_line line = line_from(100 * u[0], -77 * u[1], 9, u[2] - 0.5, u[3] - 0.5,
                                  -0.01 - 0.1 * u[4]);
        bool wood;
        assert_in_range(pps_rays_count(rays, &line, &wood), 2, 3); /* 3: on an edge */
        assert_true(pps_rays_occluded(rays, &line));
    }
    pps_line level = line_from(0.5, 0.5, 0.25, 1, 0.1, 0);
    assert_false(pps_rays_occluded(rays, &level)); /* and it ends */
    pps_rays_free(rays);
    pps_scene_free(scene);
}

static void scenes_that_cannot_be_are_refused(void **state) {
    (void)state;
    pps_scene bare = {0};
    pps_rays *rays = (pps_rays *)&bare;
    assert_int_equal(pps_rays_create(&bare, &rays), PPS_ERR_ARGUMENT);
    assert_null(rays);
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 1, 50, 1);
    scene->period[0] = scene->period[1] = 1e-4; /* 10^8 copies */
    assert_int_equal(pps_rays_create(scene, &rays), PPS_ERR_ARGUMENT);
    assert_null(rays);
    pps_scene_free(scene);
    pps_rays_free(NULL);
}

static void the_ball_holds_all(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_TALL, 1, 500, 1);
    scene->instance[0].yaw = 33;
    scene->instance[0].scale = 3;
    pps_rays *rays = make_rays(scene);
    double center[3], radius;
    pps_rays_ball(rays, center, &radius);
    assert_in_range((int)(radius * 100), 570, 660);
    uint64_t seed = 6;
    for (int i = 0; i < 20000; i++) { /* lines that miss the ball miss all */
        double n[3], x[3], y[3], a = 2 * PI * support_random(&seed);
        n[2] = 2 * support_random(&seed) - 1;
        n[0] = sqrt(1 - n[2] * n[2]);
        n[1] = 0;
        vec_frame(n, x, y);
        pps_line line = {.near = -100, .far = 100};
        memcpy(line.direction, n, sizeof n);
        vec_along(center, radius * cos(a), x, line.origin);
        vec_along(line.origin, radius * sin(a), y, line.origin);
        line.near = 0;
        vec_along(line.origin, -50, n, line.origin);
        assert_false(pps_rays_occluded(rays, &line));
    }
    pps_rays_free(rays);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stack_of_sheets_is_counted_exactly),
        cmocka_unit_test(near_and_far_end_a_line),
        cmocka_unit_test(a_hit_tells_where_and_which_face),
        cmocka_unit_test(triangles_are_counted_once),
        cmocka_unit_test(holes_let_rays_through),
        cmocka_unit_test(lines_that_leave_a_surface_do_not_meet_it),
        cmocka_unit_test(a_repeating_scene_is_many_copies),
        cmocka_unit_test(walls_leak_nothing),
        cmocka_unit_test(scenes_that_cannot_be_are_refused),
        cmocka_unit_test(the_ball_holds_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
