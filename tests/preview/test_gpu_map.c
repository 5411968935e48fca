/* The GPU's opacity maps against the library's, texel by texel.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <ppscat/tree/cells.h>
#include <ppscat/tree/grow.h>

#include "preview/gpu_map.h"
#include "support/support.h"
#include "tests/preview/context.h"

enum { LAYERS = PPS_OPACITY_LAYERS };

typedef struct {
    size_t covered;      /* texels that either map covers */
    size_t counts, ends; /* of these: the same layers; the same first and last */
} agreement;

/* The same map by both. Ends agree to 1e-5 of the plant's depth. */
static agreement compare(const pps_mesh *mesh, const gpu_mesh *on_gpu,
                         const double to[3], int texels, int wood) {
    pps_problem problem = {""};
    pps_opacity_options options = {texels, wood};
    pps_opacity_map *cpu, *gpu, frame;
    gpu_maps maps;
    agreement sum = {0};
    assert_int_equal(pps_opacity_map_create(mesh, to, &options, &cpu), PPS_OK);
    assert_int_equal(pps_opacity_map_create(mesh, to, &options, &gpu), PPS_OK);
    assert_int_equal(pps_opacity_frame(mesh, to, &options, &frame), PPS_OK);
    assert_true(gpu_maps_create(texels, 2, true, &maps, &problem));
    gpu_maps_draw(&maps, 1, on_gpu, &frame, wood);
    gpu_maps_read(&maps, 1, gpu);
    assert_true(gl_check("a map", &problem));
    for (size_t t = 0; t < (size_t)texels * (size_t)texels; t++) {
        const float *a = cpu->count + t * LAYERS, *b = gpu->count + t * LAYERS;
        bool same = true;
        for (int k = 0; k < LAYERS; k++) {
            same = same && a[k] == b[k];
        }
        if (a[LAYERS - 1] > 0 || b[LAYERS - 1] > 0) {
            sum.covered++;
            sum.counts += same;
            sum.ends += fabsf(cpu->first[t] - gpu->first[t]) < 1e-4F &&
                        fabsf(cpu->last[t] - gpu->last[t]) < 1e-4F;
        } else {
            assert_true(isinf(gpu->first[t]) && isinf(gpu->last[t]));
        }
    }
    gpu_maps_free(&maps);
    pps_opacity_map_free(cpu);
    pps_opacity_map_free(gpu);
    return sum;
}

static void compare_everywhere(const char *name, const pps_mesh *mesh, int texels,
                               int wood) {
    gpu_mesh on_gpu;
    agreement all = {0};
    pps_directions directions = pps_directions_22();
    assert_int_equal(gpu_mesh_create(mesh, &on_gpu), PPS_OK);
    for (int j = 0; j < directions.n; j += 3) {
        agreement one = compare(mesh, &on_gpu, directions.to[j], texels, wood);
        all.covered += one.covered;
        all.counts += one.counts;
        all.ends += one.ends;
    }
    double counts = (double)all.counts / (double)all.covered,
           ends = (double)all.ends / (double)all.covered;
    print_message("%s, %d^2: %.4f %% of covered texels with equal layers, %.4f %% with "
                  "equal ends\n",
                  name, texels, 100 * counts, 100 * ends);
    assert_true(all.covered > 1000);
    assert_true(counts >= 0.999);
    assert_true(ends >= 0.999);
    gpu_mesh_free(&on_gpu);
}

static void a_grown_tree_has_the_same_maps(void **state) {
    (void)state;
    pps_mesh *mesh;
    assert_int_equal(pps_species_grow("cherry", 1, &mesh, NULL), PPS_OK);
    compare_everywhere("cherry", mesh, 128, 1);
    compare_everywhere("cherry", mesh, 512, 30);
    pps_mesh_free(mesh);
}

static void cut_out_leaves_have_the_same_maps(void **state) {
    (void)state;
    pps_problem problem = {""};
    pps_mesh *mesh;
    pps_status status =
        pps_mesh_read(PPS_DATA_DIR "/trees/oak_small.obj", NULL, &mesh, &problem);
    print_message("%s", problem.text);
    assert_int_equal(status, PPS_OK);
    compare_everywhere("oak with cut-out leaves", mesh, 128, 1);
    pps_mesh_free(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grown_tree_has_the_same_maps),
        cmocka_unit_test(cut_out_leaves_have_the_same_maps),
    };
    return cmocka_run_group_tests(tests, context_setup, context_teardown);
}
