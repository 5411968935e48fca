/* Branching by space colonisation: points in the space of the crown pull the nearest wood
 * towards them, and are gone once it is near.
 *
 * Reference: RLP07 (Runions, Lane and Prusinkiewicz 2007). The stems up to the crown are
 * given; the pull reaches /growth/reach; radii follow the pipe model.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/skeleton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/skeleton_parts.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double DEGREE = 3.14159265358979323846 / 180;

static pps_status add_node(pps_skeleton *s, uint32_t parent, const double at[3]) {
    if (s->n == PPS_MOST_NODES) {
        return PPS_ERR_ARGUMENT;
    }
    if (s->n == s->room) {
        size_t room = s->room ? 2 * s->room : 1024;
        pps_node *node = realloc(s->node, room * sizeof *node);
        if (!node) {
            return PPS_ERR_MEMORY;
        }
        s->node = node;
        s->room = room;
    }
    pps_node *node = &s->node[s->n++];
    *node =
        (pps_node){{at[0], at[1], at[2]}, 0, parent, PPS_NO_NODE, PPS_NO_NODE, 0, 0};
    pps_grow_snap(node->at);
    if (parent != PPS_NO_NODE) { /* while it grows, main_child is the last one */
        node->sibling = s->node[parent].main_child;
        s->node[parent].main_child = (uint32_t)s->n - 1;
    }
    return PPS_OK;
}

/* ---- stems ---- */

/* One stem: from its foot up to /stems/height, leaning outwards, in a slow S. */
static pps_status add_stem(const pps_species *species, uint64_t seed, int i,
                           pps_skeleton *s) {
    pps_uniforms r = pps_grow_random(seed, PPS_GROW_STEM, (uint64_t)i, 0);
    pps_uniforms q = pps_grow_random(seed, PPS_GROW_STEM, (uint64_t)i, 1);
    double azimuth = 2 * PI * (i + 0.6 * (r.u[0] - 0.5)) / species->stems.count;
    azimuth += 2 * PI * pps_grow_random(seed, PPS_GROW_STEM, UINT32_MAX, 0).u[0];
    double lean = species->stems.lean * DEGREE * (0.6 + 0.8 * r.u[1]);
    double out[3] = {cos(azimuth), sin(azimuth), 0}, side[3] = {-out[1], out[0], 0};
    double foot = species->stems.count > 1 ? species->stems.spread : 0;
    double height = species->stems.height * (0.85 + 0.3 * r.u[2]);
    int steps = (int)ceil(height / (0.6 * species->growth.step));
    pps_status status = PPS_OK;
    for (int k = 0; k <= steps && !status; k++) {
        double t = (double)k / steps, z = t * height;
        double bend = species->stems.wander * height * t;
        double p[3] = {0, 0, z};
        vec_along(p, foot + z * tan(lean) * (0.5 + 0.5 * t), out, p);
        vec_along(p,
                  0.35 * bend * sin(2 * PI * (0.7 * t + q.u[0])) -
                      0.35 * bend * sin(2 * PI * q.u[0]),
                  side, p);
        vec_along(
            p, 0.25 * bend * (sin(2 * PI * (0.9 * t + q.u[1])) - sin(2 * PI * q.u[1])),
            out, p);
        status = add_node(s, k ? (uint32_t)s->n - 1 : PPS_NO_NODE, p);
    }
    return status;
}

/* The limbs that a stem forks into at its top: evenly about it, leaning out, rising again
 * towards their ends. */
static pps_status add_forks(const pps_species *species, uint64_t seed, int stem,
                            pps_skeleton *s) {
    uint32_t top = (uint32_t)s->n - 1;
    int n = (int)species->stems.forks;
    double start =
        2 * PI * pps_grow_random(seed, PPS_GROW_FORK, UINT32_MAX, (uint64_t)stem).u[0];
    for (int i = 0; i < n; i++) {
        pps_uniforms r =
            pps_grow_random(seed, PPS_GROW_FORK, (uint64_t)i, (uint64_t)stem);
        double azimuth = start + 2 * PI * (i + 0.5 * (r.u[0] - 0.5)) / n;
        double lean = species->stems.fork_lean * DEGREE * (0.7 + 0.6 * r.u[1]);
        double length = species->stems.fork_length * (0.75 + 0.5 * r.u[2]);
        /* The second in a stem starts a little lower: real forks are not in one place. */
        uint32_t parent = top - (uint32_t)(i % 3 && top > 3 ? i % 3 : 0);
        double at[3];
        memcpy(at, s->node[parent].at, sizeof at);
        int steps = (int)ceil(length / (0.6 * species->growth.step));
        for (int k = 0; k < steps; k++) {
            double t = (double)k / steps, now = lean * (1.1 - 0.35 * t);
            double turn = azimuth + species->stems.wander * sin(2 * PI * (t + r.u[3]));
            double way[3] = {sin(now) * cos(turn), sin(now) * sin(turn), cos(now)};
            vec_along(at, length / steps, way, at);
            pps_status status = add_node(s, parent, at);
            if (status) {
                return status;
            }
            parent = (uint32_t)s->n - 1;
        }
    }
    return PPS_OK;
}

/* ---- colonisation ---- */

typedef struct {
    double at[3], distance; /* to the nearest node, squared */
    uint32_t nearest;
    bool alive;
} attractor;

/* A new node may be nearer to some points than what they had. */
static void meet(attractor *point, size_t n_points, const pps_skeleton *s,
                 size_t first) {
    for (size_t i = 0; i < n_points; i++) {
        for (size_t k = first; k < s->n && point[i].alive; k++) {
            double to[3];
            vec_sub(point[i].at, s->node[k].at, to);
            double distance = vec_dot(to, to);
            if (distance < point[i].distance) {
                point[i].distance = distance;
                point[i].nearest = (uint32_t)k;
            }
        }
    }
}

/* The mean direction that the points within reach pull each node in. */
static void pull(const pps_species *species, const attractor *point, size_t n_points,
                 const pps_skeleton *s, double (*way)[3]) {
    double reach = species->growth.reach * species->growth.reach;
    memset(way, 0, s->n * sizeof *way);
    for (size_t i = 0; i < n_points; i++) {
        if (point[i].alive && point[i].distance < reach) {
            double to[3];
            vec_sub(point[i].at, s->node[point[i].nearest].at, to);
            vec_normalize(to);
            vec_along(way[point[i].nearest], 1, to, way[point[i].nearest]);
        }
    }
}

/* Whether a new node would stand where its parent already has a child: points that pull
 * evenly from two sides would else grow the same twig again and again. */
static bool taken(const pps_skeleton *s, uint32_t parent, const double at[3],
                  double step) {
    for (uint32_t k = s->node[parent].main_child; k != PPS_NO_NODE;
         k = s->node[k].sibling) {
        double to[3];
        vec_sub(at, s->node[k].at, to);
        if (vec_dot(to, to) < 0.01 * step * step) {
            return true;
        }
    }
    return false;
}

/* One round: every node that is pulled puts out a child. */
static pps_status sprout(const pps_species *species, uint64_t seed, pps_skeleton *s,
                         double (*way)[3], attractor *point, size_t n_points) {
    size_t before = s->n;
    double step = species->growth.step;
    for (uint32_t k = 0; k < before; k++) {
        double *to = way[k], at[3];
        if (vec_dot(to, to) == 0) {
            continue;
        }
        vec_normalize(to);
        pps_uniforms r = pps_grow_random(seed, PPS_GROW_WANDER, s->n, 0);
        for (int i = 0; i < 3; i++) {
            to[i] += species->growth.wander * (2 * r.u[i] - 1);
        }
        to[2] += species->growth.rise;
        vec_normalize(to);
        vec_along(s->node[k].at, step, to, at);
        if (taken(s, k, at, step)) {
            for (size_t i = 0; i < n_points; i++) {
                point[i].alive = point[i].alive && point[i].nearest != k;
            }
            continue;
        }
        pps_status status = add_node(s, k, at);
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

static pps_status colonise(const pps_species *species, uint64_t seed, double kill,
                           attractor *point, size_t n_points, pps_skeleton *s) {
    size_t met = 0;
    for (;;) {
        meet(point, n_points, s, met);
        met = s->n;
        for (size_t i = 0; i < n_points; i++) {
            point[i].alive = point[i].alive && point[i].distance >= kill * kill;
        }
        double(*way)[3] = malloc(s->n * sizeof *way);
        if (!way) {
            return PPS_ERR_MEMORY;
        }
        pull(species, point, n_points, s, way);
        pps_status status = sprout(species, seed, s, way, point, n_points);
        free(way);
        if (status || s->n == met) {
            return status;
        }
    }
}

/* Limbs first, towards a few points; then twigs from them towards many. */
static pps_status branch(const pps_species *species, uint64_t seed, pps_skeleton *s) {
    size_t n_twigs = (size_t)species->crown.points;
    size_t n_limbs = (size_t)(species->tiers.count > 0 ? species->tiers.count
                                                       : species->crown.limbs);
    attractor *point = malloc((n_limbs + n_twigs) * sizeof *point);
    if (!point) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < n_limbs + n_twigs; i++) {
        point[i] = (attractor){{0, 0, 0}, INFINITY, 0, true};
        if (i < n_limbs) {
            pps_grow_limb_point(species, seed, i, point[i].at);
        } else {
            pps_grow_twig_point(species, seed, i - n_limbs, point[i].at);
        }
        pps_grow_snap(point[i].at);
    }
    double near = fmax(species->growth.kill, 1.5 * species->growth.step);
    pps_status status = colonise(species, seed, near, point, n_limbs, s);
    if (!status) {
        status =
            colonise(species, seed, species->growth.kill, point + n_limbs, n_twigs, s);
    }
    free(point);
    return status;
}

pps_status pps_skeleton_grow(const pps_species *species, uint64_t seed,
                             pps_skeleton *out) {
    *out = (pps_skeleton){0, 0, NULL};
    pps_status status = PPS_OK;
    for (int i = 0; i < (int)species->stems.count && !status; i++) {
        status = add_stem(species, seed, i, out);
        status = status ? status : add_forks(species, seed, i, out);
    }
    status = status ? status : branch(species, seed, out);
    return status ? status : pps_skeleton_shape(species, out);
}
