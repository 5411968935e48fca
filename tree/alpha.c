/* Cut-out alpha: nearest texel, texture repeated, there where alpha >= alpha_min.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/alpha.h"

#include <math.h>

bool pps_alpha_any(const pps_mesh *mesh, size_t triangle) {
    const pps_material *m = &mesh->material[mesh->material_of[triangle]];
    return mesh->uv && m->texture >= 0 && m->alpha_min > 0;
}

/* The texel that a coordinate falls in; coordinates repeat with period 1. */
static int texel(double coordinate, int n) {
    double f = coordinate - floor(coordinate);
    int i = (int)(f * n);
    return i < n ? i : n - 1;
}

bool pps_alpha_there(const pps_mesh *mesh, size_t triangle, double u, double v) {
    if (!pps_alpha_any(mesh, triangle)) {
        return true;
    }
    const pps_material *m = &mesh->material[mesh->material_of[triangle]];
    const pps_texture *t = &mesh->texture[m->texture];
    double at[2];
    for (int i = 0; i < 2; i++) {
        const uint32_t *corner = mesh->triangle[triangle];
        double a = (double)mesh->uv[corner[0]][i], b = (double)mesh->uv[corner[1]][i],
               c = (double)mesh->uv[corner[2]][i];
        at[i] = a + u * (b - a) + v * (c - a);
    }
    int x = texel(at[0], t->width), y = t->height - 1 - texel(at[1], t->height);
    return t->rgba[4 * (y * t->width + x) + 3] / 255.0 >= m->alpha_min;
}

double pps_alpha_coverage(const pps_mesh *mesh, size_t triangle) {
    enum { N = 48 }; /* n^2 equal small triangles, seen at their centres */
    if (!pps_alpha_any(mesh, triangle)) {
        return 1;
    }
    int there = 0;
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N - i; j++) {
            there +=
                pps_alpha_there(mesh, triangle, (i + 1 / 3.0) / N, (j + 1 / 3.0) / N);
            if (i + j + 1 < N) {
                there += pps_alpha_there(mesh, triangle, (i + 2 / 3.0) / N,
                                         (j + 2 / 3.0) / N);
            }
        }
    }
    return there / (double)(N * N);
}
