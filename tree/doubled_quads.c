/* Double-sided cards whose sides are cut along different diagonals. The four triangles then
 * are the faces of a flat tetrahedron: every two of them share an edge.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/doubled.h"
#include "tree/vec.h"
#include "tree/weld.h"

enum { MOST_AT_EDGE = 8 }; /* more triangles at an edge are no card */

typedef struct {
    uint32_t low, high, third, triangle;
} side;

/* Two triangles with a common edge, and their four places in order. */
typedef struct {
    uint32_t place[4], triangle[2];
} pair;

static int by_edge(const void *a, const void *b) {
    const side *p = a, *q = b;
    if (p->low != q->low) {
        return p->low < q->low ? -1 : 1;
    }
    if (p->high != q->high) {
        return p->high < q->high ? -1 : 1;
    }
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static int by_places(const void *a, const void *b) {
    const pair *p = a, *q = b;
    for (int i = 0; i < 4; i++) {
        if (p->place[i] != q->place[i]) {
            return p->place[i] < q->place[i] ? -1 : 1;
        }
    }
    return 0;
}

static bool is_leaf(const pps_mesh *mesh, uint32_t t) {
    return mesh->material[mesh->material_of[t]].leaf;
}

static size_t list_sides(const pps_mesh *mesh, const uint32_t *same, const bool *drop,
                         side *out) {
    size_t n = 0;
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        for (int i = 0; i < 3 && !drop[t]; i++) {
            uint32_t a = same[mesh->triangle[t][i]];
            uint32_t b = same[mesh->triangle[t][(i + 1) % 3]];
            uint32_t c = same[mesh->triangle[t][(i + 2) % 3]];
            out[n++] = (side){a < b ? a : b, a < b ? b : a, c, t};
        }
    }
    qsort(out, n, sizeof *out, by_edge);
    return n;
}

static pair make_pair(const side *a, const side *b) {
    pair out = {{a->low, a->high, a->third, b->third}, {a->triangle, b->triangle}};
    for (int i = 1; i < 4; i++) {
        for (int j = i; j > 0 && out.place[j - 1] > out.place[j]; j--) {
            uint32_t swap = out.place[j];
            out.place[j] = out.place[j - 1];
            out.place[j - 1] = swap;
        }
    }
    return out;
}

/* Pairs at every edge; out NULL: only their number. */
static size_t list_pairs(const pps_mesh *mesh, const side *sides, size_t n, pair *out) {
    size_t pairs = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = i + 1;
             j < n && j < i + MOST_AT_EDGE && sides[j].low == sides[i].low &&
             sides[j].high == sides[i].high;
             j++) {
            if (sides[i].third != sides[j].third &&
                is_leaf(mesh, sides[i].triangle) == is_leaf(mesh, sides[j].triangle)) {
                if (out) {
                    out[pairs] = make_pair(&sides[i], &sides[j]);
                }
                pairs++;
            }
        }
    }
    return pairs;
}

static void normal_of(const pps_mesh *mesh, uint32_t t, double normal[3]) {
    const uint32_t *corner = mesh->triangle[t];
    double ab[3], ac[3];
    vec_sub(mesh->position[corner[1]], mesh->position[corner[0]], ab);
    vec_sub(mesh->position[corner[2]], mesh->position[corner[0]], ac);
    vec_cross(ab, ac, normal);
}

/* The four faces of a flat tetrahedron, of which two look each way: drop those that look
 * against the first. */
static void drop_back(const pps_mesh *mesh, const uint32_t face[4], bool *drop) {
    double normal[4][3], forward = 0, backward = 0;
    bool back[4];
    for (int i = 0; i < 4; i++) {
        normal_of(mesh, face[i], normal[i]);
        double along = vec_dot(normal[0], normal[i]);
        double length = vec_length(normal[0]) * vec_length(normal[i]);
        if (fabs(along) < length * (1 - 1e-6)) {
            return; /* not flat */
        }
        back[i] = along < 0;
        *(back[i] ? &backward : &forward) += vec_length(normal[i]);
    }
    for (int i = 0; i < 4 && fabs(forward - backward) < 1e-5 * forward; i++) {
        drop[face[i]] = back[i];
    }
}

/* The different triangles of pairs on the same places, lowest first; at most 5. */
static size_t faces_of(const pair *pairs, size_t n, uint32_t face[5]) {
    size_t faces = 0;
    for (size_t k = 0; k < 2 * n && faces < 5; k++) {
        uint32_t t = pairs[k / 2].triangle[k % 2];
        size_t at = 0;
        while (at < faces && face[at] < t) {
            at++;
        }
        if (at == faces || face[at] != t) {
            memmove(face + at + 1, face + at, (faces - at) * sizeof *face);
            face[at] = t;
            faces++;
        }
    }
    return faces;
}

pps_status pps_mesh_doubled_quads(const pps_mesh *mesh, bool *drop) {
    uint32_t *same = malloc((mesh->n_vertices + 1) * sizeof *same);
    side *sides = malloc((3 * mesh->n_triangles + 1) * sizeof *sides);
    pps_status status = same && sides ? pps_mesh_weld(mesh, same) : PPS_ERR_MEMORY;
    size_t n = status ? 0 : list_sides(mesh, same, drop, sides);
    size_t n_pairs = list_pairs(mesh, sides, n, NULL);
    pair *pairs = malloc((n_pairs + 1) * sizeof *pairs);
    if (pairs) {
        list_pairs(mesh, sides, n, pairs);
        qsort(pairs, n_pairs, sizeof *pairs, by_places);
    } else {
        status = PPS_ERR_MEMORY;
        n_pairs = 0;
    }
    for (size_t i = 0, next; i < n_pairs; i = next) {
        uint32_t face[6];
        for (next = i + 1; next < n_pairs && !by_places(&pairs[i], &pairs[next]);
             next++) {
        }
        if (faces_of(pairs + i, next - i, face) == 4) {
            drop_back(mesh, face, drop);
        }
    }
    free(same);
    free(sides);
    free(pairs);
    return status;
}
