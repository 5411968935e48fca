/* Cells without the rays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_CELLS_BARE_H
#define PPS_TREE_CELLS_BARE_H

#include <ppscat/tree/cells.h>

/* As pps_cells_create, but depths and visibilities towards the directions are left to the
 * caller, as zeros. */
pps_status pps_cells_create_bare(const pps_scene *scene,
                                 const pps_cells_options *options, pps_cells **out);

#endif
