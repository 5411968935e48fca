/* The solver's handle, seen by its own files only.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_DOM_H
#define PPS_SOLVER_DOM_H

#include <ppscat/dom.h>

#include "solver/order.h"

struct pps_dom {
    pps_slab slab; /* as given */
    pps_nodes nodes;
    bool corrected; /* single scattering with the exact phase function */
    double tolerance;
    pps_discrete discrete;
    double f;       /* truncated fraction of delta-M; 0 without */
    double stretch; /* scaled optical depth / true: 1 - albedo f */
    double mu0;     /* 0 until solved; 1 under the sky */
    bool sky;       /* solved for isotropic light instead of the beam */
    int n_orders;
    pps_order *order;
    double *scratch; /* of pps_order_solve */
};

/* pps_dom_radiance with the first n_orders of the prepared orders, and how much the last
 * two still added, relative to max(value, 1e-3 of the largest); 0 when the series ended
 * by itself. */
pps_status pps_dom_radiance_orders(const pps_dom *dom, int n_orders, const pps_grid *at,
                                   double *radiance, double *rest);

/* How many orders a tolerance of the azimuth series asks for. */
int pps_dom_orders_for(double g, double tolerance, int n_moments);

/* The nodes that PPS_NODES_AUTO means. */
pps_nodes pps_dom_choose_nodes(const pps_slab *slab, int streams);

/* Azimuthal mean of the radiance of the discrete problem (its own single scattering
 * included), at a scaled depth. */
double pps_dom_mean_radiance(const pps_dom *dom, double tau, double mu);

#endif
