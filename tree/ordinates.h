/* The directions that `lattice` sweeps.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_ORDINATES_H
#define PPS_TREE_ORDINATES_H

enum { PPS_ORDINATES = 22 };

/* Unit vectors and their shares of the sphere, in antipodal pairs. */
void pps_ordinates(double to[PPS_ORDINATES][3], double weight[PPS_ORDINATES]);

#endif
