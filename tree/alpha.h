/* Cut-out alpha: where on a triangle the surface is.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_ALPHA_H
#define PPS_TREE_ALPHA_H

#include <ppscat/tree/mesh.h>

/* Whether anything of the triangle may be cut out. */
bool pps_alpha_any(const pps_mesh *mesh, size_t triangle);

/* Whether the surface is there at barycentric (u, v): a + u (b - a) + v (c - a). */
bool pps_alpha_there(const pps_mesh *mesh, size_t triangle, double u, double v);

/* share[triangle]: how much of each triangle is there. MEMORY. */
pps_status pps_alpha_coverage(const pps_mesh *mesh, double *share);

#endif
