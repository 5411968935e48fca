/* Anderson acceleration of x = g(x), each colour band by itself.
 *
 * The next x mixes the last four images g so that the residual g(x) - x, linear in the
 * mixture, is least. Reference: Walker & Ni 2011.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_ANDERSON_H
#define PPS_TREE_ANDERSON_H

#include <ppscat/status.h>

#include "tree/sweep.h"

enum { PPS_ANDERSON_DEPTH = 3 };

typedef struct pps_anderson {
    size_t n, measured;
    int kept, next; /* differences at hand, and where the next one goes */
    bool started;
    pps_bands *f, *g; /* of the last step */
    pps_bands *df[PPS_ANDERSON_DEPTH], *dg[PPS_ANDERSON_DEPTH];
    double gram[PPS_ANDERSON_DEPTH][PPS_ANDERSON_DEPTH][4];
    pps_bands *memory;
} pps_anderson;

/* x has n numbers; the residual counts in the first `measured` of them. The others are
 * mixed likewise, so that the whole stays a mixture of states. */
pps_status pps_anderson_init(pps_anderson *a, size_t n, size_t measured);
void pps_anderson_clear(pps_anderson *a);
void pps_anderson_restart(pps_anderson *a); /* forget, for another g */

/* From x and its image g to the next x >= 0; weight[measured]. Returns the largest band's
 * weighted |g - x| / |g|. */
double pps_anderson_step(pps_anderson *a, const float *weight, pps_bands *x,
                         const pps_bands *g);

#endif
