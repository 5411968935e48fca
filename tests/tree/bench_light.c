/* Times of the rays' heavy users, beside what a query costs on this machine today: run it
 * on an idle machine, or read the ratios.
 *
 *     cmake --build --preset release --target bench_light && build/release/tests/tree/bench_light
 *
 * With a scene file, the times of cells and `lattice`, on one crown and on that scene.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include <omp.h>

#include <ppscat/tree/cells.h>
#include <ppscat/tree/field.h>
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

/* What `lattice` makes once a scene, and its answers from no light. */
static void time_lattice(const pps_scene *scene, const char *what) {
    char line[128];
    pps_cells *cells;
    pps_light_field *field = NULL;
    const pps_light_model *lattice = pps_light_model_find("lattice");
    times start = now();
    if (pps_cells_create(scene, NULL, &cells) ||
        pps_cells_set_sun(cells, scene, NULL)) {
        return;
    }
    snprintf(line, sizeof line, "%s: %d x %d x %d cells", what, cells->n[0],
             cells->n[1], cells->n[2]);
    print_since(start, line);
    start = now();
    pps_status status = pps_light_field_solve(lattice, scene, cells, NULL, &field);
    print_since(start, status ? "    failed" : "    lattice made and solved");
    for (int i = 0; i < 3 && !status; i++) {
        pps_light_field_forget(field);
        start = now();
        status = pps_light_field_solve(lattice, scene, cells, NULL, &field);
        snprintf(line, sizeof line, "    solved from no light, %d sweeps, ms",
                 field->sweeps);
        times end = now();
        printf("%-66s %7.2f %7.2f\n", line, 1e3 * (end.wall - start.wall),
               1e3 * (end.cpu - start.cpu));
    }
    pps_light_field_free(field);
    pps_cells_free(cells);
}

/* One crown in four bands, and the forest that a file names. */
static void time_lattices(const char *forest) {
    pps_scene *scene = crown_scene(PPS_CROWN_UNIFORM, 4, 9000, 1);
    pps_problem problem;
    scene->n_bands = 4;
    for (int b = 0; b < 4; b++) {
        scene->sun.irradiance[b] = 1;
        for (int face = 0; face < 2; face++) {
            scene->prototype[0].optics.reflectance[face][b] = 0.2 + 0.09 * b;
            scene->prototype[0].optics.transmittance[face][b] = 0.2 + 0.09 * b;
        }
    }
    time_lattice(scene, "one crown, four bands");
    pps_scene_free(scene);
    if (pps_scene_read(forest, &scene, &problem) == PPS_OK) {
        time_lattice(scene, forest);
        pps_scene_free(scene);
    }
}

int main(int argc, char **argv) {
    if (argc > 1) {
        time_lattices(argv[1]);
        return 0;
    }
    printf("%-66s %7s %7s\n", "seconds", "wall", "cpu");
    time_queries();
    time_tracing(1, 0);
    time_tracing(4, 0);
    time_tracing(8, 2);
    time_cells();
    time_queries();
    return 0;
}
