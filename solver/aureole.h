/* The aureole: what the forward peak that delta-M takes off scatters twice.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_AUREOLE_H
#define PPS_SOLVER_AUREOLE_H

#include "solver/dom.h"

/* Whether there is anything to correct, to rounding. */
bool pps_aureole_matters(const pps_dom *dom);

/* The moments of what the peak scatters twice, n_moments of them: of the slab alone. */
void pps_aureole_fold(const pps_dom *dom, double *coefficient);

/* What radiances downwards must gain is source times integral: source[i], of the n
 * directions mu (a multiple of PPS_LANES) in one azimuth, from those moments; integral[i],
 * of their c = 1/mu at the true depth tau, in any azimuth. x: n doubles to work in. */
void pps_aureole_sources(const pps_dom *dom, const double *coefficient, double mu0,
                         double cosine, size_t n, const double *mu, double *x,
                         double *source);
void pps_aureole_rays(const pps_dom *dom, double mu0, double tau, size_t n,
                      const double *c, double *integral);

#endif
