/* Statistical crowns: square leaves of random place and orientation.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>

#include "tree/random.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

enum { DEFAULT_LEAVES = 9000, N_CLUMPS = 220 };
static const double CLUMP_RADIUS = 0.11; /* standard deviation, of crown radii */

/* Events of one leaf's row of random numbers. */
enum { PLACE, TILT, CLUMP, RETRY };

static void unit_vector(double u, double v, double out[3]) {
    double z = 2 * u - 1, s = sqrt(1 - z * z);
    out[0] = s * cos(2 * PI * v);
    out[1] = s * sin(2 * PI * v);
    out[2] = z;
}

/* Evenly in the shell inner < r < 1. */
static void in_shell(const pps_uniforms *r, double inner, double out[3]) {
    double cube = inner * inner * inner;
    double radius = cbrt(cube + (1 - cube) * r->u[2]);
    unit_vector(r->u[0], r->u[1], out);
    for (int i = 0; i < 3; i++) {
        out[i] *= radius;
    }
}

/* A Gaussian step from a clump's centre, drawn again until it is in the ball. */
static void in_clump(const pps_crown *crown, uint64_t leaf, double out[3]) {
    pps_uniforms pick = pps_random(crown->seed, PPS_RANDOM_CROWN, leaf, CLUMP);
    uint64_t clump = (uint64_t)(pick.u[0] * N_CLUMPS);
    pps_uniforms at = pps_random(crown->seed, PPS_RANDOM_CROWN, UINT64_MAX - clump, 0);
    double center[3];
    in_shell(&at, 0, center);
    for (uint64_t again = 0;; again++) {
        pps_uniforms r = pps_random(crown->seed, PPS_RANDOM_CROWN, leaf, RETRY + again);
        double near = CLUMP_RADIUS * sqrt(-2 * log(r.u[0]));
        double far = CLUMP_RADIUS * sqrt(-2 * log(r.u[2]));
        double step[3] = {near * cos(2 * PI * r.u[1]), near * sin(2 * PI * r.u[1]),
                          far * cos(2 * PI * r.u[3])};
        vec_along(center, 1, step, out);
        if (vec_length(out) <= 1) {
            return;
        }
    }
}

static void place_leaf(const pps_crown *crown, uint64_t leaf, double out[3]) {
    pps_uniforms r = pps_random(crown->seed, PPS_RANDOM_CROWN, leaf, PLACE);
    switch (crown->shape) {
    case PPS_CROWN_CLUMPED:
        in_clump(crown, leaf, out);
        break;
    case PPS_CROWN_HOLLOW:
        in_shell(&r, 0.5, out);
        break;
    case PPS_CROWN_TALL:
        in_shell(&r, 0, out);
        out[2] *= 2;
        break;
    case PPS_CROWN_UNIFORM:
        in_shell(&r, 0, out);
    }
}

/* A square of side `side` about `center`, any way up. */
static void add_square(pps_mesh *mesh, const pps_crown *crown, uint32_t leaf,
                       const double center[3], double side) {
    pps_uniforms r = pps_random(crown->seed, PPS_RANDOM_CROWN, leaf, TILT);
    double n[3], x[3], y[3], a[3], b[3];
    unit_vector(r.u[0], r.u[1], n);
    vec_frame(n, x, y);
    double c = cos(2 * PI * r.u[2]) * side / 2, s = sin(2 * PI * r.u[2]) * side / 2;
    for (int i = 0; i < 3; i++) {
        a[i] = c * x[i] + s * y[i];
        b[i] = c * y[i] - s * x[i];
    }
    for (uint32_t corner = 0; corner < 4; corner++) {
        double along = corner == 1 || corner == 2 ? 1 : -1,
               across = corner < 2 ? -1 : 1;
        double *p = mesh->position[4 * leaf + corner];
        vec_along(center, along, a, p);
        vec_along(p, across, b, p);
    }
    uint32_t first = 4 * leaf;
    uint32_t two[2][3] = {{first, first + 1, first + 2}, {first, first + 2, first + 3}};
    memcpy(mesh->triangle[2 * leaf], two, sizeof two);
}

static pps_mesh *empty_crown(size_t n_leaves) {
    pps_mesh *mesh = calloc(1, sizeof *mesh);
    if (!mesh) {
        return NULL;
    }
    mesh->n_vertices = 4 * n_leaves;
    mesh->n_triangles = 2 * n_leaves;
    mesh->position = malloc(mesh->n_vertices * sizeof *mesh->position);
    mesh->triangle = malloc(mesh->n_triangles * sizeof *mesh->triangle);
    mesh->material_of = calloc(mesh->n_triangles, sizeof *mesh->material_of);
    mesh->material = calloc(1, sizeof *mesh->material);
    char *name = malloc(sizeof "leaf");
    if (!mesh->position || !mesh->triangle || !mesh->material_of || !mesh->material ||
        !name) {
        free(name);
        pps_mesh_free(mesh);
        return NULL;
    }
    memcpy(name, "leaf", sizeof "leaf");
    mesh->n_materials = 1;
    mesh->material[0] = (pps_material){name, true, {0.2, 0.5, 0.1}, -1, 0};
    return mesh;
}

pps_status pps_crown_grow(const pps_crown *crown, pps_mesh **out) {
    *out = NULL;
    uint32_t n = crown->n_leaves ? crown->n_leaves : DEFAULT_LEAVES;
    if (!(crown->leaf_area_index > 0) || !isfinite(crown->leaf_area_index) ||
        n > PPS_NO_LEAF / 8) {
        return PPS_ERR_ARGUMENT;
    }
    pps_mesh *mesh = empty_crown(n);
    if (!mesh) {
        return PPS_ERR_MEMORY;
    }
    double side = sqrt(crown->leaf_area_index * PI / n);
    for (uint32_t i = 0; i < n; i++) {
        double center[3] = {0, 0, 0};
        place_leaf(crown, i, center);
        add_square(mesh, crown, i, center, side);
    }
    pps_status status = pps_mesh_finish(mesh);
    if (status) {
        pps_mesh_free(mesh);
        return status;
    }
    *out = mesh;
    return PPS_OK;
}
