/* Range checks of the plain values that come in from outside.
 *
 * Every comparison is written so that a NaN fails it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdbool.h>

#include <ppscat/slab.h>

static pps_status in_range(bool ok) { return ok ? PPS_OK : PPS_ERR_ARGUMENT; }

pps_status pps_slab_check(const pps_slab *slab) {
    return in_range(slab && slab->albedo >= 0 && slab->albedo <= 1 && slab->g > -1 &&
                    slab->g < 1 && slab->thickness > 0);
}

pps_status pps_mu0_check(double mu0) { return in_range(mu0 > 0 && mu0 <= 1); }

pps_status pps_tau_check(size_t n, const double *tau, double thickness) {
    bool ok = n == 0 || tau;
    for (size_t k = 0; ok && k < n; k++) {
        ok = tau[k] >= 0 && tau[k] <= thickness && isfinite(tau[k]);
    }
    return in_range(ok);
}

pps_status pps_grid_check(const pps_grid *grid, double thickness) {
    if (!grid || pps_tau_check(grid->n_tau, grid->tau, thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    bool ok = (grid->n_mu == 0 || grid->mu) && (grid->n_phi == 0 || grid->phi);
    for (size_t j = 0; ok && j < grid->n_mu; j++) {
        ok = fabs(grid->mu[j]) <= 1 && grid->mu[j] != 0;
    }
    for (size_t i = 0; ok && i < grid->n_phi; i++) {
        ok = isfinite(grid->phi[i]);
    }
    return in_range(ok);
}
