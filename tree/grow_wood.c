/* Wood: every branch is a tube that tapers from ring to ring and ends in a point. A branch
 * begins inside the one it grows from, so the surface has no holes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/grow_wood.h"

#include <math.h>
#include <stdlib.h>

#include "tree/random.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

enum { LEAST_SIDES = 3, BUTTRESS = 21 << 8 };

typedef struct {
    uint32_t first; /* of sides + 1 vertices: the seam is there twice */
    int sides;
} ring;

/* Thin twigs have three sides, the trunk as many as the species asks for; in between they
 * go with the root of the radius, so that edges stay about as sharp to the eye. */
static int sides_of(const pps_species *s, double radius) {
    double low = s->wood.twig_radius, high = s->wood.trunk_radius;
    double share = sqrt(fmax(0, (radius - 2 * low) / fmax(1e-12, high - 2 * low)));
    int sides = LEAST_SIDES + (int)(share * (s->wood.sides - LEAST_SIDES) + 0.5);
    return sides < (int)s->wood.sides ? sides : (int)s->wood.sides;
}

/* Wider at the foot, in buttresses towards the roots. */
static double flare(const pps_species *s, double phase, double z, double angle) {
    double share = s->wood.flare * exp(-fmax(0, z) / s->wood.flare_height);
    return 1 +
           share * (1 + 0.35 * cos(5 * angle + phase) + 0.2 * cos(3 * angle - phase));
}

typedef struct {
    const pps_species *species;
    double phase;       /* of the buttresses */
    double x[3], along; /* the frame carried along the branch; length so far */
    bool foot;          /* a branch that starts in the ground */
} tube;

static ring add_ring(tube *t, const double at[3], const double way[3], double radius,
                     pps_builder *b) {
    double y[3];
    vec_along(t->x, -vec_dot(t->x, way), way, t->x); /* the least turn to the new way */
    vec_normalize(t->x);
    vec_cross(way, t->x, y);
    ring r = {(uint32_t)b->mesh->n_vertices, sides_of(t->species, radius)};
    for (int i = 0; i <= r.sides; i++) {
        double angle = 2 * PI * (i % r.sides) / r.sides, p[3];
        double wide =
            radius * (t->foot ? flare(t->species, t->phase, at[2], angle) : 1);
        vec_along(at, wide * cos(angle), t->x, p);
        vec_along(p, wide * sin(angle), y, p);
        pps_build_vertex(b, p, (double)i / r.sides, t->along);
    }
    return r;
}

/* Triangles between two rings, whatever their sides: always on along the ring that is
 * behind. */
static void join_rings(ring low, ring high, uint32_t material, pps_builder *b) {
    for (int i = 0, k = 0; i < low.sides || k < high.sides;) {
        uint32_t p = low.first + (uint32_t)i, q = high.first + (uint32_t)k;
        if ((i + 1) * high.sides <= (k + 1) * low.sides) {
            pps_build_triangle(b, p, p + 1, q, material);
            i++;
        } else {
            pps_build_triangle(b, p, q + 1, q, material);
            k++;
        }
    }
}

static void close_ring(ring last, const double tip[3], double along, uint32_t material,
                       pps_builder *b) {
    for (int i = 0; i < last.sides; i++) {
        uint32_t point = pps_build_vertex(b, tip, (i + 0.5) / last.sides, along);
        uint32_t p = last.first + (uint32_t)i;
        pps_build_triangle(b, p, p + 1, point, material);
    }
}

/* The direction of the branch at node k: between those in and out. */
static void way_at(const pps_skeleton *s, uint32_t from, uint32_t k, double out[3]) {
    const pps_node *node = &s->node[k];
    double in[3] = {0, 0, 0}, on[3] = {0, 0, 0};
    if (from != PPS_NO_NODE) {
        vec_sub(node->at, s->node[from].at, in);
        vec_normalize(in);
    }
    if (node->main_child != PPS_NO_NODE) {
        vec_sub(s->node[node->main_child].at, node->at, on);
        vec_normalize(on);
    }
    vec_along(in, 1, on, out);
    vec_normalize(out);
}

/* Rings near the ground lie level, or a leaning stem's would reach below it. */
static void level_near_ground(const pps_species *s, double z, double way[3]) {
    static const double up[3] = {0, 0, 1};
    double free = fmin(1, fmax(0, z) / (4 * s->wood.flare_height));
    for (int i = 0; i < 3; i++) {
        way[i] = free * way[i] + (1 - free) * up[i];
    }
    vec_normalize(way);
}

/* The branch that starts with node k, out of its parent or out of the ground. */
static void add_branch(const pps_species *species, double phase, const pps_skeleton *s,
                       uint32_t k, uint32_t material, pps_builder *b) {
    tube t = {species, phase, {1, 0, 0}, 0, s->node[k].parent == PPS_NO_NODE};
    uint32_t from = s->node[k].parent;
    double way[3] = {0, 0, 1}, y[3];
    ring last;
    if (t.foot) {
        last = add_ring(&t, s->node[k].at, way, s->node[k].radius, b);
    } else { /* its first ring is hidden in the wood it comes from */
        vec_sub(s->node[k].at, s->node[from].at, way);
        vec_normalize(way);
        vec_frame(way, t.x, y);
        last = add_ring(&t, s->node[from].at, way, s->node[k].radius, b);
    }
    for (uint32_t at = t.foot ? s->node[k].main_child : k; at != PPS_NO_NODE;
         from = at, at = s->node[at].main_child) {
        uint32_t before = from == PPS_NO_NODE ? k : from;
        const pps_node *node = &s->node[at];
        double step[3];
        vec_sub(node->at, s->node[before].at, step);
        t.along += vec_length(step);
        if (node->main_child == PPS_NO_NODE) {
            close_ring(last, node->at, t.along, material, b);
        } else {
            way_at(s, before, at, way);
            if (t.foot) {
                level_near_ground(species, node->at[2], way);
            }
            ring next = add_ring(&t, node->at, way, node->radius, b);
            join_rings(last, next, material, b);
            last = next;
        }
    }
}

void pps_wood_build(const pps_species *species, uint64_t seed,
                    const pps_skeleton *skeleton, uint32_t material, pps_builder *b) {
    for (uint32_t k = 0; k < skeleton->n; k++) {
        uint32_t parent = skeleton->node[k].parent;
        bool begins = parent == PPS_NO_NODE || skeleton->node[parent].main_child != k;
        if (begins) {
            double phase =
                2 * PI * pps_random(seed, PPS_RANDOM_SPECIES, k, BUTTRESS).u[0];
            add_branch(species, phase, skeleton, k, material, b);
        }
    }
}
