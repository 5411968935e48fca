/* An octree over leaves, for sums over all leaves seen from a point.
 *
 * A node stands for its leaves by their area-weighted centre and by Q, with which the area
 * they show towards a direction d is about d.Q d: sum of A |n.d| with
 * |n.d| ~ 3/16 + 15/16 (n.d)^2, the best such fit over all directions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_OCTREE_H
#define PPS_TREE_OCTREE_H

#include <ppscat/tree/scene.h>

enum { PPS_BUCKET = 8 }; /* leaves of a node without children, with room to spare */

typedef struct pps_octree_node {
    float center[3], radius; /* of the leaves about it, their own size included */
    float low[3], high[3];   /* their box */
    float q[6];              /* xx, yy, zz, xy, xz, yz */
    uint32_t child;          /* its first child; 0: a bucket */
    uint32_t n_children;
    uint32_t first, n; /* its leaves, in the tree's order; buckets start at multiples */
} pps_octree_node;     /* of PPS_BUCKET, padded with leaves of no area */

/* Leaves in the tree's order, one array a number, so that a bucket is read in one go. */
typedef struct pps_octree {
    size_t n_nodes, n_slots;
    pps_octree_node *node;
    float *center[3], *normal[3], *area;
    uint32_t *leaf; /* scene number of a slot; UINT32_MAX: padding */
} pps_octree;

pps_status pps_octree_create(const pps_scene *scene, pps_octree **out);
void pps_octree_free(pps_octree *tree);

#endif
