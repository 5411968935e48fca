/* Triangles that count for nothing: without area, or on the places of another. Double-
 * sided cards are often made of two, back to back; a leaf is there once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "tree/doubled.h"
#include "tree/vec.h"

typedef struct {
    const double *corner[3]; /* in order of place, so turns and sides are one */
    uint32_t triangle;
    bool leaf;
} placed;

static int compare_places(const double *a, const double *b) {
    for (int i = 0; i < 3; i++) {
        if (a[i] != b[i]) {
            return a[i] < b[i] ? -1 : 1;
        }
    }
    return 0;
}

static int compare_corners(const placed *a, const placed *b) {
    int order = 0;
    for (int i = 0; i < 3 && !order; i++) {
        order = compare_places(a->corner[i], b->corner[i]);
    }
    return order ? order : (int)a->leaf - (int)b->leaf;
}

static int by_corners(const void *a, const void *b) {
    const placed *p = a, *q = b;
    int order = compare_corners(p, q);
    return order ? order : (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static placed place(const pps_mesh *mesh, uint32_t t) {
    placed out = {.triangle = t, .leaf = mesh->material[mesh->material_of[t]].leaf};
    const double **c = out.corner;
    for (int i = 0; i < 3; i++) {
        c[i] = mesh->position[mesh->triangle[t][i]];
    }
    for (int i = 0; i < 3; i++) { /* three exchanges sort three */
        int at = i % 2;
        if (compare_places(c[at], c[at + 1]) > 0) {
            const double *swap = c[at];
            c[at] = c[at + 1];
            c[at + 1] = swap;
        }
    }
    return out;
}

static bool has_area(const pps_mesh *mesh, uint32_t t) {
    const uint32_t *corner = mesh->triangle[t];
    double ab[3], ac[3], normal[3];
    vec_sub(mesh->position[corner[1]], mesh->position[corner[0]], ab);
    vec_sub(mesh->position[corner[2]], mesh->position[corner[0]], ac);
    vec_cross(ab, ac, normal);
    return vec_length(normal) > 0;
}

pps_status pps_mesh_drop_doubled(pps_mesh *mesh) {
    size_t n = mesh->n_triangles, kept = 0;
    placed *list = malloc((n + 1) * sizeof *list);
    bool *drop = calloc(n + 1, sizeof *drop);
    if (!list || !drop) {
        free(list);
        free(drop);
        return PPS_ERR_MEMORY;
    }
    for (uint32_t t = 0; t < n; t++) {
        list[t] = place(mesh, t);
    }
    qsort(list, n, sizeof *list, by_corners);
    for (size_t i = 1; i < n; i++) {
        drop[list[i].triangle] = compare_corners(&list[i - 1], &list[i]) == 0;
    }
    pps_status status = pps_mesh_doubled_quads(mesh, drop);
    mesh->n_doubled = 0;
    for (uint32_t t = 0; !status && t < n; t++) {
        bool area = has_area(mesh, t);
        mesh->n_doubled += area && drop[t];
        if (area && !drop[t]) {
            memmove(mesh->triangle[kept], mesh->triangle[t], sizeof *mesh->triangle);
            mesh->material_of[kept++] = mesh->material_of[t];
        }
    }
    mesh->n_triangles = status ? n : kept;
    free(list);
    free(drop);
    return status;
}
