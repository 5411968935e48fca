/* Radiance in any direction at any depth: the discrete solution gives the source, which
 * is integrated along the ray in closed form (never interpolated between nodes).
 *
 *   first_light.c   light scattered once, with the exact phase function
 *   scattered.c     the rest: sum over orders m of cos(m phi) times the ray integral of
 *                   ge.psi + go.phi (mu > 0) or ge.psi - go.phi (mu < 0)
 *
 * What the beams share (rows of ray integrals, rays.h) is made once for all of them. The
 * sums of one beam run in the same order whatever it is computed with, so its bits do not
 * depend on that.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/phase.h>

#include "core/series.h"
#include "core/vector.h"
#include "solver/field.h"

static void field_free(pps_field *s) {
    free(s->memory);
    free(s->small_in_a_row);
    pps_view_free(s->own_view);
}

/* Lay the arrays out in memory (NULL: only count). */
static size_t field_layout(pps_field *s, double *memory) {
    const pps_discrete *d = &s->dom->discrete;
    size_t n = s->n, n_tau = s->at->n_tau, row = s->n_slots, rays = s->rays;
    struct {
        double **array;
        size_t size;
    } part[] = {
        {&s->tau, n_tau},
        {&s->rest, n_tau},
        {&s->ect, rays},
        {&s->root, rays},
        {&s->mode[0], n_tau * n},
        {&s->mode[1], n_tau * n},
        {&s->mode[2], n_tau * n},
        {&s->mode[3], n_tau * n},
        {&s->ge, n * row},
        {&s->go, n * row},
        {&s->near, row},
        {&s->near_over, row},
        {&s->far, row},
        {&s->far_over, row},
        {&s->row[0], n_tau * n * row},
        {&s->row[1], n_tau * n * row},
        {&s->moment, n_tau * PPS_SERIES_TERMS * row},
        {&s->legendre, (size_t)d->n_moments * row},
        {&s->angle, s->at->n_phi},
        {&s->cosine, s->at->n_phi},
        {&s->beam, s->n_beams * rays},
        {&s->decay[0], s->n_beams * n_tau},
        {&s->decay[1], s->n_beams * n_tau},
        {&s->aureole, n_tau * s->view->n_down},
        {&s->folded, (size_t)d->n_moments},
        {&s->source, row},
        {&s->angles, row},
        {&s->series, PPS_LANES * PPS_SERIES_TERMS * row},
        {&s->term[0], s->n_beams * rays},
        {&s->term[1], s->n_beams * rays},
        {&s->value, s->n_beams * s->at->n_phi * rays},
    };
    size_t size = 0;
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        *part[i].array = memory ? memory + size : NULL;
        size += pps_padded(part[i].size);
    }
    return size;
}

static pps_status field_alloc(pps_field *s) {
    if (pps_view_is_of(s->dom->view, s->at->n_mu, s->at->mu)) {
        s->view = s->dom->view;
    } else {
        pps_status status = pps_view_create(s->at->n_mu, s->at->mu, &s->own_view);
        if (status) {
            return status;
        }
        s->view = s->own_view;
    }
    s->n = (size_t)s->dom->discrete.n;
    s->n_slots = s->view->n_slots;
    s->rays = s->at->n_tau * s->n_slots;
    s->memory = malloc((field_layout(s, NULL) + 1) * sizeof *s->memory);
    s->small_in_a_row = calloc(2 * s->n_beams, sizeof *s->small_in_a_row);
    if (!s->memory || !s->small_in_a_row) {
        return PPS_ERR_MEMORY;
    }
    field_layout(s, s->memory);
    s->order = s->small_in_a_row + s->n_beams;
    return PPS_OK;
}

/* Depths, and along rays the roots of e^(-c t) and their squares. */
static void place_depths(pps_field *s) {
    double w = pps_dom_scaled_thickness(s->dom);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        s->tau[k] = s->at->tau[k] * s->dom->stretch;
        s->rest[k] = isinf(w) ? PPS_FAR : w - s->tau[k];
        for (size_t i = 0; i < s->n_slots; i++) {
            double t = i < s->view->n_down ? s->tau[k] : s->rest[k];
            s->root[k * s->n_slots + i] = -t * s->view->c[i] / 2;
        }
    }
    pps_exp_array(s->rays, s->root, s->root);
    for (size_t i = 0; i < s->rays; i++) {
        s->ect[i] = s->root[i] * s->root[i];
    }
}

/* Adds the terms; counts the orders in a row that are below the tolerance everywhere.
 * The last terms of a beam that has ended are kept for azimuth_rest. */
static void add_order(pps_field *s, int m) {
    const pps_grid *at = s->at;
    for (size_t i = 0; i < at->n_phi; i++) {
        s->cosine[i] = pps_cos_degrees(m * s->angle[i]);
    }
    for (size_t b = 0; b < s->n_beams; b++) {
        if (pps_field_is_running(s, b)) {
            bool small =
                pps_add_order(s->rays, at->n_phi, s->cosine, s->term[0] + b * s->rays,
                              s->dom->tolerance, s->value + b * at->n_phi * s->rays);
            s->small_in_a_row[b] = small ? s->small_in_a_row[b] + 1 : 0;
            s->order[b] = m + 1;
        }
    }
}

/* The last two terms against the values they went into, small values against 1e-3 of the
 * largest. */
static double azimuth_rest(const pps_field *s, size_t b) {
    size_t n_phi = s->at->n_phi;
    const double *value = s->value + b * n_phi * s->rays;
    double largest = 0, rest = 0;
    for (size_t i = 0; i < s->rays * n_phi; i++) {
        largest = fmax(largest, fabs(value[i]));
    }
    for (size_t i = 0; i < s->rays * n_phi; i++) {
        size_t ray = b * s->rays + i % s->rays;
        double last = fabs(s->term[0][ray]) + fabs(s->term[1][ray]);
        if (last > 0) {
            rest = fmax(rest, last / fmax(fabs(value[i]), 1e-3 * largest));
        }
    }
    return rest;
}

/* Back to the caller's order of indices. */
static void write_out(const pps_field *s, double *restrict radiance) {
    size_t n_tau = s->at->n_tau, n_mu = s->at->n_mu, n_phi = s->at->n_phi;
    size_t rays = s->rays, n_slots = s->n_slots;
    const size_t *restrict slot = s->view->slot;
    for (size_t b = 0; b < s->n_beams; b++) {
        for (size_t k = 0; k < n_tau; k++) {
            const double *restrict here = s->value + b * n_phi * rays + k * n_slots;
            for (size_t j = 0; j < n_mu; j++) {
                for (size_t i = 0; i < n_phi; i++) {
                    *radiance++ = here[i * rays + slot[j]];
                }
            }
        }
    }
}

static bool any_running(const pps_field *s) {
    for (size_t b = 0; b < s->n_beams; b++) {
        if (pps_field_is_running(s, b)) {
            return true;
        }
    }
    return false;
}

static void sum_orders(pps_field *s, int n_orders, double *rest) {
    const pps_dom *dom = s->dom;
    place_depths(s);
    pps_field_first_light(s);
    pps_field_prepare_orders(s, n_orders);
    memset(s->term[0], 0, s->n_beams * s->rays * sizeof *s->term[0]);
    for (int m = 0; m < n_orders && any_running(s); m++) {
        double *swap = s->term[1];
        s->term[1] = s->term[0];
        s->term[0] = swap;
        pps_field_order_terms(s, &dom->order[m]);
        add_order(s, m);
        for (size_t b = 0; b < s->n_beams; b++) { /* nothing depends on azimuth */
            if (dom->beams.sky || dom->beams.mu0[s->first + b] == 1) {
                s->small_in_a_row[b] = 2;
            }
        }
    }
    for (size_t b = 0; b < s->n_beams; b++) {
        bool ended = s->small_in_a_row[b] >= 2 || dom->slab.g == 0;
        bool complete = s->order[b] == dom->discrete.n_moments;
        rest[b] = ended || complete ? 0 : azimuth_rest(s, b);
    }
}

/* Values that a call works on at a time; more beams are taken in parts. */
enum { MOST_VALUES = 1 << 20 };

pps_status pps_dom_radiance_orders(const pps_dom *dom, size_t first, size_t n_beams,
                                   int n_orders, const pps_grid *at, double *radiance,
                                   double *rest) {
    size_t size = at->n_tau * at->n_mu * at->n_phi;
    size_t part = size > 0 ? MOST_VALUES / size : n_beams;
    part = part > 0 ? part : 1;
    for (size_t done = 0; done < n_beams; done += part) {
        size_t left = n_beams - done;
        pps_field s = {.dom = dom,
                       .at = at,
                       .first = first + done,
                       .n_beams = left < part ? left : part};
        pps_status status = field_alloc(&s);
        if (!status) {
            sum_orders(&s, n_orders < dom->n_solved ? n_orders : dom->n_solved,
                       rest + done);
            write_out(&s, radiance + done * size);
        }
        field_free(&s);
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

pps_status pps_dom_radiance(const pps_dom *dom, const pps_grid *at, double *radiance) {
    size_t n = dom->beams.n;
    if (n == 0 || !radiance || pps_grid_check(at, dom->slab.thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    double *rest = malloc(n * sizeof *rest);
    pps_status status =
        rest ? pps_dom_radiance_orders(dom, 0, n, dom->n_orders, at, radiance, rest)
             : PPS_ERR_MEMORY;
    free(rest);
    return status;
}
