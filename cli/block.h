/* What a method answers to a unit: the one place where sweeps call it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_BLOCK_H
#define PPSCAT_CLI_BLOCK_H

#include "sweep.h"

/* How it went for one mu0. */
typedef struct {
    const char *refusal; /* static text; NULL when answered */
    pps_info info;       /* when answered */
} block_answer;

/* The diffuse radiance of all mu0 of the unit at its depths and directions:
 * radiance[((b * n_depths + k) * n_mu + j) * n_phi + i], and answer[b]. What is refused
 * is left as it is. CLI_FAILED without memory, or where sweep_go_on says no. */
int block_radiance(const sweep_station *own, const sweep_worker *worker,
                   const sweep_unit *unit, double *radiance, block_answer *answer);

/* The fluxes at its depths: flux[b * n_depths + k]. */
int block_flux(const sweep_station *own, const sweep_worker *worker,
               const sweep_unit *unit, pps_flux *flux, block_answer *answer);

/* Enter the answers into the record of t: what was used, and n_values numbers of each mu0,
 * per_row of them a row. A row that is refused, or has a value that is no finite number,
 * becomes NAN and counts as refused; the others are multiplied by `beam`. */
int block_settle(const sweep_station *own, const sweep_worker *worker,
                 const sweep_unit *unit, const block_answer *answer, size_t per_row,
                 size_t n_values, double *values, sweep_tile *t);

#endif
