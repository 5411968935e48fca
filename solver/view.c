/* Directions and the source of each mode in them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/vector.h"

/* Give the directions of one sense their slots from `first` on; how many slots, padded. */
static size_t fill_group(pps_view *view, bool down, size_t first) {
    size_t n = 0;
    for (size_t j = 0; j < view->n_mu; j++) {
        if ((view->given[j] > 0) == down) {
            view->slot[j] = first + n;
            view->mu[first + n++] = fabs(view->given[j]);
        }
    }
    size_t padded = pps_padded(n);
    for (size_t i = n; i < padded; i++) {
        view->mu[first + i] = view->mu[first + n - 1];
    }
    return padded;
}

pps_status pps_view_create(size_t n_mu, const double *mu, pps_view **out) {
    size_t most = pps_padded(n_mu) + PPS_LANES;
    *out = NULL;
    pps_view *view = calloc(1, sizeof *view);
    double *memory = malloc((n_mu + 2 * most) * sizeof *memory);
    size_t *slot = malloc((n_mu + 1) * sizeof *slot);
    if (!view || !memory || !slot) {
        free(view);
        free(memory);
        free(slot);
        return PPS_ERR_MEMORY;
    }
    *view = (pps_view){.n_mu = n_mu,
                       .slot = slot,
                       .given = memory,
                       .mu = memory + n_mu,
                       .c = memory + n_mu + most};
    if (n_mu > 0) {
        memcpy(view->given, mu, n_mu * sizeof *mu);
    }
    view->n_down = fill_group(view, true, 0);
    view->n_up = fill_group(view, false, view->n_down);
    view->n_slots = view->n_down + view->n_up;
    for (size_t i = 0; i < view->n_slots; i++) {
        view->c[i] = 1 / view->mu[i];
    }
    *out = view;
    return PPS_OK;
}

void pps_view_free(pps_view *view) {
    if (!view) {
        return;
    }
    for (int m = 0; m < view->n_kept; m++) {
        free(view->kept[m]);
    }
    free(view->kept);
    free(view->given);
    free(view->slot);
    free(view);
}

bool pps_view_is_of(const pps_view *view, size_t n_mu, const double *mu) {
    return view && view->n_mu == n_mu && n_mu > 0 &&
           memcmp(view->given, mu, n_mu * sizeof *mu) == 0;
}

void pps_view_project(const pps_view *view, const pps_order *order,
                      const pps_discrete *discrete, double *ge, double *go,
                      double *scratch) {
    size_t n_slots = view->n_slots;
    pps_order_project(order, discrete, n_slots, view->mu, ge, go, scratch);
    for (size_t j = 0; j < (size_t)order->n; j++) {
        for (size_t i = view->n_down; i < n_slots; i++) {
            go[j * n_slots + i] = -go[j * n_slots + i];
        }
    }
}

pps_status pps_view_keep(pps_view *view, int n_orders, const pps_order *order,
                         const pps_discrete *discrete) {
    if (view->n_kept >= n_orders) {
        return PPS_OK;
    }
    size_t block = (size_t)discrete->n * view->n_slots;
    double *scratch =
        malloc(((size_t)discrete->n_moments * view->n_slots + 1) * sizeof *scratch);
    double **kept = calloc((size_t)n_orders, sizeof *kept);
    if (!scratch || !kept) {
        free(scratch);
        free(kept);
        return PPS_ERR_MEMORY;
    }
    for (int m = 0; m < view->n_kept; m++) {
        kept[m] = view->kept[m];
    }
    free(view->kept);
    view->kept = kept;
    for (; view->n_kept < n_orders; view->n_kept++) {
        int m = view->n_kept;
        kept[m] = malloc((2 * block + 1) * sizeof **kept);
        if (!kept[m]) {
            break;
        }
        pps_view_project(view, &order[m], discrete, kept[m], kept[m] + block, scratch);
    }
    free(scratch);
    return view->n_kept == n_orders ? PPS_OK : PPS_ERR_MEMORY;
}
