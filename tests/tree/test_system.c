/* The rendering system: steps, what they keep, and its two ways against rays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/system.h>

#include "plants.h"
#include "support/support.h"
#include "tree/vec.h"

static const double DEGREE = 3.14159265358979323846 / 180;

/* Four crowns of different turn and size, a sky, and a sun at an angle. */
static pps_scene *grove(pps_crown_shape shape, double yaw_step) {
    pps_scene *scene = crown_scene(shape, 3, 9000, 3);
    static const double at[4][2] = {{0, 0}, {2.2, 0.3}, {0.4, -2.1}, {2.6, -2.3}};
    scene->instance = realloc(scene->instance, 4 * sizeof *scene->instance);
    scene->n_instances = 4;
    for (int i = 0; i < 4; i++) {
        scene->instance[i] =
            (pps_instance){0, {at[i][0], at[i][1], 0}, yaw_step * i, 1 + 0.1 * i};
    }
    scene->sun = (pps_sun){{0.48, 0.36, 0.8}, {2, 2, 2, 2}};
    scene->sky = (pps_sky){{0.1}, {0.3}, {0.05}};
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    return scene;
}

static void step(pps_status status) { assert_int_equal(status, PPS_OK); }

static pps_system *all_steps(const pps_scene *scene, pps_system_options options) {
    pps_system *system;
    step(pps_system_create(scene, &options, &system));
    step(pps_system_construct_cells(system));
    step(pps_system_map_directions(system));
    step(pps_system_find_g(system));
    step(pps_system_light_sky(system));
    step(pps_system_light_sun(system));
    return system;
}

static pps_irradiance *shade(pps_system *system, unsigned sources) {
    pps_irradiance *light;
    step(pps_system_shade(system, sources, &light));
    return light;
}

/* Over all leaves: mean of a over mean of b, and mean |a - b| over mean of b. */
typedef struct {
    double ratio, off;
} difference;

static difference compare(const pps_irradiance *a, const pps_irradiance *b) {
    double sum_a = 0, sum_b = 0, off = 0;
    for (size_t i = 0; i < a->n_leaves * (size_t)a->n_bands; i++) {
        double x = a->front[i] + a->back[i], y = b->front[i] + b->back[i];
        sum_a += x;
        sum_b += y;
        off += fabs(x - y);
    }
    return (difference){sum_a / sum_b, off / sum_b};
}

static void steps_need_the_ones_before(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 0);
    for (int way = 0; way < 2; way++) {
        pps_system_options options = {.way = (pps_system_way)way};
        pps_system *system;
        pps_irradiance *light;
        step(pps_system_create(scene, &options, &system));
        assert_int_equal(pps_system_map_directions(system), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_system_find_g(system), PPS_ERR_ARGUMENT);
        step(pps_system_construct_cells(system));
        assert_int_equal(pps_system_light_sky(system), PPS_ERR_ARGUMENT);
        step(pps_system_map_directions(system));
        assert_int_equal(pps_system_light_sun(system), PPS_ERR_ARGUMENT);
        step(pps_system_find_g(system));
        step(pps_system_light_sun(system));
        assert_int_equal(pps_system_shade(system, 0, &light), PPS_ERR_ARGUMENT);
        assert_null(light);
        step(pps_system_light_sky(system));
        pps_irradiance_free(shade(system, 0));
        pps_system_free(system);
    }
    pps_scene_free(scene);
}

static void same(const pps_irradiance *a, const pps_irradiance *b, double rtol) {
    for (size_t i = 0; i < a->n_leaves * (size_t)a->n_bands; i++) {
        assert_close(a->front[i], b->front[i], rtol, 1e-9);
        assert_close(a->back[i], b->back[i], rtol, 1e-9);
    }
}

/* The lattice starts from its last answer: it is the same to its tolerance. */
static void a_moved_sun_needs_step_5_alone(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 72);
    for (int way = 0; way < 2; way++) {
        pps_system_options options = {.way = (pps_system_way)way};
        options.light.compensate =
            way == PPS_SYSTEM_INSTANCES ? PPS_COMPENSATE_DERIVED : 0;
        const double there[3] = {-0.6, 0, 0.8}, back[3] = {0.48, 0.36, 0.8};
        memcpy(scene->sun.to, there, sizeof there);
        pps_system *moved = all_steps(scene, options);
        memcpy(scene->sun.to, back, sizeof back);
        step(pps_system_light_sun(moved));
        pps_system *fresh = all_steps(scene, options);
        pps_irradiance *a = shade(moved, 0), *b = shade(fresh, 0);
        if (way == PPS_SYSTEM_INSTANCES) {
            same(a, b, 0);
        } else {
            assert_true(compare(a, b).off < 1e-3);
        }
        pps_irradiance_free(a);
        scene->sky.zenith[0] *= 2; /* a changed sky needs step 4 alone */
        step(pps_system_light_sky(moved));
        step(pps_system_light_sky(fresh));
        a = shade(moved, PPS_SKY | PPS_SKY_INDIRECT);
        pps_irradiance_free(b);
        b = shade(fresh, PPS_SKY | PPS_SKY_INDIRECT);
        same(a, b, way == PPS_SYSTEM_INSTANCES ? 0 : 1e-2);
        scene->sky.zenith[0] /= 2;
        pps_irradiance_free(a);
        pps_irradiance_free(b);
        pps_system_free(moved);
        pps_system_free(fresh);
    }
    pps_scene_free(scene);
}

static void the_answer_does_not_depend_on_threads(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 72);
    for (int way = 0; way < 2; way++) {
        pps_system_options one = {.way = (pps_system_way)way, .threads = 1}, four = one;
        four.threads = 4;
        pps_system *a = all_steps(scene, one), *b = all_steps(scene, four);
        pps_irradiance *x = shade(a, 0), *y = shade(b, 0);
        same(x, y, 0);
        pps_irradiance_free(x);
        pps_irradiance_free(y);
        pps_system_free(a);
        pps_system_free(b);
    }
    pps_scene_free(scene);
}

/* A scene turned as a whole, by the symmetry of the directions, is lit as before. */
static void turned_plants_see_turned_directions(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 0);
    pps_system_options options = {.way = PPS_SYSTEM_INSTANCES};
    options.light.compensate = PPS_COMPENSATE_DERIVED;
    pps_system *system = all_steps(scene, options);
    pps_irradiance *before = shade(system, 0);
    pps_system_free(system);
    double c = cos(144 * DEGREE), s = sin(144 * DEGREE);
    for (size_t i = 0; i <= scene->n_instances; i++) {
        double *v = i < 4 ? scene->instance[i].translation : scene->sun.to;
        double x = v[0], y = v[1];
        v[0] = c * x - s * y;
        v[1] = s * x + c * y;
    }
    for (size_t i = 0; i < 4; i++) {
        scene->instance[i].yaw += 144;
    }
    system = all_steps(scene, options);
    pps_irradiance *after = shade(system, 0);
    difference d = compare(after, before);
    assert_close(d.ratio, 1, 1e-4, 0);
    assert_close(d.off, 0, 0, 1e-3); /* a few looks fall on the other side of a texel */
    pps_irradiance_free(before);
    pps_irradiance_free(after);
    pps_system_free(system);
    pps_scene_free(scene);
}

/* The same model from rays, on the scene's grid. */
static pps_irradiance *by_rays(const pps_scene *scene, const pps_light_model *model,
                               pps_light_options light) {
    pps_cells_options options = {.samples = 4};
    pps_cells *cells;
    pps_irradiance *out;
    step(pps_cells_create(scene, &options, &cells));
    step(pps_cells_set_sun(cells, scene, &options));
    step(pps_light_model_run(model, scene, cells, &light, &out));
    pps_cells_free(cells);
    return out;
}

static void the_grid_is_lit_as_by_rays(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 50);
    scene->ground = (pps_ground){true, -1.5, {0.3}};
    pps_system_options options = {.sun_texels = 512};
    pps_system *system = all_steps(scene, options);
    static const unsigned parts[] = {PPS_SKY | PPS_SKY_INDIRECT, PPS_SUN_INDIRECT,
                                     PPS_ALL_LIGHT};
    static const double within[] = {0.01, 0.02, 0.02}, off[] = {0.06, 0.04, 1};
    for (size_t k = 0; k < 3; k++) {
        pps_light_options light = {.sources = parts[k]};
        pps_irradiance *map = shade(system, parts[k]),
                       *ray = by_rays(scene, pps_light_model_at(0), light);
        difference d = compare(map, ray);
        print_message(
            "grid, sources %u: mean %.3f of that by rays, leaves off by %.3f\n",
            parts[k], d.ratio, d.off);
        assert_close(d.ratio, 1, within[k], 0);
        assert_true(d.off <
                    off[k]); /* direct light: leaves here, means of cells there */
        pps_irradiance_free(map);
        pps_irradiance_free(ray);
    }
    pps_system_free(system);
    pps_scene_free(scene);
}

static void the_papers_way_is_lit_as_by_rays(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_UNIFORM, 72);
    pps_system_options options = {.way = PPS_SYSTEM_INSTANCES, .across = 16};
    options.light.compensate = PPS_COMPENSATE_DERIVED;
    pps_system *system = all_steps(scene, options);
    static const unsigned parts[] = {PPS_SKY, PPS_SKY_INDIRECT, PPS_SUN_INDIRECT};
    for (size_t k = 0; k < 3; k++) {
        unsigned sources = parts[k];
        pps_light_options light = {.sources = sources,
                                   .compensate = PPS_COMPENSATE_DERIVED};
        pps_irradiance *map = shade(system, sources),
                       *ray = by_rays(scene, pps_light_model_find("spp"), light);
        difference d = compare(map, ray);
        print_message(
            "paper, sources %u: mean %.3f of that by rays, leaves off by %.3f\n",
            sources, d.ratio, d.off);
        assert_close(d.ratio, 1, 0.02, 0);
        assert_true(d.off < 0.16); /* one cell deep in a plant, or one of the grid's */
        pps_irradiance_free(map);
        pps_irradiance_free(ray);
    }
    pps_system_free(system);
    pps_scene_free(scene);
}

/* A leaf is lit at its middle, whichever depths its scattered light is by. */
static void a_leaf_has_the_light_of_its_middle(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 72);
    for (int by_point = 0; by_point < 2; by_point++) {
        pps_system_options options = {.way = PPS_SYSTEM_INSTANCES,
                                      .light.compensate = PPS_COMPENSATE_DERIVED,
                                      .by_point = by_point};
        pps_system *system = all_steps(scene, options);
        pps_irradiance *light = shade(system, 0);
        double front[PPS_BANDS_MAX], back[PPS_BANDS_MAX];
        pps_scene_leaf leaf;
        for (size_t i = 0; i < scene->n_leaves; i += 997) {
            pps_scene_leaf_at(scene, i, &leaf);
            step(pps_system_shade_point(system, 0, i, leaf.center, leaf.normal, front,
                                        back));
            assert_close(front[0], light->front[i * (size_t)scene->n_bands], 1e-14, 0);
            assert_close(back[0], light->back[i * (size_t)scene->n_bands], 1e-14, 0);
        }
        assert_int_equal(pps_system_shade_point(system, 0, scene->n_leaves, leaf.center,
                                                leaf.normal, front, back),
                         PPS_ERR_ARGUMENT);
        assert_int_equal(pps_system_shade_point(system, 16, 0, leaf.center, leaf.normal,
                                                front, back),
                         PPS_ERR_ARGUMENT);
        pps_irradiance_free(light);
        pps_system_free(system);
    }
    pps_scene_free(scene);
}

static void what_it_cannot_do_is_refused(void **state) {
    (void)state;
    pps_scene *scene = grove(PPS_CROWN_CLUMPED, 50);
    pps_system *system;
    pps_system_options paper = {.way = PPS_SYSTEM_INSTANCES};
    assert_int_equal(pps_system_create(scene, &paper, &system), PPS_ERR_UNSUPPORTED);
    assert_null(system);
    pps_system_options leaf = {.model = pps_light_model_find("leaf")};
    assert_int_equal(pps_system_create(scene, &leaf, &system), PPS_ERR_UNSUPPORTED);
    pps_system_options across = {.across = -1};
    assert_int_equal(pps_system_create(scene, &across, &system), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_system_create(NULL, NULL, &system), PPS_ERR_ARGUMENT);
    for (size_t i = 0; i < 4; i++) {
        scene->instance[i].yaw = 0;
    }
    scene->period[0] = scene->period[1] = 6;
    assert_int_equal(pps_system_create(scene, &paper, &system), PPS_ERR_UNSUPPORTED);
    pps_system_free(NULL);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_need_the_ones_before),
        cmocka_unit_test(a_moved_sun_needs_step_5_alone),
        cmocka_unit_test(the_answer_does_not_depend_on_threads),
        cmocka_unit_test(turned_plants_see_turned_directions),
        cmocka_unit_test(the_grid_is_lit_as_by_rays),
        cmocka_unit_test(the_papers_way_is_lit_as_by_rays),
        cmocka_unit_test(a_leaf_has_the_light_of_its_middle),
        cmocka_unit_test(what_it_cannot_do_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
