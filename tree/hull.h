/* The convex hull's area of points in a plane.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_HULL_H
#define PPS_TREE_HULL_H

#include <stddef.h>

/* Of n points, which it puts in another order. 0 where there is no memory. */
double pps_hull_area(size_t n, double (*point)[2]);

#endif
