/* What a tolerance is held against: pps_options.tolerance, --tol.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_TOLERANCE_H
#define PPS_CORE_TOLERANCE_H

#include <stdbool.h>
#include <stddef.h>

/* The largest relative difference of n numbers of one case from better ones: radiances
 * against max(value, 1e-3 of the largest), fluxes against themselves. HUGE_VAL where
 * there is a NaN. */
double pps_tolerance_missed(bool radiances, size_t n, const double *coarse,
                            const double *fine);

#endif
