/* Fluxes and mean intensities of thin slabs: single scattering exact.
 *
 * Single scattering dominates there, and directions mu ~ thickness, which no node
 * resolves, carry much of the mean intensity. So it is taken from the exact integral, as
 * radiances always do. What is left, multiple scattering, is scaled with the energy that
 * single scattering hands over to it, so that energy is conserved to rounding as before.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_THIN_H
#define PPS_SOLVER_THIN_H

#include "solver/dom.h"

/* Whether the slab and its beams are to be corrected so. */
bool pps_thin_applies(const pps_dom *dom);

/* What does not depend on depth, of all beams of the last solve. MEMORY. */
typedef struct pps_thin pps_thin;
pps_status pps_thin_create(const pps_dom *dom, pps_thin **out);
void pps_thin_free(pps_thin *thin);

/* Put beam b's diffuse fluxes and mean_diffuse right at tau, a true depth. */
void pps_thin_correct(const pps_thin *thin, size_t b, double tau, pps_flux *flux);

#endif
