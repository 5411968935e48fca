/* Directions sorted for the vector loops: those going down, then those going up, each
 * group padded to whole blocks (core/vector.h) with copies of its last.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_VIEW_H
#define PPS_SOLVER_VIEW_H

#include "solver/order.h"

typedef struct pps_view {
    size_t n_mu;
    size_t n_down, n_up, n_slots; /* padded; n_slots = n_down + n_up */
    size_t *slot;                 /* of each direction given */
    double *given;                /* n_mu cosines */
    double *mu, *c;               /* n_slots: |mu| and 1/|mu| */
    /* Projections kept, or NULL: of order m, ge at kept[m], then go; n_kept orders. */
    double **kept;
    int n_kept;
} pps_view;

/* *out is NULL on failure. */
pps_status pps_view_create(size_t n_mu, const double *mu, pps_view **out);
void pps_view_free(pps_view *view);

/* Are these the directions it was made for? */
bool pps_view_is_of(const pps_view *view, size_t n_mu, const double *mu);

/* ge and go (go with the sign of the direction) of an order: n rows of n_slots each.
 * scratch: n_moments rows. */
void pps_view_project(const pps_view *view, const pps_order *order,
                      const pps_discrete *discrete, double *ge, double *go,
                      double *scratch);

/* Keep the projections of the first n_orders. */
pps_status pps_view_keep(pps_view *view, int n_orders, const pps_order *order,
                         const pps_discrete *discrete);

#endif
