/* Vertices that lie at the same place.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_WELD_H
#define PPS_TREE_WELD_H

#include <ppscat/tree/mesh.h>

/* same[v]: the first of the vertices that lie where v does. MEMORY. */
pps_status pps_mesh_weld(const pps_mesh *mesh, uint32_t *same);

#endif
