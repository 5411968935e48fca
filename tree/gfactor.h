/* The G-factor: how much of the slab's scattered light a place in a crown can have, given
 * that the crown ends before the slab's plane does (SPP section 4).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_GFACTOR_H
#define PPS_TREE_GFACTOR_H

#include <ppscat/tree/model.h>

/* G in [0, 1] at depth d of thickness w along the light; n directions over the sphere, to
 * which mu[j] is the cosine of the direction to the light and h[j] >= 0 the optical path
 * to the crown's surface. 1 where nothing is compensated. */
double pps_g_factor(pps_compensation form, double d, double w, int n, const double *mu,
                    const double *h);

#endif
