/* Wood on the cells: black, and closed, so that a ray meets a quarter of its surface.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_WOOD_H
#define PPS_TREE_WOOD_H

#include <ppscat/tree/cells.h>

/* Sum up cells->wood. */
void pps_wood_measure(const pps_scene *scene, pps_cells *cells);

/* Optical depth of a cell's wood along a side of the cell. */
double pps_wood_depth(const pps_cells *cells, size_t c);

#endif
