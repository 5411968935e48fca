/* All that one look at a deep opacity map tells.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_OPACITY_LOOK_H
#define PPS_TREE_OPACITY_LOOK_H

#include <ppscat/tree/opacity.h>

/* Surfaces before a point and behind it, and the shares of texels with none of them: the
 * light that comes, and that goes on, where surfaces are opaque. */
typedef struct {
    double depth, behind, visible, clear;
} pps_opacity_look;

/* `normal`: the point lies on a surface of the map's own, of this unit normal, which does
 * not count; it is taken to go on as a plane through the texels about. NULL: the point
 * lies between surfaces. False, with {0, 0, 1, 1}, off the map. */
bool pps_opacity_look_at(const pps_opacity_map *map, const double point[3],
                         const double *normal, pps_opacity_look *look);

#endif
