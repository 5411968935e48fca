/* Surfaces that are there twice.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_DOUBLED_H
#define PPS_TREE_DOUBLED_H

#include <ppscat/tree/mesh.h>

/* Leave out the triangles without area, and those that lie on others of their kind (leaf or
 * wood). Fills n_doubled of a mesh that is not finished. */
pps_status pps_mesh_drop_doubled(pps_mesh *mesh);

/* Mark the later two of four triangles that cover the same flat quadrangle, cut along one
 * diagonal in front and along the other behind. Those that are marked do not count. */
pps_status pps_mesh_doubled_quads(const pps_mesh *mesh, bool *drop);

#endif
