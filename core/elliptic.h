/* Complete elliptic integrals of the second kind, many at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_ELLIPTIC_H
#define PPS_CORE_ELLIPTIC_H

#include <stddef.h>

/* E(k) in place of the complements 1 - k^2 in [0, 1], n of them, to 1e-14. */
void pps_elliptic_e(size_t n, double *complement);

#endif
