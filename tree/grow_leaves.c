/* Leaves: sites along the twigs, a frame at each, and one size for all that gives the
 * leaf-area index asked for.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/grow_leaves.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/hull.h"
#include "tree/random.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double DEGREE = 3.14159265358979323846 / 180;

static const double TIP_WEIGHT = 2;

/* Events of the leaves' random numbers; the skeleton's items are above 2^40. */
enum { SITE = 1 << 8, FRAME = 2 << 8, TILT = 3 << 8 };

/* A leaf's base and axes: x across, y along the blade, n its normal; size relative. */
typedef struct {
    double base[3], x[3], y[3], n[3], size;
} blade;

size_t pps_leaf_triangles(const pps_species *species) {
    return (size_t)species->leaves.whorl * (species->leaves.n_outline - 1);
}

/* ---- shape ---- */

/* Point i of petal k, of a leaf of length 1: turned about the normal, lifted by the cup,
 * its end bent down by the curl. */
static void shape_point(const pps_species *s, int k, size_t i, double out[3]) {
    const double *at = s->leaves.outline[i];
    double turn = 2 * PI * k / s->leaves.whorl, cup = s->leaves.cup * DEGREE;
    double reach = at[1] * cos(cup);
    out[0] = at[0] * cos(turn) - reach * sin(turn);
    out[1] = at[0] * sin(turn) + reach * cos(turn);
    double far = at[0] * at[0] + at[1] * at[1];
    out[2] = at[1] * sin(cup) - s->leaves.curl * far / 2;
}

static void place(const blade *leaf, double size, const double own[3], double out[3]) {
    vec_along(leaf->base, size * leaf->size * own[0], leaf->x, out);
    vec_along(out, size * leaf->size * own[1], leaf->y, out);
    vec_along(out, size * leaf->size * own[2], leaf->n, out);
}

/* ---- sites ---- */

/* How much of the wood up to each node bears leaves, metres; the last stretch of a twig
 * bears more of them. */
static double *leafy_lengths(const pps_species *s, const pps_skeleton *skeleton) {
    double *sum = malloc((skeleton->n + 1) * sizeof *sum), total = 0;
    for (size_t k = 0; sum && k < skeleton->n; k++) {
        const pps_node *node = &skeleton->node[k];
        if (node->parent != PPS_NO_NODE && node->radius < s->leaves.wood_below) {
            double along[3];
            vec_sub(node->at, skeleton->node[node->parent].at, along);
            total += (node->n_children == 0 ? TIP_WEIGHT : 1) * vec_length(along);
        }
        sum[k] = total;
    }
    return sum;
}

/* The first node whose sum is above `at`. */
static size_t node_at(const double *sum, size_t n, double at) {
    size_t low = 0, high = n - 1;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (sum[middle] > at) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

typedef struct {
    double at[3], along[3], radius;
} site;

/* Site i of n: one in each nth of the leafy length, anywhere in it. */
static site pick_site(uint64_t seed, const pps_skeleton *skeleton, const double *sum,
                      size_t i, size_t n) {
    double u = pps_random(seed, PPS_RANDOM_SPECIES, i, SITE).u[0];
    double where = ((double)i + u) / (double)n * sum[skeleton->n - 1];
    size_t k = node_at(sum, skeleton->n, where);
    const pps_node *node = &skeleton->node[k];
    site s = {.radius = node->radius};
    vec_sub(node->at, skeleton->node[node->parent].at, s.along);
    double back = (sum[k] - where) / (sum[k] - (k ? sum[k - 1] : 0));
    vec_along(node->at, -back, s.along, s.at);
    vec_normalize(s.along);
    return s;
}

/* Across the twig and level, or any way across a twig that stands upright. */
static void level_across(const double along[3], double out[3]) {
    double up[3] = {0, 0, 1}, y[3];
    vec_cross(along, up, out);
    if (vec_dot(out, out) < 1e-4) {
        vec_frame(along, out, y);
    }
    vec_normalize(out);
}

/* Turned by random angles, a Gaussian each, standard deviation in degrees. */
static void tilt(const pps_uniforms *r, double deviation, double n[3]) {
    double x[3], y[3],
        size = tan(fmin(80, deviation) * DEGREE) * sqrt(-2 * log(r->u[0]));
    vec_frame(n, x, y);
    vec_along(n, size * cos(2 * PI * r->u[1]), x, n);
    vec_along(n, size * sin(2 * PI * r->u[1]), y, n);
    vec_normalize(n);
}

/* Leaf k of a cluster at a site: it stands away from the twig on its stalk, faces between
 * outwards and up, and points away from the twig. */
static blade pick_blade(const pps_species *s, uint64_t seed, const site *at,
                        uint64_t cluster, uint64_t k) {
    uint64_t item = cluster * 128 + k;
    pps_uniforms r = pps_random(seed, PPS_RANDOM_SPECIES, item, FRAME);
    pps_uniforms q = pps_random(seed, PPS_RANDOM_SPECIES, item, TILT);
    pps_uniforms c = pps_random(seed, PPS_RANDOM_SPECIES, cluster, SITE + 1);
    double side[3], third[3], out[3];
    level_across(at->along, side);
    vec_cross(at->along, side, third);
    double around = s->leaves.divergence * DEGREE * (double)k +
                    s->leaves.phase * DEGREE * (2 * c.u[0] - 1);
    double forward =
        s->leaves.forward[0] + r.u[0] * (s->leaves.forward[1] - s->leaves.forward[0]);
    double across = cos(forward * DEGREE);
    for (int i = 0; i < 3; i++) {
        out[i] = sin(forward * DEGREE) * at->along[i] +
                 across * (cos(around) * side[i] + sin(around) * third[i]);
    }
    double stalk =
        s->leaves.stalk[0] + r.u[1] * (s->leaves.stalk[1] - s->leaves.stalk[0]);
    blade leaf = {.size = 1 + s->leaves.size_spread * (r.u[2] - 0.5)};
    vec_along(at->at, at->radius + stalk, out, leaf.base);
    for (int i = 0; i < 3; i++) {
        leaf.n[i] = (1 - s->leaves.upright) * out[i];
    }
    leaf.n[2] += s->leaves.upright;
    vec_normalize(leaf.n);
    tilt(&q, s->leaves.jitter, leaf.n);
    double turn = 2 * PI * r.u[3];
    vec_along(out, 0.05 * cos(turn), side, out); /* also where out is the normal */
    vec_along(out, 0.05 * sin(turn), third, out);
    vec_along(out, -vec_dot(out, leaf.n), leaf.n, leaf.y);
    vec_normalize(leaf.y);
    double down = s->leaves.pitch * DEGREE, level[3], normal[3];
    for (int i = 0; i < 3; i++) {
        level[i] = cos(down) * leaf.y[i] - sin(down) * leaf.n[i];
        normal[i] = cos(down) * leaf.n[i] + sin(down) * leaf.y[i];
    }
    memcpy(leaf.y, level, sizeof level);
    memcpy(leaf.n, normal, sizeof normal);
    vec_cross(leaf.y, leaf.n, leaf.x);
    return leaf;
}

static pps_status pick_blades(const pps_species *s, uint64_t seed,
                              const pps_skeleton *skeleton, size_t n, blade *leaf) {
    double *sum = leafy_lengths(s, skeleton);
    if (!sum) {
        return PPS_ERR_MEMORY;
    }
    size_t cluster = (size_t)s->leaves.cluster, clusters = (n + cluster - 1) / cluster;
    bool bare = skeleton->n == 0 || !(sum[skeleton->n - 1] > 0);
    for (size_t i = 0; i < n && !bare; i++) {
        site at = pick_site(seed, skeleton, sum, i / cluster, clusters);
        leaf[i] = pick_blade(s, seed, &at, i / cluster, i % cluster);
    }
    free(sum);
    return bare ? PPS_ERR_ARGUMENT : PPS_OK;
}

/* ---- size ---- */

/* The area of all leaves when a leaf of relative size 1 has length 1. */
static double unit_area(const pps_species *s, const blade *leaf, size_t n) {
    double area = 0, squares = 0;
    for (size_t i = 0; i + 1 < s->leaves.n_outline; i++) {
        double a[3], b[3], c[3];
        shape_point(s, 0, i, a);
        shape_point(s, 0, i + 1, b);
        vec_cross(a, b, c);
        area += vec_length(c) / 2;
    }
    for (size_t i = 0; i < n; i++) {
        squares += leaf[i].size * leaf[i].size;
    }
    return s->leaves.whorl * area * squares;
}

/* The hull of the leaves from above, when they have a size; point has room for them. */
static double hull_of(const pps_species *s, const blade *leaf, size_t n, double size,
                      double (*point)[2]) {
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        memcpy(point[m++], leaf[i].base, sizeof *point);
        for (int k = 0; k < (int)s->leaves.whorl; k++) {
            for (size_t p = 0; p < s->leaves.n_outline; p++) {
                double own[3], at[3];
                shape_point(s, k, p, own);
                place(&leaf[i], size, own, at);
                memcpy(point[m++], at, sizeof *point);
            }
        }
    }
    return pps_hull_area(m, point);
}

/* size = sqrt(index hull(size)/unit area), by iteration: the hull is that of the crown
 * and hardly knows how large a leaf is, so each round gains a digit or more. */
static pps_status solve_size(const pps_species *s, const blade *leaf, size_t n,
                             double *size) {
    enum { ROUNDS = 5 };
    size_t per_leaf = 1 + (size_t)s->leaves.whorl * s->leaves.n_outline;
    double(*point)[2] = malloc((n * per_leaf + 1) * sizeof *point);
    if (!point) {
        return PPS_ERR_MEMORY;
    }
    double area = unit_area(s, leaf, n);
    *size = 0.05;
    for (int round = 0; round < ROUNDS; round++) {
        *size = sqrt(s->leaf_area_index * hull_of(s, leaf, n, *size, point) / area);
    }
    free(point);
    return PPS_OK;
}

/* ---- triangles ---- */

static void add_leaf(const pps_species *s, const blade *leaf, double size,
                     uint32_t material, pps_builder *b) {
    uint32_t base = pps_build_vertex(b, leaf->base, 0.5, 0);
    double wide = 0;
    for (size_t i = 0; i < s->leaves.n_outline; i++) {
        wide = fmax(wide, fabs(s->leaves.outline[i][0]));
    }
    for (int k = 0; k < (int)s->leaves.whorl; k++) {
        uint32_t before = 0;
        for (size_t i = 0; i < s->leaves.n_outline; i++) {
            double own[3], at[3];
            shape_point(s, k, i, own);
            place(leaf, size, own, at);
            uint32_t now =
                pps_build_vertex(b, at, 0.5 + 0.5 * s->leaves.outline[i][0] / wide,
                                 s->leaves.outline[i][1]);
            if (i > 0) {
                pps_build_triangle(b, base, before, now, material);
            }
            before = now;
        }
    }
}

pps_status pps_leaves_build(const pps_species *species, uint64_t seed,
                            const pps_skeleton *skeleton, size_t n, uint32_t material,
                            pps_builder *b) {
    blade *leaf = malloc((n + 1) * sizeof *leaf);
    double size = 0;
    pps_status status =
        leaf ? pick_blades(species, seed, skeleton, n, leaf) : PPS_ERR_MEMORY;
    status = status ? status : solve_size(species, leaf, n, &size);
    for (size_t i = 0; i < n && !status; i++) {
        add_leaf(species, &leaf[i], size, material, b);
    }
    free(leaf);
    return status ? status : b->failed ? PPS_ERR_MEMORY : PPS_OK;
}
