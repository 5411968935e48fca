/* Building the octree: leaves in Morton order, nodes as runs of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/octree.h"

#include <math.h>
#include <stdlib.h>

#include "tree/vec.h"

enum { BITS = 21 }; /* of a Morton code, an axis */

typedef struct {
    uint64_t code;
    uint32_t leaf;
} coded;

/* Bits of x apart, two zeros between each. */
static uint64_t spread(uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

static int by_code(const void *a, const void *b) {
    const coded *p = a, *q = b;
    if (p->code != q->code) {
        return p->code < q->code ? -1 : 1;
    }
    return (p->leaf > q->leaf) - (p->leaf < q->leaf);
}

static void code_leaves(const pps_scene_leaf *leaf, size_t n, coded *order) {
    double low[3], high[3], side = 0;
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            low[k] = fmin(low[k], leaf[i].center[k]);
            high[k] = fmax(high[k], leaf[i].center[k]);
        }
        side = fmax(side, high[k] - low[k]);
    }
    for (size_t i = 0; i < n; i++) {
        order[i] = (coded){0, (uint32_t)i};
        for (int k = 0; k < 3 && side > 0; k++) {
            double share = (leaf[i].center[k] - low[k]) / side;
            order[i].code |= spread((uint64_t)(share * ((1 << BITS) - 1))) << k;
        }
    }
    qsort(order, n, sizeof *order, by_code);
}

/* What the recursion carries. */
typedef struct {
    pps_octree *tree;
    const coded *order;
    const pps_scene_leaf *leaf;
} builder;

/* The leaves of a bucket into their slots. */
static void fill_bucket(builder *b, pps_octree_node *node, size_t begin, size_t end) {
    pps_octree *tree = b->tree;
    node->first = (uint32_t)tree->n_slots;
    node->n = (uint32_t)(end - begin);
    tree->n_slots += (end - begin + PPS_BUCKET - 1) / PPS_BUCKET * PPS_BUCKET;
    for (size_t s = node->first; s < tree->n_slots; s++) {
        bool real = s < node->first + (end - begin);
        const pps_scene_leaf *leaf =
            &b->leaf[b->order[real ? begin + s - node->first : begin].leaf];
        for (int k = 0; k < 3; k++) {
            tree->center[k][s] = (float)leaf->center[k];
            tree->normal[k][s] = (float)leaf->normal[k];
        }
        tree->area[s] = real ? (float)leaf->area : 0;
        tree->leaf[s] = real ? b->order[begin + s - node->first].leaf : UINT32_MAX;
    }
}

static void sum_node(const builder *b, pps_octree_node *node, size_t begin,
                     size_t end) {
    double area = 0, center[3] = {0}, plain[3] = {0}, q[6] = {0}, reach = 0;
    for (int k = 0; k < 3; k++) {
        node->low[k] = INFINITY;
        node->high[k] = -INFINITY;
    }
    for (size_t i = begin; i < end; i++) {
        const pps_scene_leaf *leaf = &b->leaf[b->order[i].leaf];
        const double *n = leaf->normal, a = leaf->area;
        area += a;
        for (int k = 0; k < 3; k++) {
            center[k] += a * leaf->center[k];
            plain[k] += leaf->center[k] / (double)(end - begin);
            q[k] += a * (3 + 15 * n[k] * n[k]) / 16;
            node->low[k] = fminf(node->low[k], (float)leaf->center[k]);
            node->high[k] = fmaxf(node->high[k], (float)leaf->center[k]);
        }
        q[3] += a * 15 * n[0] * n[1] / 16;
        q[4] += a * 15 * n[0] * n[2] / 16;
        q[5] += a * 15 * n[1] * n[2] / 16;
    }
    for (int k = 0; k < 3; k++) {
        center[k] = area > 0 ? center[k] / area : plain[k];
        node->center[k] = (float)center[k];
    }
    for (int k = 0; k < 6; k++) {
        node->q[k] = (float)q[k];
    }
    for (size_t i = begin; i < end; i++) {
        const pps_scene_leaf *leaf = &b->leaf[b->order[i].leaf];
        double d[3];
        vec_sub(leaf->center, center, d);
        reach = fmax(reach, vec_length(d) + sqrt(leaf->area / 2)); /* of a square */
    }
    node->radius = (float)reach;
}

/* The end of the run in begin..end whose three bits at `shift` are those of begin. */
static size_t octant_end(const coded *order, size_t begin, size_t end, int shift) {
    size_t i = begin;
    while (i < end && order[i].code >> shift == order[begin].code >> shift) {
        i++;
    }
    return i;
}

/* Node `at` over begin..end, which share their code above `level` bits an axis. */
static void build(builder *b, size_t at, size_t begin, size_t end, int level) {
    pps_octree *tree = b->tree;
    sum_node(b, &tree->node[at], begin, end);
    if (end - begin <= PPS_BUCKET || level == 0) {
        fill_bucket(b, &tree->node[at], begin, end);
        return;
    }
    size_t cut[9], n = 0;
    for (cut[0] = begin; cut[n] < end; n++) {
        cut[n + 1] = octant_end(b->order, cut[n], end, 3 * (level - 1));
    }
    if (n == 1) { /* all in one octant: look closer without a node for it */
        build(b, at, begin, end, level - 1);
        return;
    }
    size_t child = tree->n_nodes;
    tree->n_nodes += n;
    tree->node[at].child = (uint32_t)child;
    tree->node[at].n_children = (uint32_t)n;
    for (size_t i = 0; i < n; i++) {
        build(b, child + i, cut[i], cut[i + 1], level - 1);
    }
}

void pps_octree_free(pps_octree *tree) {
    if (tree) {
        free(tree->node);
        free(tree->area);
        free(tree->leaf);
        free(tree);
    }
}

/* Room for the most there can be: every inner node has two children or more, and every
 * bucket but those of coincident leaves holds one leaf or more. */
static pps_octree *allocate(size_t n) {
    pps_octree *tree = calloc(1, sizeof *tree);
    size_t slots = PPS_BUCKET * n;
    if (!tree) {
        return NULL;
    }
    tree->node = calloc(2 * n, sizeof *tree->node);
    tree->area = malloc(7 * slots * sizeof *tree->area);
    tree->leaf = malloc(slots * sizeof *tree->leaf);
    if (!tree->node || !tree->area || !tree->leaf) {
        pps_octree_free(tree);
        return NULL;
    }
    for (int k = 0; k < 3; k++) {
        tree->center[k] = tree->area + (size_t)(k + 1) * slots;
        tree->normal[k] = tree->area + (size_t)(k + 4) * slots;
    }
    return tree;
}

pps_status pps_octree_create(const pps_scene *scene, pps_octree **out) {
    size_t n = scene->n_leaves;
    *out = NULL;
    if (n == 0 || n >= UINT32_MAX / PPS_BUCKET) {
        return PPS_ERR_ARGUMENT;
    }
    coded *order = malloc(n * sizeof *order);
    pps_scene_leaf *leaf = malloc(n * sizeof *leaf);
    pps_octree *tree = allocate(n);
    if (order && leaf && tree) {
        for (size_t i = 0; i < n; i++) {
            pps_scene_leaf_at(scene, i, &leaf[i]);
        }
        code_leaves(leaf, n, order);
        builder b = {tree, order, leaf};
        tree->n_nodes = 1;
        build(&b, 0, 0, n, BITS);
        *out = tree;
    } else {
        pps_octree_free(tree);
    }
    free(order);
    free(leaf);
    return *out ? PPS_OK : PPS_ERR_MEMORY;
}
