/* Radiance in any direction at any depth: the discrete solution gives the source, which
 * is integrated along the ray in closed form (never interpolated between nodes).
 *
 *   multiple scattering   sum over orders m of cos(m phi) times the ray integral of
 *                         ge.psi + go.phi (mu > 0) or ge.psi - go.phi (mu < 0)
 *   single scattering     albedo p(Theta) times the ray integral of the beam, with the
 *                         exact phase function; with delta-M that is the TMS correction
 *                         of NT88
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

#include "core/legendre.h"
#include "core/series.h"
#include "core/vector.h"
#include "solver/aureole.h"
#include "solver/dom.h"
#include "solver/rays.h"

static const double PI = 3.14159265358979323846;

/* What one call works with. Rows run over the slots of the view; `rays` = n_tau of them. */
typedef struct {
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
} field;

static void field_free(field *s) {
    free(s->memory);
    free(s->small_in_a_row);
    pps_view_free(s->own_view);
}

/* Lay the arrays out in memory (NULL: only count). */
static size_t field_layout(field *s, double *memory) {
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

static pps_status field_alloc(field *s) {
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

/* ---- what depends on depth and direction alone ---- */

static void place_depths(field *s) {
    double w = pps_dom_scaled_thickness(s->dom);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        s->tau[k] = s->at->tau[k] * s->dom->stretch;
        s->rest[k] = isinf(w) ? PPS_FAR : w - s->tau[k];
        for (size_t i = 0; i < s->n_slots; i++) {
            double t = i < s->view->n_down ? s->tau[k] : s->rest[k];
            s->ect[k * s->n_slots + i] = -t * s->view->c[i];
        }
    }
    for (size_t i = 0; i < s->rays; i++) {
        s->root[i] = s->ect[i] / 2;
    }
    pps_exp_array(s->rays, s->ect, s->ect);
    pps_exp_array(s->rays, s->root, s->root);
}

/* The rays of one sense through depth k. */
static pps_run run_at(const field *s, size_t k, bool down) {
    size_t first = down ? 0 : s->view->n_down, at = k * s->n_slots + first;
    return (pps_run){.n = down ? s->view->n_down : s->view->n_up,
                     .down = down,
                     .t = down ? s->tau[k] : s->rest[k],
                     .rest = down ? s->rest[k] : s->tau[k],
                     .c = s->view->c + first,
                     .ect = s->ect + at,
                     .root = s->root + at};
}

static size_t first_slot(const field *s, bool down) {
    return down ? 0 : s->view->n_down;
}

/* ---- single scattering, or the sky seen through ---- */

static void beam_integrals(field *s, size_t b) {
    double q = s->dom->beams.q[s->first + b];
    for (size_t k = 0; k < s->at->n_tau; k++) {
        double x[4] = {-q * s->tau[k], -q * s->rest[k]};
        x[2] = x[0] / 2;
        x[3] = x[1] / 2;
        pps_exp_array(4, x, x);
        for (int down = 0; down < 2; down++) {
            pps_run run = run_at(s, k, down);
            pps_beam_rays(&run, q, x[!down], x[2 + !down], x[down],
                          s->beam + b * s->rays + k * s->n_slots + first_slot(s, down));
        }
    }
}

/* albedo p of the scattering angle, in the directions of a row. */
PPS_CLONES static void exact_sources(size_t n, double factor, double g, double mu0,
                                     double cosine, const double *restrict mu,
                                     double sign, double *restrict source) {
    double sine0 = (1 - mu0) * (1 + mu0), size = fabs(g), side = g < 0 ? -1 : 1;
    double peak = (1 - size) * (1 - size), power = (1 - g) * (1 + g) / (4 * PI);
    for (size_t i = 0; i < n; i++) {
        double sines = sqrt(sine0 * (1 - mu[i]) * (1 + mu[i]));
        double x = mu0 * (sign * mu[i]) + sines * cosine;
        x = x > 1 ? 1 : x;
        x = x < -1 ? -1 : x;
        double base = peak + 2 * size * (1 - side * x);
        source[i] = factor * (power / (base * sqrt(base)));
    }
}

/* The exact p is albedo p / (1 - albedo f) per scaled optical depth (TMS); the plain
 * discrete problem has the sum of strength_l P_l(x), P_l(1) = 1. */
static void single_sources(const field *s, double mu0, double cosine, double *source) {
    const pps_dom *dom = s->dom;
    const pps_discrete *d = &dom->discrete;
    const double *mu = s->view->mu;
    size_t n_down = s->view->n_down;
    if (dom->corrected) {
        double factor = dom->slab.albedo / dom->stretch;
        exact_sources(n_down, factor, dom->slab.g, mu0, cosine, mu, 1, source);
        exact_sources(s->view->n_up, factor, dom->slab.g, mu0, cosine, mu + n_down, -1,
                      source + n_down);
        return;
    }
    for (size_t i = 0; i < s->n_slots; i++) {
        double sines = sqrt((1 - mu0) * (1 + mu0) * (1 - mu[i]) * (1 + mu[i]));
        double x = mu0 * (i < n_down ? mu[i] : -mu[i]) + sines * cosine;
        x = fmax(-1, fmin(1, x));
        source[i] = d->albedo / (4 * PI) *
                    pps_legendre_product(d->n_moments, d->strength, x, 1);
    }
}

/* value[k] = source * beam[k], rows at each depth. */
PPS_CLONES static void spread_source(size_t n_tau, size_t n,
                                     const double *restrict source,
                                     const double *restrict beam,
                                     double *restrict value) {
    for (size_t k = 0; k < n_tau; k++) {
        for (size_t i = 0; i < n; i++) {
            value[k * n + i] = source[i] * beam[k * n + i];
        }
    }
}

/* The ray integrals of the aureole of beam b, rows at each depth. */
static void aureole_integrals(field *s, size_t b) {
    size_t n = s->view->n_down;
    for (size_t k = 0; k < s->at->n_tau; k++) {
        pps_aureole_rays(s->dom, s->dom->beams.mu0[s->first + b], s->at->tau[k], n,
                         s->view->c, s->aureole + k * n);
    }
}

static void correct_aureole(field *s, double mu0, double cosine, double *value) {
    size_t n = s->view->n_down;
    pps_aureole_sources(s->dom, s->folded, mu0, cosine, n, s->view->mu, s->angles,
                        s->source);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        pps_rays_add_product(n, s->source, s->aureole + k * n, value + k * s->n_slots);
    }
}

static void first_light(field *s) {
    bool aureole = pps_aureole_matters(s->dom);
    if (aureole) {
        pps_aureole_fold(s->dom, s->folded);
    }
    const pps_beams *beams = &s->dom->beams;
    for (size_t i = 0; i < s->at->n_phi; i++) {
        s->angle[i] = remainder(s->at->phi[i], 360);
        s->cosine[i] = pps_cos_degrees(s->angle[i]);
    }
    for (size_t b = 0; b < s->n_beams; b++) {
        double *value = s->value + b * s->at->n_phi * s->rays;
        beam_integrals(s, b);
        if (aureole) {
            aureole_integrals(s, b);
        }
        for (size_t i = 0; i < s->at->n_phi; i++, value += s->rays) {
            if (beams->sky) {
                for (size_t ray = 0; ray < s->rays; ray++) {
                    bool down = ray % s->n_slots < s->view->n_down;
                    value[ray] = down ? s->ect[ray] : 0;
                }
            } else {
                double mu0 = beams->mu0[s->first + b];
                single_sources(s, mu0, s->cosine[i], s->source);
                spread_source(s->at->n_tau, s->n_slots, s->source,
                              s->beam + b * s->rays, value);
                if (aureole) {
                    correct_aureole(s, mu0, s->cosine[i], value);
                }
            }
        }
    }
}

/* ---- multiple scattering ---- */

/* The projections of an order: kept by the view, or made now. */
static void project(field *s, const pps_order *order, const double **ge,
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
PPS_CLONES static void mode_exponentials(field *s, const pps_order *order) {
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
static void mode_rows(field *s, const pps_order *order, const double *ge,
                      const double *go) {
    mode_exponentials(s, order);
    pps_mode_view view = {s->near, s->near_over, s->far, s->far_over};
    for (size_t j = (size_t)order->n_small; j < s->n; j++) {
        for (int down = 0; down < 2; down++) {
            size_t first = first_slot(s, down), row = j * s->n_slots + first;
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

static void ray_moments(field *s) {
    double w = pps_dom_scaled_thickness(s->dom);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        for (int down = 0; down < 2; down++) {
            pps_run run = run_at(s, k, down);
            size_t first = first_slot(s, down);
            pps_series_moments(run.n, w, run.t, run.c, run.ect, run.root,
                               s->moment + PPS_SERIES_TERMS * (k * s->n_slots + first));
        }
    }
}

/* What the series of mode j give to the sources of a block of beams. */
static void add_series_mode(field *s, const pps_order *order, size_t j, size_t block,
                            size_t n_block, const double *ge, const double *go) {
    const pps_beams *beams = &s->dom->beams;
    const pps_solution *solution = &order->solution;
    double w = pps_dom_scaled_thickness(s->dom), one[PPS_LANES];
    double a[PPS_SERIES_TERMS * PPS_LANES], b[PPS_SERIES_TERMS * PPS_LANES];
    size_t at = j * beams->padded + block;
    for (int l = 0; l < PPS_LANES; l++) {
        one[l] = 1;
    }
    for (int down = 0; down < 2; down++) {
        size_t first = first_slot(s, down), row = j * s->n_slots + first;
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

static void add_series(field *s, const pps_order *order, const double *ge,
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
                    size_t first = first_slot(s, down);
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
static void add_special_mode(field *s, const pps_special *special, const double *ge,
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

static void add_resonance(field *s, const pps_special *special, const double *ge,
                          const double *go, double *term) {
    const pps_mode *mode = &special->mode;
    size_t row = (size_t)special->j * s->n_slots;
    const double *beam = s->beam + (special->beam - s->first) * s->rays;
    for (size_t k = 0; k < s->at->n_tau; k++) {
        for (int down = 0; down < 2; down++) {
            size_t first = first_slot(s, down);
            pps_run run = run_at(s, k, down);
            pps_theta_rays(&run, mode->k, mode->q, mode->p, ge + row + first,
                           go + row + first, beam + k * s->n_slots + first,
                           term + k * s->n_slots + first);
        }
    }
}

static bool is_running(const field *s, size_t b) { return s->small_in_a_row[b] < 2; }

/* Modes and beam of an order, for beam b of the call. */
static void add_exponentials(field *s, const pps_order *order, size_t b,
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
static void order_terms(field *s, const pps_order *order) {
    const double *ge, *go;
    project(s, order, &ge, &go);
    mode_rows(s, order, ge, go);
    memset(s->term[0], 0, s->n_beams * s->rays * sizeof *s->term[0]);
    for (size_t b = 0; b < s->n_beams; b++) {
        if (is_running(s, b)) {
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

/* Adds the terms; counts the orders in a row that are below the tolerance everywhere.
 * The last terms of a beam that has ended are kept for azimuth_rest. */
static void add_order(field *s, int m) {
    const pps_grid *at = s->at;
    for (size_t i = 0; i < at->n_phi; i++) {
        s->cosine[i] = pps_cos_degrees(m * s->angle[i]);
    }
    for (size_t b = 0; b < s->n_beams; b++) {
        if (is_running(s, b)) {
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
static double azimuth_rest(const field *s, size_t b) {
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
static void write_out(const field *s, double *restrict radiance) {
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

static bool any_running(const field *s) {
    for (size_t b = 0; b < s->n_beams; b++) {
        if (is_running(s, b)) {
            return true;
        }
    }
    return false;
}

static void sum_orders(field *s, int n_orders, double *rest) {
    const pps_dom *dom = s->dom;
    place_depths(s);
    first_light(s);
    for (int m = 0; m < n_orders; m++) {
        if (dom->order[m].n_series > 0) {
            ray_moments(s);
            break;
        }
    }
    memset(s->term[0], 0, s->n_beams * s->rays * sizeof *s->term[0]);
    for (int m = 0; m < n_orders && any_running(s); m++) {
        double *swap = s->term[1];
        s->term[1] = s->term[0];
        s->term[0] = swap;
        order_terms(s, &dom->order[m]);
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
        field s = {.dom = dom,
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
