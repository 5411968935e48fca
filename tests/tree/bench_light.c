/* Times of the rays' heavy users, beside what a query costs on this machine today: run it
 * on an idle machine, or read the ratios.
 *
 *     cmake --build --preset release --target bench_light && build/release/tests/tree/bench_light
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include <omp.h>

#include <ppscat/tree/cells.h>
#include <ppscat/tree/light.h>

#include "plants.h"
#include "tree/random.h"
#include "tree/rays.h"

typedef struct {
    double wall, cpu;
} times;

static times now(void) {
    struct timespec cpu;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
    return (times){omp_get_wtime(), (double)cpu.tv_sec + 1e-9 * (double)cpu.tv_nsec};
}

static void print_since(times start, const char *what) {
    times end = now();
    printf("%-66s %7.2f %7.2f\n", what, end.wall - start.wall, end.cpu - start.cpu);
}

/* A million queries from points in the crown along random directions. */
static void time_queries(void) {
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 4, 9000, 1);
    pps_rays *rays;
    if (pps_rays_create(scene, &rays)) {
        return;
    }
    times start = now();
    for (uint64_t i = 0; i < 1000000; i++) {
        pps_uniforms r = pps_random(1, PPS_RANDOM_CELLS, i, 0);
        double z = 2 * r.u[2] - 1, s = sqrt(1 - z * z), phi = 6.283185 * r.u[3];
        pps_line line = {{r.u[0] - 0.5, r.u[1] - 0.5, 0},
                         {s * cos(phi), s * sin(phi), z},
                         0,
                         INFINITY};
        pps_hit hit;
        pps_rays_nearest(rays, &line, &hit);
    }
    print_since(start, "1M nearest hits, 18K triangles, index 4, one thread");
    pps_rays_free(rays);
    pps_scene_free(scene);
}

static void time_tracing(double leaf_area_index, double period) {
    char what[128];
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, leaf_area_index, 9000, 1);
    pps_trace_options options = {.rays = 4000000, .seed = 1};
    pps_irradiance *e;
    scene->period[0] = scene->period[1] = period;
    times start = now();
    pps_status status = pps_trace_light(scene, &options, &e, NULL);
    snprintf(what, sizeof what, "4M light rays, 18K triangles, index %g, period %g%s",
             leaf_area_index, period, status ? ": failed" : "");
    print_since(start, what);
    pps_irradiance_free(e);
    pps_scene_free(scene);
}

static void time_cells(void) {
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 3, 31250, 1);
    pps_cells *cells;
    times start = now();
    if (pps_cells_create(scene, NULL, &cells)) {
        return;
    }
    print_since(start, "22 directions of visibility, 62.5K triangles, index 3");
    start = now();
    pps_cells_set_sun(cells, scene, NULL);
    print_since(start, "the sun moves");
    pps_cells_free(cells);
    pps_scene_free(scene);
}

int main(void) {
    printf("%-66s %7s %7s\n", "seconds", "wall", "cpu");
    time_queries();
    time_tracing(1, 0);
    time_tracing(4, 0);
    time_tracing(8, 2);
    time_cells();
    time_queries();
    return 0;
}
