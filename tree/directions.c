/* The 22 directions of cells and models, from data/directions-22.csv.
 *
 * Both poles and four rings of five: the least set that is its own antipode, keeps its
 * shape when turned by 72 degrees about the vertical, and has equal weights that integrate
 * every polynomial of degree 5 exactly. For that the heights z, z' of the rings solve
 *     z^2 + z'^2 = 8/15,   z^4 + z'^4 = 6/25,
 * so that mean z^2 = 1/3 and mean z^4 = 1/5; the antipodes of a ring lie 36 degrees from
 * it, and the two rings of a hemisphere 36 degrees from each other.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/tree/cells.h>

static const double DIRECTIONS[][3] = {
#include "directions_22.inc"
};

pps_directions pps_directions_22(void) {
    return (pps_directions){sizeof DIRECTIONS / sizeof *DIRECTIONS, DIRECTIONS};
}
