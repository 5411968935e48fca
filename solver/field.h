/* What one call of pps_dom_radiance works with, seen by the files that share the work:
 * radiance.c (the call), first_light.c (light scattered once), scattered.c (the rest).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_SOLVER_FIELD_H
#define PPS_SOLVER_FIELD_H

#include <stdbool.h>

#include "solver/dom.h"
#include "solver/rays.h"

/* What one call works with. Rows run over the slots of the view; `rays` = n_tau of them. */
typedef struct pps_field {
    const pps_dom *dom;
    const pps_grid *at;
    const pps_view *view;
    size_t first, n_beams; /* beams first .. first + n_beams - 1 */
    size_t n, n_slots, rays;
    double *tau, *rest;       /* n_tau: scaled, to the top and to the bottom */
    double *ect, *root;       /* rays: e^(-c t), t to where the ray enters; its root */
    double *mode[4];          /* n_tau x n: e^(-k tau), its root; at w - tau */
    double *ge, *go;          /* n rows, when the view has not kept them */
    double *near, *near_over; /* a row each, of the mode in hand */
    double *far, *far_over;   /* "    */
    double *row[2];           /* n_tau x n rows: what a c1, a c2 of 1 gives */
    double *moment;           /* n_tau x PPS_SERIES_TERMS rows */
    double *legendre;         /* n_moments rows */
    double *angle, *cosine;   /* n_phi: azimuth within +-180; cos(m phi) */
    double *beam;             /* n_beams x rays: the beam's ray integral */
    double *decay[2];         /* n_beams x n_tau: e^(-q tau), e^(-q (w - tau)) */
    double *aureole;          /* n_tau x n_down: integrals of the beam in hand */
    double *folded;           /* n_moments, of the aureole */
    double *source, *angles;  /* a row each; angles: cosines of scattering */
    double *series;           /* PPS_LANES beams x PPS_SERIES_TERMS rows */
    double *term[2];          /* n_beams x rays: this order, the one before */
    double *value;            /* n_beams x n_phi x rays */
    int *small_in_a_row,
        *order; /* n_beams: towards the end of the series; orders used */
    double *memory;
    pps_view *own_view;
} pps_field;

/* The rays of one sense through depth k. */
static inline pps_run pps_field_run(const pps_field *s, size_t k, bool down) {
    size_t first = down ? 0 : s->view->n_down, at = k * s->n_slots + first;
    return (pps_run){.n = down ? s->view->n_down : s->view->n_up,
                     .down = down,
                     .t = down ? s->tau[k] : s->rest[k],
                     .c = s->view->c + first,
                     .ect = s->ect + at,
                     .root = s->root + at};
}

static inline size_t pps_field_slot(const pps_field *s, bool down) {
    return down ? 0 : s->view->n_down;
}

/* first_light.c: `beam` and `decay`, and `value` of light that was scattered once; of the
 * sky seen through the slab. */
void pps_field_first_light(pps_field *field);

/* scattered.c: ray integrals that all orders share, if any of them needs such; then
 * term[0], what an order adds without its factor cos(m phi), of the beams still running. */
void pps_field_prepare_orders(pps_field *field, int n_orders);
void pps_field_order_terms(pps_field *field, const pps_order *order);

/* Whether the series of orders of beam b has not ended. */
static inline bool pps_field_is_running(const pps_field *s, size_t b) {
    return s->small_in_a_row[b] < 2;
}

#endif
