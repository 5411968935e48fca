/* Light scattered once, with the exact phase function: albedo p(Theta) times the ray
 * integral of the beam; with delta-M that is the TMS correction of NT88. And what must be
 * added for light that the forward peak scatters twice (aureole.h).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/phase.h>

#include "core/legendre.h"
#include "core/phase.h"
#include "core/vector.h"
#include "solver/aureole.h"
#include "solver/field.h"

static const double PI = 3.14159265358979323846;

static void beam_integrals(pps_field *s, size_t b) {
    double q = s->dom->beams.q[s->first + b];
    double *above = s->decay[0] + b * s->at->n_tau,
           *below = s->decay[1] + b * s->at->n_tau;
    for (size_t k = 0; k < s->at->n_tau; k++) {
        double x[4] = {-q * s->tau[k], -q * s->rest[k]};
        x[2] = x[0] / 2;
        x[3] = x[1] / 2;
        pps_exp_array(4, x, x);
        above[k] = x[0];
        below[k] = x[1];
        for (int down = 0; down < 2; down++) {
            pps_run run = pps_field_run(s, k, down);
            pps_beam_rays(&run, q, x[!down], x[2 + !down], x[down],
                          s->beam + b * s->rays + k * s->n_slots +
                              pps_field_slot(s, down));
        }
    }
}

/* albedo p of the scattering angle, in the directions of a row. */
PPS_CLONES static void exact_sources(size_t n, double factor, double g, double mu0,
                                     double cosine, const double *restrict mu,
                                     double sign, double *restrict source) {
    double sine0 = (1 - mu0) * (1 + mu0), power = (1 - g) * (1 + g) / (4 * PI);
    for (size_t i = 0; i < n; i++) {
        double sines = sqrt(sine0 * (1 - mu[i]) * (1 + mu[i]));
        double x = mu0 * (sign * mu[i]) + sines * cosine;
        x = x > 1 ? 1 : x;
        x = x < -1 ? -1 : x;
        source[i] = factor * (power / pps_hg_over(g, x));
    }
}

/* The exact p is albedo p / (1 - albedo f) per scaled optical depth (TMS); the plain
 * discrete problem has the sum of strength_l P_l(x), P_l(1) = 1. */
static void single_sources(const pps_field *s, double mu0, double cosine,
                           double *source) {
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
static void aureole_integrals(pps_field *s, size_t b) {
    size_t n = s->view->n_down;
    for (size_t k = 0; k < s->at->n_tau; k++) {
        pps_aureole_rays(s->dom, s->dom->beams.mu0[s->first + b], s->at->tau[k], n,
                         s->view->c, s->aureole + k * n);
    }
}

static void correct_aureole(pps_field *s, double mu0, double cosine, double *value) {
    size_t n = s->view->n_down;
    pps_aureole_sources(s->dom, s->folded, mu0, cosine, n, s->view->mu, s->angles,
                        s->source);
    for (size_t k = 0; k < s->at->n_tau; k++) {
        pps_rays_add_product(n, s->source, s->aureole + k * n, value + k * s->n_slots);
    }
}

void pps_field_first_light(pps_field *s) {
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
