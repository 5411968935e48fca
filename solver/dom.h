/* The solver's handle, seen by its own files only.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_DOM_H
#define PPS_SOLVER_DOM_H

#include <ppscat/dom.h>

#include "solver/order.h"
#include "solver/view.h"

struct pps_dom {
    pps_slab slab; /* as given */
    pps_nodes nodes;
    bool corrected; /* single scattering with the exact phase function */
    double tolerance;
    pps_discrete discrete;
    double f;        /* truncated fraction of delta-M; 0 without */
    double stretch;  /* scaled optical depth / true: 1 - albedo f */
    pps_beams beams; /* n = 0 until solved */
    int n_orders;    /* as many as were asked for */
    int n_ready;     /* eigenproblems solved: 1 until a beam needs azimuth */
    int n_solved;    /* orders that the present beams have */
    pps_order *order;
    size_t n_wanted; /* beams of the last call to solve, also where it failed */
    int n_lit;       /* orders whose alpha and beta are of those beams */
    size_t capacity; /* padded beams that there is memory for */
    double *scratch; /* of pps_order_solve */
    pps_view *view;  /* directions kept by pps_dom_set_directions, or NULL */
};

/* pps_dom_radiance of n_beams beams from `first` on, with the first n_orders of the
 * prepared orders; radiance[0] belongs to beam `first`. rest, one number a beam: how much
 * the last two orders still added, relative to max(value, 1e-3 of the largest); 0 when
 * the series ended by itself. */
pps_status pps_dom_radiance_orders(const pps_dom *dom, size_t first, size_t n_beams,
                                   int n_orders, const pps_grid *at, double *radiance,
                                   double *rest);

/* Prepare for at least so many orders from the next beam on; tolerance > 0 replaces that
 * of the azimuth series. Keeps what is solved. */
pps_status pps_dom_want_orders(pps_dom *dom, int n_orders, double tolerance);

/* How many orders a tolerance of the azimuth series asks for. */
int pps_dom_orders_for(double g, double tolerance, int n_moments);

/* The nodes that PPS_NODES_AUTO means. */
pps_nodes pps_dom_choose_nodes(const pps_slab *slab, int streams);

/* At scaled depths, true ones times this: tau, and the distance w - tau to the bottom. */
double pps_dom_scaled_thickness(const pps_dom *dom);

#endif
