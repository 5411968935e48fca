/* Light that a beam scatters once, along rays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_BEAM_H
#define PPS_CORE_BEAM_H

#include <stdbool.h>
#include <stddef.h>

/* integral[i] = c int e^(-q s) e^(-c |tau - s|) ds over the depths s that light of cosine
 * mu[i] > 0, c = 1/mu, comes from: above tau where it goes down, below where up; q = 1/mu0.
 * rest = w - tau, may be infinite. n is a multiple of FOUR (core/lanes.h). */
void pps_beam_integrals(double mu0, double tau, double rest, bool down, size_t n,
                        const double *mu, double *integral);

#endif
