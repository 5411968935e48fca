/* Cut-out alpha: nearest texel, texture repeated, there where alpha >= alpha_min.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/alpha.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Of n^2 equal small triangles, the share that is there at their centres. */
static double coverage(const pps_mesh *mesh, size_t triangle, int n) {
    int64_t there = 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n - i; j++) {
            there +=
                pps_alpha_there(mesh, triangle, (i + 1 / 3.0) / n, (j + 1 / 3.0) / n);
            if (i + j + 1 < n) {
                there += pps_alpha_there(mesh, triangle, (i + 2 / 3.0) / n,
                                         (j + 2 / 3.0) / n);
            }
        }
    }
    return (double)there / ((double)n * n);
}

/* What a triangle's share depends on: material and texture coordinates. Leaf cards have few
 * different ones. */
typedef struct {
    uint32_t material;
    float uv[3][2];
    uint32_t triangle;
} cut;

static int by_look(const void *a, const void *b) {
    const cut *p = a, *q = b;
    if (p->material != q->material) {
        return p->material < q->material ? -1 : 1;
    }
    for (int i = 0; i < 6; i++) {
        float u = p->uv[i / 2][i % 2], v = q->uv[i / 2][i % 2];
        if (u < v || u > v) {
            return u < v ? -1 : 1;
        }
    }
    return 0;
}

static size_t list_cuts(const pps_mesh *mesh, cut *list) {
    size_t n = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        if (pps_alpha_any(mesh, t)) {
            list[n] = (cut){.material = mesh->material_of[t], .triangle = t};
            for (int i = 0; i < 3; i++) {
                memcpy(list[n].uv[i], mesh->uv[mesh->triangle[t][i]],
                       sizeof list[n].uv[i]);
            }
            n++;
        }
    }
    qsort(list, n, sizeof *list, by_look);
    return n;
}

/* Points along a side: as fine as a budget of points for the whole mesh allows. */
static int fineness(size_t different) {
    static const double BUDGET = 5e7, COARSEST = 48, FINEST = 1024;
    return (int)fmin(fmax(sqrt(BUDGET / (double)different), COARSEST), FINEST);
}

pps_status pps_alpha_coverage(const pps_mesh *mesh, double *share) {
    cut *list = malloc((mesh->n_triangles + 1) * sizeof *list);
    if (!list) {
        return PPS_ERR_MEMORY;
    }
    size_t n = list_cuts(mesh, list), different = 1;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        share[t] = 1;
    }
    for (size_t i = 1; i < n; i++) {
        different += by_look(&list[i - 1], &list[i]) != 0;
    }
    for (size_t i = 0; i < n; i++) {
        bool same = i > 0 && by_look(&list[i - 1], &list[i]) == 0;
        share[list[i].triangle] =
            same ? share[list[i - 1].triangle]
                 : coverage(mesh, list[i].triangle, fineness(different));
    }
    free(list);
    return PPS_OK;
}
