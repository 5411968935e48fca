/* Neighbours on the grid of cells.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_GRID_H
#define PPS_TREE_GRID_H

#include <ppscat/tree/cells.h>

/* Mean over the cells with leaves among the 3^3 about each cell with leaves; 0 in the
 * others. in and out differ; a periodic grid wraps along x and y. */
void pps_grid_smooth(const pps_cells *cells, const double *in, double *out);

/* The cell of a point; -1 outside, but for the axes that repeat. */
long pps_grid_cell(const pps_cells *cells, const double at[3]);

/* 0 is all cores. */
int pps_thread_count(int threads);

#endif
