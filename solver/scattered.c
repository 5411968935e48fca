/* Light scattered more than once: what one azimuthal order adds, as ray integrals of its
 * modes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include <ppscat/expdiff.h>

#include "core/series.h"
#include "core/vector.h"
#include "solver/field.h"

/* The projections of an order: kept by the view, or made now. */
static void project(pps_field *s, const pps_order *order, const double **ge,
                    const double **go) {
    if (order->m < s->view->n_kept) {
        *ge = s->view->kept[order->m];
        *go = *ge + s->n * s->n_slots;
        return;
    }
    pps_view_project(s->view, order, &s->dom->discrete, s->ge, s->go, s->legendre);
    *ge = s->ge;
    *go = s->go;
}

/* Roots of e^(-k tau) and e^(-k (w - tau)), and their squares, every mode and depth. */
PPS_CLONES static void mode_exponentials(pps_field *s, const pps_order *order) {
    size_t all = s->at->n_tau * s->n;
    for (size_t k = 0; k < s->at->n_tau; k++) {
        for (size_t j = 0; j < s->n; j++) {
            s->mode[1][k * s->n + j] = -order->k[j] * s->tau[k] / 2;
            s->mode[3][k * s->n + j] = -order->k[j] * s->rest[k] / 2;
        }
    }
    for (int side = 0; side < 4; side += 2) {
        double *restrict square = s->mode[side], *restrict root = s->mode[side + 1];
        pps_exp_array(all, root, root);
        for (size_t i = 0; i < all; i++) {
            square[i] = root[i] * root[i];
        }
    }
}

/* Rows of ray integrals of the modes k w >= 1, the same for every beam. */
static void mode_rows(pps_field *s, const pps_order *order, const double *ge,
                      const double *go) {
    mode_exponentials(s, order);
    pps_mode_view view = {s->near, s->near_over, s->far, s->far_over};
    for (size_t j = (size_t)order->n_small; j < s->n; j++) {
        for (int down = 0; down < 2; down++) {
            size_t first = pps_field_slot(s, down), row = j * s->n_slots + first;
            size_t n = down ? s->view->n_down : s->view->n_up;
            pps_mode_view_fill(n, down ? order->k[j] : -order->k[j], s->view->c + first,
                               ge + row, go + row, s->near, s->near_over, s->far,
                               s->far_over);
            pps_runs runs = {n,
                             s->at->n_tau,
                             s->n_slots,
                             down ? s->tau : s->rest,
                             s->view->c + first,
                             s->ect + first,
                             s->root + first};
            pps_mode_here here = {order->k[j], s->n, s->mode[down ? 0 : 2] + j,
                                  s->mode[down ? 1 : 3] + j, s->mode[down ? 2 : 0] + j};
            pps_mode_rays(&runs, &here, &view, s->n * s->n_slots, s->row[!down] + row,
                          s->row[down] + row);
        }
    }
}

static void ray_moments(pps_field *s) {
    double w = pps_dom_scaled_thickness(s->dom);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        for (int down = 0; down < 2; down++) {
            pps_run run = pps_field_run(s, k, down);
            size_t first = pps_field_slot(s, down);
            pps_series_moments(run.n, w, run.t, run.c, run.ect, run.root,
                               s->moment + PPS_SERIES_TERMS * (k * s->n_slots + first));
        }
    }
}

void pps_field_prepare_orders(pps_field *s, int n_orders) {
    for (int m = 0; m < n_orders; m++) {
        if (s->dom->order[m].n_series > 0) {
            ray_moments(s);
            return;
        }
    }
}

/* What the series of mode j give to the sources of a block of beams. */
static void add_series_mode(pps_field *s, const pps_order *order, size_t j,
                            size_t block, size_t n_block, const double *ge,
                            const double *go) {
    const pps_beams *beams = &s->dom->beams;
    const pps_solution *solution = &order->solution;
    double w = pps_dom_scaled_thickness(s->dom), one[PPS_LANES];
    double a[PPS_SERIES_TERMS * PPS_LANES], b[PPS_SERIES_TERMS * PPS_LANES];
    size_t at = j * beams->padded + block;
    for (int l = 0; l < PPS_LANES; l++) {
        one[l] = 1;
    }
    for (int down = 0; down < 2; down++) {
        size_t first = pps_field_slot(s, down), row = j * s->n_slots + first;
        pps_series series = {.n = n_block,
                             .q = beams->q + block,
                             .beam = down ? one : beams->decay + block,
                             .alpha = solution->source_a + at,
                             .beta = solution->source_b + at,
                             .psi = solution->edge_psi[!down] + at,
                             .phi = solution->edge_phi[!down] + at};
        pps_series_expand(&series, down ? w : -w, order->k[j], a, b);
        for (size_t l = 0; l < n_block; l++) {
            pps_series_source(down ? s->view->n_down : s->view->n_up, s->n_slots,
                              ge + row, go + row, a + l, b + l,
                              s->series + l * PPS_SERIES_TERMS * s->n_slots + first);
        }
    }
}

static void add_series(pps_field *s, const pps_order *order, const double *ge,
                       const double *go) {
    for (size_t b = 0; b < s->n_beams; b += PPS_LANES) {
        size_t n_block = s->n_beams - b < PPS_LANES ? s->n_beams - b : PPS_LANES;
        size_t size = PPS_SERIES_TERMS * s->n_slots;
        memset(s->series, 0, n_block * size * sizeof *s->series);
        for (size_t j = 0; j < (size_t)order->n_series; j++) {
            add_series_mode(s, order, j, s->first + b, n_block, ge, go);
        }
        for (size_t l = 0; l < n_block; l++) {
            for (size_t k = 0; k < s->at->n_tau; k++) {
                for (int down = 0; down < 2; down++) {
                    size_t first = pps_field_slot(s, down);
                    pps_series_rays(
                        down ? s->view->n_down : s->view->n_up, s->n_slots,
                        s->moment + PPS_SERIES_TERMS * (k * s->n_slots + first),
                        s->series + l * size + first,
                        s->term[0] + (b + l) * s->rays + k * s->n_slots + first);
                }
            }
        }
    }
}

/* A mode by itself, the scalar form. */
static void add_special_mode(pps_field *s, const pps_special *special, const double *ge,
                             const double *go, double *term) {
    const pps_mode *mode = &special->mode;
    for (size_t k = 0; k < s->at->n_tau; k++) {
        pps_mode_depth at = pps_mode_at(mode, s->tau[k]);
        for (size_t i = 0; i < s->n_slots; i++) {
            double psi, phi, sign = i < s->view->n_down ? 1 : -1;
            pps_ray ray;
            pps_ray_init(&ray, mode->w, mode->q, s->tau[k], sign * s->view->mu[i]);
            pps_mode_ray(mode, &ray, &at, &psi, &phi);
            size_t from = (size_t)special->j * s->n_slots + i;
            term[k * s->n_slots + i] += ge[from] * psi + go[from] * phi;
        }
    }
}

static void add_resonance(pps_field *s, const pps_special *special, const double *ge,
                          const double *go, double *term) {
    const pps_mode *mode = &special->mode;
    size_t b = special->beam - s->first, n_tau = s->at->n_tau;
    size_t row = (size_t)special->j * s->n_slots;
    const double *beam = s->beam + b * s->rays;
    for (size_t k = 0; k < n_tau; k++) {
        size_t at = k * s->n + (size_t)special->j;
        double eqt = s->decay[0][b * n_tau + k], eqx = s->decay[1][b * n_tau + k];
        pps_resonance here = {
            .k = mode->k,
            .q = mode->q,
            .p = mode->p,
            .theta = pps_exp1_known(s->tau[k], mode->k, mode->q, s->mode[0][at], eqt),
            .theta_on =
                pps_exp1_known(s->rest[k], mode->k, mode->q, s->mode[2][at], eqx),
            .ekx = s->mode[2][at],
            .root = s->mode[3][at],
            .eqt = eqt,
        };
        for (int down = 0; down < 2; down++) {
            size_t first = pps_field_slot(s, down), ray = k * s->n_slots + first;
            pps_run run = pps_field_run(s, k, down);
            pps_theta_rays(&run, &here, ge + row + first, go + row + first, beam + ray,
                           term + ray);
        }
    }
}

/* Modes and beam of an order, for beam b of the call. */
static void add_exponentials(pps_field *s, const pps_order *order, size_t b,
                             const double *ge, const double *go, double *term) {
    const pps_solution *solution = &order->solution;
    size_t padded = s->dom->beams.padded, column = s->first + b;
    size_t skip = (size_t)order->n_small, modes = s->n - skip;
    const double *c1 = solution->c1 + skip * padded + column;
    const double *c2 = solution->c2 + skip * padded + column;
    memset(s->source, 0, s->n_slots * sizeof *s->source);
    pps_rays_sum(s->n_slots, s->n, ge, go, solution->p + column, solution->r + column,
                 padded, s->source);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        size_t from = (k * s->n + skip) * s->n_slots;
        pps_rays_sum(s->n_slots, modes, s->row[0] + from, s->row[1] + from, c1, c2,
                     padded, term + k * s->n_slots);
        pps_rays_add_product(s->n_slots, s->source,
                             s->beam + b * s->rays + k * s->n_slots,
                             term + k * s->n_slots);
    }
}

/* The terms of one order, without the factor cos(m phi), for the beams still running. */
void pps_field_order_terms(pps_field *s, const pps_order *order) {
    const double *ge, *go;
    project(s, order, &ge, &go);
    mode_rows(s, order, ge, go);
    memset(s->term[0], 0, s->n_beams * s->rays * sizeof *s->term[0]);
    for (size_t b = 0; b < s->n_beams; b++) {
        if (pps_field_is_running(s, b)) {
            add_exponentials(s, order, b, ge, go, s->term[0] + b * s->rays);
        }
    }
    if (order->n_series > 0) {
        add_series(s, order, ge, go);
    }
    for (size_t i = 0; i < order->solution.n_special; i++) {
        const pps_special *special = &order->solution.special[i];
        if (special->beam < s->first || special->beam >= s->first + s->n_beams) {
            continue;
        }
        double *term = s->term[0] + (special->beam - s->first) * s->rays;
        if (special->mode.kind == PPS_MODE_RESONANT) {
            add_resonance(s, special, ge, go, term);
        } else {
            add_special_mode(s, special, ge, go, term);
        }
    }
}
