/* Deep opacity maps: whole counts, areas, edges, alpha, and depths against rays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/cells.h>
#include <ppscat/tree/opacity.h>

#include "plants.h"
#include "support/support.h"
#include "tree/opacity_look.h"
#include "tree/rays.h"
#include "tree/vec.h"

static const double UP[3] = {0, 0, 1};

static pps_opacity_map *map_of(const pps_mesh *mesh, const double to[3], int texels) {
    pps_opacity_options options = {.texels = texels};
    pps_opacity_map *map;
    assert_int_equal(pps_opacity_map_create(mesh, to, &options, &map), PPS_OK);
    return map;
}

static double total(const pps_opacity_map *map, size_t t) {
    return (double)map->count[t * PPS_OPACITY_LAYERS + PPS_OPACITY_LAYERS - 1];
}

static void a_stack_of_sheets_is_counted_sheet_by_sheet(void **state) {
    (void)state;
    enum { N = PPS_OPACITY_LAYERS }; /* sheet k lies at the top end of layer k */
    square at[N];
    for (int i = 0; i < N; i++) {
        at[i] = (square){0, 0, i, LEAF};
    }
    pps_mesh *mesh = squares(N, at);
    pps_opacity_map *map = map_of(mesh, UP, 16);
    const double beside[3] = {1.5, 0.5, -5}, above[3] = {0.5, 0.5, N + 1};
    assert_close(pps_opacity_depth(map, above), 0, 0, 0);
    assert_close(pps_opacity_depth(map, beside), 0, 0, 0);
    for (double z = N - 1.0; z > -2; z -= 0.25) {
        const double point[3] = {0.5, 0.4, z};
        /* From the first sheet to the last the count grows evenly but for rounding into
         * layers: within one sheet of the sheets above. */
        double above_it = fmin(N - 1 - floor(z), N);
        assert_close(pps_opacity_depth(map, point), above_it, 0, 1);
        assert_close(pps_opacity_visibility(map, point, 0.1), z > N - 1.05, 0, 0);
    }
    const double below[3] = {0.5, 0.4, -0.01};
    assert_close(pps_opacity_depth(map, below), N, 0, 0);
    pps_opacity_map_free(map);
    pps_mesh_free(mesh);
}

/* Where it is all that a texel holds too, whatever rounding makes of its place. */
static void a_leaf_is_not_in_its_own_shade(void **state) {
    (void)state;
    static const double normal[3] = {0, 0, 1}, to[3] = {0.48, 0.36, 0.8};
    const square at[] = {{0, 0, 0.3, LEAF}};
    pps_mesh *mesh = squares(1, at);
    pps_opacity_map *map = map_of(mesh, to, 32);
    for (int i = 0; i < 400; i++) {
        const double point[3] = {0.1 + 0.04 * (i % 20), 0.1 + 0.04 * (i / 20), 0.3};
        pps_opacity_look look;
        assert_true(pps_opacity_look_at(map, point, normal, &look));
        assert_close(look.depth, 0, 0, 0);
        assert_close(look.behind, 0, 0, 0);
    }
    pps_opacity_map_free(map);
    pps_mesh_free(mesh);
}

static void neighbours_share_no_texel(void **state) {
    (void)state;
    /* A fan of leaf triangles that fills a square, its corners on middles of texels. */
    enum { N = 14 };
    static const double corner[4][2] = {{0, 0}, {N, 0}, {N, N}, {0, N}};
    for (int hub = 0; hub <= N; hub++) {
        pps_mesh *mesh = calloc(1, sizeof *mesh);
        mesh->n_vertices = 5;
        mesh->n_triangles = 4;
        mesh->n_materials = 1;
        mesh->position = calloc(5, sizeof *mesh->position);
        mesh->triangle = calloc(4, sizeof *mesh->triangle);
        mesh->material_of = calloc(4, sizeof *mesh->material_of);
        mesh->material = calloc(1, sizeof *mesh->material);
        mesh->material[0] = (pps_material){calloc(5, 1), true, {1, 1, 1}, -1, 0};
        for (int i = 0; i < 4; i++) {
            memcpy(mesh->position[i], corner[i], sizeof corner[i]);
            mesh->triangle[i][0] = (uint32_t)i;
            mesh->triangle[i][1] = (uint32_t)(i + 1) % 4;
            mesh->triangle[i][2] = 4;
        }
        mesh->position[4][0] = hub * 0.5 + 3;
        mesh->position[4][1] = N - hub * 0.75;
        assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
        pps_opacity_map *map = map_of(mesh, UP, N + 2);
        size_t n = 0;
        for (size_t t = 0; t < (N + 2) * (N + 2); t++) {
            assert_true(total(map, t) <= 1);
            n += total(map, t) == 1;
        }
        assert_int_equal(n, N * N);
        pps_opacity_map_free(map);
        pps_mesh_free(mesh);
    }
}

/* The areas of leaves, or of wood that faces the light, as the light sees them. */
static double projected_area(const pps_mesh *mesh, bool wood, const double to[3]) {
    double sum = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle[t];
        double ab[3], ac[3], n[3];
        vec_sub(mesh->position[c[1]], mesh->position[c[0]], ab);
        vec_sub(mesh->position[c[2]], mesh->position[c[0]], ac);
        vec_cross(ab, ac, n);
        double area = vec_dot(n, to) / 2;
        if (wood == (mesh->leaf_of[t] == PPS_NO_LEAF)) {
            sum += wood ? fmax(area, 0) : fabs(area);
        }
    }
    return sum;
}

/* Twigs are thinner than a texel of a small map, and either meet its middle or do not:
 * 64 texels across find 4 % too much wood in a maple, 512 half a percent, 1024 .05. */
static void counts_add_up_to_projected_areas(void **state) {
    enum { FINE = 512 };
    (void)state;
    pps_mesh *mesh;
    assert_int_equal(pps_species_grow("cherry", 1, &mesh, NULL), PPS_OK);
    pps_directions directions = pps_directions_22();
    for (int j = 0; j < directions.n; j++) {
        pps_opacity_map *map = map_of(mesh, directions.to[j], FINE);
        double sum = 0;
        for (size_t t = 0; t < (size_t)map->texels * (size_t)map->texels; t++) {
            sum += total(map, t);
            assert_true((total(map, t) > 0) == (map->first[t] <= map->last[t]));
        }
        assert_close(sum * map->size[0] * map->size[1],
                     projected_area(mesh, false, directions.to[j]) +
                         projected_area(mesh, true, directions.to[j]),
                     0.01, 0);
        pps_opacity_map_free(map);
    }
    pps_mesh_free(mesh);
}

static void cut_out_alpha_lets_light_through(void **state) {
    (void)state;
    const square sheet[2] = {{0, 0, 0, LEAF}, {0, 0, 1, LEAF}};
    pps_mesh *mesh = squares(2, sheet);
    cut_right_half(mesh);
    for (int side = -1; side <= 1; side += 2) { /* seen from above and below */
        const double to[3] = {0, 0, side};
        pps_opacity_map *map = map_of(mesh, to, 66);
        double sum = 0;
        for (size_t t = 0; t < 66 * 66; t++) {
            sum += total(map, t);
        }
        assert_close(sum, 2 * 64 * 32, 0, 0);
        const double left[3] = {0.25, 0.5, -3 * side},
                     right[3] = {0.75, 0.5, -3 * side};
        assert_close(pps_opacity_depth(map, left), 2, 0, 0);
        assert_close(pps_opacity_depth(map, right), 0, 0, 0);
        pps_opacity_map_free(map);
    }
    pps_mesh_free(mesh);
}

static void a_branch_counts_once(void **state) {
    enum { FINE = 1024 };
    (void)state;
    pps_mesh *mesh;
    assert_int_equal(pps_species_grow("maple", 1, &mesh, NULL), PPS_OK);
    pps_opacity_options options = {.texels = FINE, .wood = 40};
    pps_opacity_map *light = map_of(mesh, UP, FINE), *heavy;
    assert_int_equal(pps_opacity_map_create(mesh, UP, &options, &heavy), PPS_OK);
    double more = 0;
    for (size_t t = 0; t < FINE * FINE; t++) {
        more += total(heavy, t) - total(light, t);
    }
    assert_close(more * light->size[0] * light->size[1],
                 39 * projected_area(mesh, true, UP), 0.01, 0);
    pps_opacity_map_free(light);
    pps_opacity_map_free(heavy);
    pps_mesh_free(mesh);
}

/* Mean depths through the crown, against counts along rays. */
enum { RAYS = 50000 };
static void depths_are_those_of_rays(void **state) {
    (void)state;
    pps_scene *scene = crown_scene(PPS_CROWN_CLUMPED, 3, 20000, 5);
    pps_rays *rays;
    assert_int_equal(pps_rays_create(scene, &rays), PPS_OK);
    pps_directions directions = pps_directions_22();
    for (int j = 0; j < directions.n; j += 5) {
        pps_opacity_map *map = map_of(scene->prototype[0].mesh, directions.to[j], 0);
        double by_map = 0, by_rays = 0;
        uint64_t seed = 7;
        for (int i = 0; i < RAYS; i++) {
            double p[3];
            for (int k = 0; k < 3; k++) {
                p[k] = 2 * support_random(&seed) - 1;
            }
            bool wood;
            pps_line line = {.near = 0, .far = INFINITY};
            memcpy(line.origin, p, sizeof p);
            memcpy(line.direction, directions.to[j], sizeof line.direction);
            by_rays += pps_rays_count(rays, &line, &wood);
            by_map += pps_opacity_depth(map, p);
        }
        assert_true(by_rays > RAYS / 2.0);
        assert_close(by_map, by_rays, 0.03, 0);
        pps_opacity_map_free(map);
    }
    pps_rays_free(rays);
    pps_scene_free(scene);
}

static void bad_arguments_are_refused(void **state) {
    (void)state;
    const square sheet = {0, 0, 0, LEAF};
    static const double slack[3] = {0, 0, 1.1}, nan[3] = {NAN, 0, 1};
    static const pps_opacity_options bad[] = {{3, 0}, {4097, 0}, {-1, 0}, {0, -1}};
    pps_mesh *mesh = squares(1, &sheet);
    pps_opacity_map *map = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(pps_opacity_map_create(mesh, UP, &bad[i], &map),
                         PPS_ERR_ARGUMENT);
        assert_null(map);
    }
    assert_int_equal(pps_opacity_map_create(mesh, slack, NULL, &map), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_opacity_map_create(mesh, nan, NULL, &map), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_opacity_map_create(NULL, UP, NULL, &map), PPS_ERR_ARGUMENT);
    pps_opacity_map_free(NULL);
    pps_mesh_free(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stack_of_sheets_is_counted_sheet_by_sheet),
        cmocka_unit_test(a_leaf_is_not_in_its_own_shade),
        cmocka_unit_test(neighbours_share_no_texel),
        cmocka_unit_test(counts_add_up_to_projected_areas),
        cmocka_unit_test(cut_out_alpha_lets_light_through),
        cmocka_unit_test(a_branch_counts_once),
        cmocka_unit_test(depths_are_those_of_rays),
        cmocka_unit_test(bad_arguments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
