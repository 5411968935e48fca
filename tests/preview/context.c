/* One headless context, the group's own; crowns for it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/preview/context.h"

#include <stdlib.h>

#include <ppscat/tree/grow.h>

#include "preview/headless.h"
#include "support/support.h"

static headless *context;

int context_setup(void **state) {
    (void)state;
    pps_problem problem = {""};
    context = headless_open(&problem);
    if (!context) {
        print_message("%s\n", problem.text);
    }
    return context ? 0 : -1;
}

int context_teardown(void **state) {
    (void)state;
    headless_close(context);
    return 0;
}

pps_scene *three_crowns(void) {
    pps_crown crown = {PPS_CROWN_CLUMPED, 2.5, 3000, 4};
    pps_mesh *mesh;
    pps_scene *scene;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    assert_int_equal(pps_scene_of_mesh(mesh, &scene), PPS_OK);
    scene->instance = realloc(scene->instance, 3 * sizeof *scene->instance);
    scene->n_instances = 3;
    scene->instance[1] = (pps_instance){0, {2, 0.3, 0}, 72, 0.8};
    scene->instance[2] = (pps_instance){0, {0.3, 2.1, 0.3}, 216, 1.2};
    assert_int_equal(pps_scene_index(scene), PPS_OK);
    return scene;
}

preview_options crowns_options(const char *model, unsigned sources) {
    preview_options o = {.width = CROWNS_WIDTH,
                         .height = CROWNS_HEIGHT,
                         .samples = 1,
                         .view = {-50, 15},
                         .zoom = 1,
                         .stage = {.sources = sources, .map_texels = 256}};
    assert_true(options_model(model, &o.stage));
    o.stage.compensate = o.stage.way == STAGE_INSTANCES ? PPS_COMPENSATE_DERIVED : 0;
    return o;
}

stage *stage_for(pps_scene *scene, const preview_options *options) {
    pps_problem problem = {""};
    stage *s = stage_open(scene, &options->stage, &problem);
    if (!s) {
        fail_msg("%s", problem.text);
    }
    return s;
}

void stage_done(stage *s) {
    pps_scene *scene = s->scene;
    stage_close(s);
    pps_scene_free(scene);
}
