/* The shape of the wood: smooth ways, radii by the pipe model, no more nodes than bends.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/skeleton_parts.h"
#include "tree/vec.h"

enum { SMOOTHINGS = 6 };

/* Children before parents: tips add up, and the child with the most goes on. */
static void count_tips(pps_skeleton *s) {
    for (size_t k = 0; k < s->n; k++) {
        s->node[k].n_children = s->node[k].tips = 0;
        s->node[k].main_child = PPS_NO_NODE;
    }
    for (size_t k = s->n; k-- > 0;) {
        pps_node *node = &s->node[k];
        node->tips += node->n_children == 0;
        if (node->parent != PPS_NO_NODE) {
            pps_node *parent = &s->node[node->parent];
            parent->n_children++;
            parent->tips += node->tips;
            if (parent->main_child == PPS_NO_NODE ||
                node->tips >= s->node[parent->main_child].tips) {
                parent->main_child = (uint32_t)k;
            }
        }
    }
}

/* Stems that stood in the shade of the others, with hardly a twig, are taken away: they
 * would be bare poles as thin as a twig. */
static pps_status prune(pps_skeleton *s) {
    uint32_t *now = malloc((s->n + 1) * sizeof *now), most = 0;
    if (!now) {
        return PPS_ERR_MEMORY;
    }
    for (size_t k = 0; k < s->n; k++) {
        most = s->node[k].tips > most ? s->node[k].tips : most;
    }
    size_t kept = 0;
    for (size_t k = 0; k < s->n; k++) {
        pps_node node = s->node[k];
        bool foot = node.parent == PPS_NO_NODE;
        bool gone = foot ? node.tips < most / 12 : now[node.parent] == PPS_NO_NODE;
        now[k] = gone ? PPS_NO_NODE : (uint32_t)kept;
        if (!gone) {
            node.parent = foot ? PPS_NO_NODE : now[node.parent];
            s->node[kept++] = node;
        }
    }
    s->n = kept;
    free(now);
    count_tips(s);
    return PPS_OK;
}

/* Steps in the directions of a moment leave kinks: each node moves to the middle of its
 * neighbours on the way from foot to tip; feet and tips stay. */
static pps_status smooth(pps_skeleton *s) {
    double(*moved)[3] = malloc((s->n + 1) * sizeof *moved);
    if (!moved) {
        return PPS_ERR_MEMORY;
    }
    for (int round = 0; round < SMOOTHINGS; round++) {
        for (size_t k = 0; k < s->n; k++) {
            const pps_node *node = &s->node[k];
            bool end = node->parent == PPS_NO_NODE || node->main_child == PPS_NO_NODE;
            for (int i = 0; i < 3; i++) {
                moved[k][i] =
                    end ? node->at[i]
                        : node->at[i] / 2 + (s->node[node->parent].at[i] +
                                             s->node[node->main_child].at[i]) /
                                                4;
            }
        }
        for (size_t k = 0; k < s->n; k++) {
            memcpy(s->node[k].at, moved[k], sizeof moved[k]);
            pps_grow_snap(s->node[k].at);
        }
    }
    free(moved);
    return PPS_OK;
}

/* The pipe model (SYHK64) with the power that makes the thickest stem as
 * thick as asked for: radius^power adds up over the tips. */
static void set_radii(const pps_species *species, pps_skeleton *s) {
    double most = 2, ratio = species->wood.trunk_radius / species->wood.twig_radius;
    for (size_t k = 0; k < s->n; k++) {
        most = fmax(most, s->node[k].tips);
    }
    double root = log(ratio) / log(most);
    for (size_t k = 0; k < s->n; k++) {
        s->node[k].radius = species->wood.twig_radius * pow(s->node[k].tips, root);
    }
}

/* Wood narrows towards a fork and not at one blow beyond it. */
static pps_status smooth_radii(pps_skeleton *s) {
    double *smoothed = malloc((s->n + 1) * sizeof *smoothed);
    if (!smoothed) {
        return PPS_ERR_MEMORY;
    }
    for (int round = 0; round < SMOOTHINGS; round++) {
        for (size_t k = 0; k < s->n; k++) {
            const pps_node *node = &s->node[k];
            smoothed[k] = node->radius;
            if (node->parent != PPS_NO_NODE && node->main_child != PPS_NO_NODE) {
                const pps_node *before = &s->node[node->parent];
                double from = before->main_child == k ? before->radius : node->radius;
                smoothed[k] =
                    node->radius / 2 + (from + s->node[node->main_child].radius) / 4;
            }
        }
        for (size_t k = 0; k < s->n; k++) {
            s->node[k].radius = smoothed[k];
        }
    }
    free(smoothed);
    return PPS_OK;
}

/* How far the node is from the line between two others. */
static double off_line(const double p[3], const double a[3], const double b[3]) {
    double along[3], to[3], across[3];
    vec_sub(b, a, along);
    vec_normalize(along);
    vec_sub(p, a, to);
    vec_along(to, -vec_dot(to, along), along, across);
    return vec_length(across);
}

/* Nodes that hardly bend the wood between its forks are left out. */
static pps_status simplify(const pps_species *species, pps_skeleton *s) {
    double longest = 2.2 * species->growth.step;
    uint32_t *now = malloc((s->n + 1) * sizeof *now);
    if (!now) {
        return PPS_ERR_MEMORY;
    }
    size_t kept = 0;
    for (uint32_t k = 0; k < s->n; k++) {
        pps_node node = s->node[k];
        bool drop = false;
        if (node.parent != PPS_NO_NODE && node.n_children == 1) {
            const pps_node *parent = &s->node[now[node.parent]];
            const pps_node *child = &s->node[node.main_child];
            double span[3];
            vec_sub(child->at, parent->at, span);
            bool flares = node.at[2] < 3 * species->wood.flare_height;
            drop = !flares && parent->n_children == 1 && vec_length(span) < longest &&
                   off_line(node.at, parent->at, child->at) < 0.3 * node.radius + 0.004;
        }
        if (drop) {
            now[k] = now[node.parent]; /* its child now hangs on the parent */
        } else {
            node.parent = node.parent == PPS_NO_NODE ? PPS_NO_NODE : now[node.parent];
            now[k] = (uint32_t)kept;
            s->node[kept++] = node;
        }
    }
    s->n = kept;
    free(now);
    count_tips(s);
    return PPS_OK;
}

pps_status pps_skeleton_shape(const pps_species *species, pps_skeleton *skeleton) {
    count_tips(skeleton);
    pps_status status = prune(skeleton);
    status = status ? status : smooth(skeleton);
    if (!status) {
        set_radii(species, skeleton);
        status = smooth_radii(skeleton);
    }
    return status ? status : simplify(species, skeleton);
}
