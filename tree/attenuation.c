/* Attenuation of a leaf's eight octants: the product of what every other leaf lets
 * through, far groups of leaves as one.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include <ppscat/tree/leaf_light.h>

#include "tree/octree.h"

static const float OCTANT = 1.57079632679489662F; /* pi/2, its solid angle */
static const float MOST = 0.98F;                  /* a leaf hides of an octant */

static const double DEFAULT_OPENING = 0.6, SAME_YAW = 1e-9;

/* The few leaves of a bucket show what they show, not what the mean leaf does: such groups
 * must be this much further away. The best of 1, 1.7, 2.8, 3 at equal time. */
static const float FEW = 3;

void pps_octant_direction(int j, double out[3]) {
    for (int k = 0; k < 3; k++) {
        out[k] = (j >> k & 1 ? 1 : -1) / sqrt(3);
    }
}

/* What is collected for one leaf: through[j] is a product over near leaves, depth[j] a
 * sum over groups; the octant's attenuation is through e^-depth. */
typedef struct {
    float at[3];
    float through[PPS_OCTANTS], depth[PPS_OCTANTS];
} lit_leaf;

static int octant_of(float x, float y, float z) {
    return (x > 0) | (y > 0) << 1 | (z > 0) << 2;
}

/* Every leaf of a bucket by itself. The leaf's own slot has r = 0 and hides nothing. */
static void add_bucket(lit_leaf *lit, const pps_octree *tree, uint32_t first) {
    float hidden[PPS_BUCKET];
    int octant[PPS_BUCKET];
    for (int i = 0; i < PPS_BUCKET; i++) {
        uint32_t s = first + (uint32_t)i;
        float x = tree->center[0][s] - lit->at[0];
        float y = tree->center[1][s] - lit->at[1];
        float z = tree->center[2][s] - lit->at[2];
        float rr = x * x + y * y + z * z + 1e-30F;
        float facing = fabsf(tree->normal[0][s] * x + tree->normal[1][s] * y +
                             tree->normal[2][s] * z);
        float o = tree->area[s] * facing / (rr * sqrtf(rr) * OCTANT);
        hidden[i] = o < MOST ? o : MOST;
        octant[i] = octant_of(x, y, z);
    }
    for (int i = 0; i < PPS_BUCKET; i++) {
        lit->through[octant[i]] *= 1 - hidden[i];
    }
}

/* What a group hides, were it in one octant. */
static float group_depth(const pps_octree_node *node, const float d[3], float rr) {
    const float *q = node->q;
    float shown = q[0] * d[0] * d[0] + q[1] * d[1] * d[1] + q[2] * d[2] * d[2] +
                  2 * (q[3] * d[0] * d[1] + q[4] * d[0] * d[2] + q[5] * d[1] * d[2]);
    return shown / (rr * rr * OCTANT);
}

/* Share of the node's box on the positive side of the leaf, an axis. */
static bool positive_shares(const lit_leaf *lit, const pps_octree_node *node,
                            float share[3]) {
    bool straddles = false;
    for (int k = 0; k < 3; k++) {
        float low = node->low[k] - lit->at[k], high = node->high[k] - lit->at[k];
        bool across = low < 0 && high > 0;
        share[k] = across ? high / (high - low) : low >= 0 && high > 0 ? 1 : 0;
        straddles = straddles || across;
    }
    return straddles;
}

/* Take the node as one, if it is far enough; across the planes between octants it must be
 * twice as far, and is shared out by its box. */
static bool add_group(lit_leaf *lit, const pps_octree_node *node, float opening) {
    float d[3], share[3];
    for (int k = 0; k < 3; k++) {
        d[k] = node->center[k] - lit->at[k];
    }
    float rr = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    float size = node->radius * node->radius * (node->n_children ? 1 : FEW * FEW);
    if (!(size < opening * opening * rr)) {
        return false;
    }
    if (!positive_shares(lit, node, share)) {
        lit->depth[octant_of(d[0], d[1], d[2])] += group_depth(node, d, rr);
        return true;
    }
    if (!(4 * size < opening * opening * rr)) {
        return false;
    }
    float depth = group_depth(node, d, rr);
    for (int j = 0; j < PPS_OCTANTS; j++) {
        float part = depth;
        for (int k = 0; k < 3; k++) {
            part *= j >> k & 1 ? share[k] : 1 - share[k];
        }
        lit->depth[j] += part;
    }
    return true;
}

static void add_node(lit_leaf *lit, const pps_octree *tree, const pps_octree_node *node,
                     float opening) {
    if (node->n_children == 0) {
        for (uint32_t s = 0; s < node->n; s += PPS_BUCKET) {
            add_bucket(lit, tree, node->first + s);
        }
        return;
    }
    for (uint32_t i = 0; i < node->n_children; i++) {
        const pps_octree_node *child = &tree->node[node->child + i];
        if (!add_group(lit, child, opening)) {
            add_node(lit, tree, child, opening);
        }
    }
}

static void attenuate(const pps_scene *scene, const pps_octree *tree, uint32_t slot,
                      float opening, float *att) {
    lit_leaf lit = {.depth = {0}};
    int images = scene->period[0] > 0; /* the scene's neighbours on every side */
    for (int j = 0; j < PPS_OCTANTS; j++) {
        lit.through[j] = 1;
    }
    for (int x = -images; x <= images; x++) {
        for (int y = -images; y <= images; y++) {
            lit.at[0] = tree->center[0][slot] - (float)(x * scene->period[0]);
            lit.at[1] = tree->center[1][slot] - (float)(y * scene->period[1]);
            lit.at[2] = tree->center[2][slot];
            if (!add_group(&lit, &tree->node[0], opening)) {
                add_node(&lit, tree, &tree->node[0], opening);
            }
        }
    }
    for (int j = 0; j < PPS_OCTANTS; j++) {
        att[j] = lit.through[j] * expf(-lit.depth[j]);
    }
}

/* All leaves of a scene, each in the shade of all the others. */
static pps_status attenuate_together(const pps_scene *scene,
                                     const pps_attenuation_options *o, float *att) {
    float opening = (float)(o->opening == 0 ? DEFAULT_OPENING : fmax(o->opening, 0));
    int threads = o->threads > 0 ? o->threads : omp_get_max_threads();
    pps_octree *tree;
    pps_status status = pps_octree_create(scene, &tree);
    if (status) {
        return status;
    }
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads)
    for (size_t s = 0; s < tree->n_slots; s++) {
        if (tree->leaf[s] != UINT32_MAX) {
            attenuate(scene, tree, (uint32_t)s, opening,
                      att + (size_t)PPS_OCTANTS * tree->leaf[s]);
        }
    }
    pps_octree_free(tree);
    return PPS_OK;
}

/* The first instance that is the same plant, turned the same way: sizes and places do not
 * count for what a plant's own leaves hide of each other. */
static size_t first_alike(const pps_scene *scene, size_t i) {
    const pps_instance *at = scene->instance;
    size_t k = 0;
    while (at[k].prototype != at[i].prototype ||
           fabs(remainder(at[k].yaw - at[i].yaw, 360)) > SAME_YAW) {
        k++;
    }
    return k;
}

static pps_status attenuate_alone(const pps_scene *scene, size_t i,
                                  const pps_attenuation_options *o, float *att) {
    pps_instance plant = {.prototype = scene->instance[i].prototype,
                          .yaw = scene->instance[i].yaw,
                          .scale = 1};
    size_t first = 0;
    pps_scene lone = *scene;
    lone.n_instances = 1;
    lone.instance = &plant;
    lone.n_leaves = scene->prototype[plant.prototype].mesh->n_leaves;
    lone.first_leaf = &first;
    lone.period[0] = lone.period[1] = 0;
    return lone.n_leaves ? attenuate_together(&lone, o, att) : PPS_OK;
}

static pps_status attenuate_apart(const pps_scene *scene,
                                  const pps_attenuation_options *o, float *att) {
    pps_status status = PPS_OK;
    for (size_t i = 0; i < scene->n_instances && !status; i++) {
        size_t k = first_alike(scene, i);
        float *own = att + (size_t)PPS_OCTANTS * scene->first_leaf[i];
        if (k == i) {
            status = attenuate_alone(scene, i, o, own);
        } else {
            size_t n = scene->prototype[scene->instance[i].prototype].mesh->n_leaves;
            memcpy(own, att + (size_t)PPS_OCTANTS * scene->first_leaf[k],
                   PPS_OCTANTS * n * sizeof *att);
        }
    }
    return status;
}

pps_status pps_leaf_attenuation(const pps_scene *scene,
                                const pps_attenuation_options *options, float *att) {
    pps_attenuation_options o = options ? *options : (pps_attenuation_options){0};
    if (!scene || !att || scene->n_leaves == 0 || !(o.opening < 1) || o.threads < 0) {
        return PPS_ERR_ARGUMENT;
    }
    return o.apart ? attenuate_apart(scene, &o, att)
                   : attenuate_together(scene, &o, att);
}

pps_status pps_leaf_attenuation_create(const pps_scene *scene,
                                       const pps_attenuation_options *options,
                                       float **out) {
    if (!out) {
        return PPS_ERR_ARGUMENT;
    }
    *out = NULL;
    if (!scene || scene->n_leaves == 0) {
        return PPS_ERR_ARGUMENT;
    }
    float *att = malloc(PPS_OCTANTS * scene->n_leaves * sizeof *att);
    pps_status status =
        att ? pps_leaf_attenuation(scene, options, att) : PPS_ERR_MEMORY;
    if (status) {
        free(att);
        return status;
    }
    *out = att;
    return PPS_OK;
}
