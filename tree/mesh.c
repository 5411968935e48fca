/* Meshes: triangles grouped into leaves, and their measures.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/mesh.h>

#include "tree/alpha.h"
#include "tree/hull.h"
#include "tree/vec.h"
#include "tree/weld.h"

void pps_mesh_free(pps_mesh *mesh) {
    if (!mesh) {
        return;
    }
    for (size_t i = 0; mesh->material && i < mesh->n_materials; i++) {
        free(mesh->material[i].name);
    }
    for (size_t i = 0; mesh->texture && i < mesh->n_textures; i++) {
        free(mesh->texture[i].rgba);
    }
    free(mesh->position);
    free(mesh->uv);
    free(mesh->triangle);
    free(mesh->leaf_of);
    free(mesh->material_of);
    free(mesh->leaf);
    free(mesh->material);
    free(mesh->texture);
    free(mesh);
}

/* ---- connected pieces ---- */

/* The tree of a piece is found through its root; find halves the path on its way. */
static uint32_t find_root(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* The smaller number is the root, so a piece is named by its first triangle. */
static void join(uint32_t *parent, uint32_t a, uint32_t b) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

typedef struct {
    double at[3];
    uint32_t vertex;
} place;

static int compare_places(const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++) {
        if (a[i] != b[i]) {
            return a[i] < b[i] ? -1 : 1;
        }
    }
    return 0;
}

static int by_place(const void *a, const void *b) {
    const place *p = a, *q = b;
    int order = compare_places(p->at, q->at);
    return order ? order : (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

pps_status pps_mesh_weld(const pps_mesh *mesh, uint32_t *same) {
    place *places = malloc((mesh->n_vertices + 1) * sizeof *places);
    if (!places) {
        return PPS_ERR_MEMORY;
    }
    for (uint32_t v = 0; v < mesh->n_vertices; v++) {
        const double *p = mesh->position[v];
        places[v] = (place){{p[0] + 0.0, p[1] + 0.0, p[2] + 0.0}, v};
    }
    qsort(places, mesh->n_vertices, sizeof *places, by_place);
    for (size_t i = 0; i < mesh->n_vertices; i++) {
        bool fresh = i == 0 || compare_places(places[i].at, places[i - 1].at) != 0;
        same[places[i].vertex] = fresh ? places[i].vertex : same[places[i - 1].vertex];
    }
    free(places);
    return PPS_OK;
}

typedef struct {
    uint32_t low, high, triangle;
} edge;

static int by_edge(const void *a, const void *b) {
    const edge *p = a, *q = b;
    if (p->low != q->low) {
        return p->low < q->low ? -1 : 1;
    }
    if (p->high != q->high) {
        return p->high < q->high ? -1 : 1;
    }
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static bool is_leaf(const pps_mesh *mesh, size_t triangle) {
    return mesh->material[mesh->material_of[triangle]].leaf;
}

static void triangle_vector(const pps_mesh *mesh, size_t t, double center[3],
                            double twice_area[3]) {
    const double *a = mesh->position[mesh->triangle[t][0]];
    const double *b = mesh->position[mesh->triangle[t][1]];
    const double *c = mesh->position[mesh->triangle[t][2]];
    double ab[3], ac[3];
    vec_sub(b, a, ab);
    vec_sub(c, a, ac);
    vec_cross(ab, ac, twice_area);
    for (int i = 0; i < 3; i++) {
        center[i] = (a[i] + b[i] + c[i]) / 3;
    }
}

/* Of the triangles at an edge two join; where more meet (crossed cards, say) only those
 * that go on into each other, their planes within 30 degrees. */
static void join_at_edge(const pps_mesh *mesh, const edge *at, size_t n,
                         uint32_t *parent) {
    static const double COSINE = 0.8660254037844386;
    enum { MOST_AT_EDGE = 64 }; /* more are no leaves, and would take long */
    for (size_t i = 0; i < n && n <= MOST_AT_EDGE; i++) {
        for (size_t j = i + 1; j < n; j++) {
            double center[3], a[3], b[3];
            triangle_vector(mesh, at[i].triangle, center, a);
            triangle_vector(mesh, at[j].triangle, center, b);
            bool flat = fabs(vec_dot(a, b)) >= COSINE * vec_length(a) * vec_length(b);
            if (n == 2 || flat) {
                join(parent, at[i].triangle, at[j].triangle);
            }
        }
    }
}

/* Join the leaf triangles that share an edge; leaves that meet in a point stay apart. */
static pps_status connect(const pps_mesh *mesh, uint32_t *parent) {
    uint32_t *same = malloc((mesh->n_vertices + 1) * sizeof *same);
    edge *edges = malloc((3 * mesh->n_triangles + 1) * sizeof *edges);
    pps_status status = same && edges ? pps_mesh_weld(mesh, same) : PPS_ERR_MEMORY;
    size_t n = 0;
    for (uint32_t t = 0; !status && t < mesh->n_triangles; t++) {
        parent[t] = t;
        for (int i = 0; i < 3 && is_leaf(mesh, t); i++) {
            uint32_t a = same[mesh->triangle[t][i]];
            uint32_t b = same[mesh->triangle[t][(i + 1) % 3]];
            edges[n++] = (edge){a < b ? a : b, a < b ? b : a, t};
        }
    }
    if (!status) {
        qsort(edges, n, sizeof *edges, by_edge);
        for (size_t i = 0, next; i < n; i = next) {
            for (next = i + 1; next < n && edges[next].low == edges[i].low &&
                               edges[next].high == edges[i].high;
                 next++) {
            }
            join_at_edge(mesh, edges + i, next - i, parent);
        }
    }
    free(same);
    free(edges);
    return status;
}

/* ---- leaves ---- */

/* Center and normal weigh the whole triangles, so they are defined without any alpha. */
static void measure_leaf(const pps_mesh *mesh, const double *share, pps_leaf *leaf) {
    double whole = 0, sum[3] = {0}, normal[3] = {0}, area = 0;
    for (size_t t = leaf->first; t < leaf->first + leaf->n_triangles; t++) {
        double center[3], twice[3];
        triangle_vector(mesh, t, center, twice);
        double a = vec_length(twice) / 2;
        whole += a;
        area += a * share[t];
        vec_along(sum, a, center, sum);
        vec_along(normal, 1, twice, normal);
    }
    for (int i = 0; i < 3; i++) {
        leaf->center[i] = whole > 0 ? sum[i] / whole
                                    : mesh->position[mesh->triangle[leaf->first][0]][i];
    }
    vec_normalize(normal);
    memcpy(leaf->normal, normal, sizeof normal);
    leaf->area = area;
}

/* Sort key of a triangle: its piece, or after all leaves for wood. */
typedef struct {
    uint32_t piece, triangle;
} ranked;

static int by_rank(const void *a, const void *b) {
    const ranked *p = a, *q = b;
    if (p->piece != q->piece) {
        return p->piece < q->piece ? -1 : 1;
    }
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* parent becomes the order of pieces: pieces too large fall into their triangles. */
static void rank_triangles(const pps_mesh *mesh, uint32_t *parent, uint32_t *size,
                           ranked *rank) {
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        size[find_root(parent, t)]++;
    }
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t root = find_root(parent, t);
        bool single = size[root] > PPS_LEAF_TRIANGLES;
        rank[t].triangle = t;
        rank[t].piece = !is_leaf(mesh, t) ? PPS_NO_LEAF : single ? t : root;
    }
    qsort(rank, mesh->n_triangles, sizeof *rank, by_rank);
}

static pps_status sort_triangles(pps_mesh *mesh, const ranked *rank) {
    uint32_t(*triangle)[3] = malloc(mesh->n_triangles * sizeof *triangle);
    uint32_t *material = malloc(mesh->n_triangles * sizeof *material);
    if (!triangle || !material) {
        free(triangle);
        free(material);
        return PPS_ERR_MEMORY;
    }
    mesh->n_leaves = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        memcpy(triangle[t], mesh->triangle[rank[t].triangle], sizeof *triangle);
        material[t] = mesh->material_of[rank[t].triangle];
        bool leaf = rank[t].piece != PPS_NO_LEAF;
        mesh->n_leaves += leaf && (t == 0 || rank[t].piece != rank[t - 1].piece);
        mesh->leaf_of[t] = leaf ? (uint32_t)mesh->n_leaves - 1 : PPS_NO_LEAF;
    }
    free(mesh->triangle);
    free(mesh->material_of);
    mesh->triangle = triangle;
    mesh->material_of = material;
    return PPS_OK;
}

static pps_status collect_leaves(pps_mesh *mesh) {
    mesh->leaf = calloc(mesh->n_leaves + 1, sizeof *mesh->leaf);
    double *share = malloc(mesh->n_triangles * sizeof *share);
    pps_status status =
        mesh->leaf && share ? pps_alpha_coverage(mesh, share) : PPS_ERR_MEMORY;
    if (status) {
        free(share);
        return status;
    }
    for (uint32_t t = 0; t < mesh->n_triangles; t++) {
        if (mesh->leaf_of[t] != PPS_NO_LEAF) {
            pps_leaf *leaf = &mesh->leaf[mesh->leaf_of[t]];
            leaf->first = leaf->n_triangles++ ? leaf->first : t;
            leaf->material = mesh->material_of[t];
        }
    }
    for (size_t i = 0; i < mesh->n_leaves; i++) {
        measure_leaf(mesh, share, &mesh->leaf[i]);
    }
    free(share);
    return PPS_OK;
}

static bool indices_hold(const pps_mesh *mesh) {
    if (mesh->n_triangles == 0 || mesh->n_triangles >= PPS_NO_LEAF ||
        mesh->n_vertices >= PPS_NO_LEAF) {
        return false;
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int i = 0; i < 3; i++) {
            if (mesh->triangle[t][i] >= mesh->n_vertices) {
                return false;
            }
        }
        if (mesh->material_of[t] >= mesh->n_materials) {
            return false;
        }
    }
    return true;
}

pps_status pps_mesh_finish(pps_mesh *mesh) {
    if (!mesh || !indices_hold(mesh)) {
        return PPS_ERR_ARGUMENT;
    }
    size_t n = mesh->n_triangles;
    uint32_t *parent = calloc(n, sizeof *parent), *size = calloc(n, sizeof *size);
    ranked *rank = malloc(n * sizeof *rank);
    free(mesh->leaf_of);
    free(mesh->leaf);
    mesh->leaf = NULL;
    mesh->leaf_of = malloc(n * sizeof *mesh->leaf_of);
    pps_status status = parent && size && rank && mesh->leaf_of ? connect(mesh, parent)
                                                                : PPS_ERR_MEMORY;
    if (!status) {
        rank_triangles(mesh, parent, size, rank);
        status = sort_triangles(mesh, rank);
    }
    free(parent);
    free(size);
    free(rank);
    return status ? status : collect_leaves(mesh);
}

/* ---- measures ---- */

static void grow_box(double low[3], double high[3], const double p[3]) {
    for (int i = 0; i < 3; i++) {
        low[i] = fmin(low[i], p[i]);
        high[i] = fmax(high[i], p[i]);
    }
}

void pps_mesh_measure(const pps_mesh *mesh, pps_mesh_size *size) {
    *size = (pps_mesh_size){.radius = 0};
    for (int i = 0; i < 3; i++) {
        size->low[i] = size->leaf_low[i] = INFINITY;
        size->high[i] = size->leaf_high[i] = -INFINITY;
    }
    double(*point)[2] = malloc((3 * mesh->n_triangles + 1) * sizeof *point);
    size_t n = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int i = 0; i < 3; i++) {
            const double *p = mesh->position[mesh->triangle[t][i]];
            grow_box(size->low, size->high, p);
            if (mesh->leaf_of[t] != PPS_NO_LEAF) {
                grow_box(size->leaf_low, size->leaf_high, p);
                if (point) {
                    memcpy(point[n++], p, sizeof *point);
                }
            }
        }
    }
    for (size_t i = 0; i < mesh->n_leaves; i++) {
        size->leaf_area += mesh->leaf[i].area;
    }
    for (int i = 0; i < 3 && mesh->n_leaves; i++) {
        size->center[i] = (size->leaf_low[i] + size->leaf_high[i]) / 2;
        size->radius += i < 2 ? (size->leaf_high[i] - size->leaf_low[i]) / 4 : 0;
    }
    double area = pps_hull_area(n, point);
    size->leaf_area_index = area > 0 ? size->leaf_area / area : 0;
    free(point);
}
