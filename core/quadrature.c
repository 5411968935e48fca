/* Nodes and weights of a hemisphere.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/quadrature.h"

#include "core/gsl.h"

pps_status pps_hemisphere_nodes(pps_nodes kind, int n, double *mu, double *weight) {
    pps_status status = pps_gauss_unit(n, mu, weight);
    if (status || kind != PPS_NODES_MAPPED) {
        return status;
    }
    for (int i = 0; i < n; i++) {
        weight[i] *= 2 * mu[i];
        mu[i] *= mu[i];
    }
    return PPS_OK;
}
