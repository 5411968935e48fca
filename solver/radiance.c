/* Radiance in any direction at any depth: the discrete solution gives the source, which
 * is integrated along the ray in closed form (never interpolated between nodes).
 *
 *   multiple scattering   sum over orders m of cos(m phi) times the ray integral of
 *                         ge.psi + go.phi (mu > 0) or ge.psi - go.phi (mu < 0)
 *   single scattering     albedo p(Theta) times the ray integral of the beam, with the
 *                         exact phase function; with delta-M that is the TMS correction
 *                         of NT88
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include <ppscat/phase.h>

#include "core/legendre.h"
#include "solver/dom.h"

static const double PI = 3.14159265358979323846;

/* The sum over modes of one order along one ray. */
static double ray_sum(const pps_order *order, const pps_ray *ray,
                      const pps_mode_depth *at, const double *ge, const double *go) {
    double even = 0, odd = 0;
    for (int j = 0; j < order->n; j++) {
        double psi, phi;
        pps_mode_ray(&order->mode[j], ray, &at[j], &psi, &phi);
        even += ge[j] * psi;
        odd += go[j] * phi;
    }
    return ray->down ? even + odd : even - odd;
}

/* What comes through of an isotropic radiance of 1 from above. */
static double sky_uncollided(const pps_ray *ray) { return ray->down ? ray->ect : 0; }

double pps_dom_mean_radiance(const pps_dom *dom, double tau, double mu) {
    const pps_discrete *d = &dom->discrete;
    const pps_order *order = &dom->order[0];
    pps_mode_depth at[PPS_STREAMS_MAX / 2];
    double ge[PPS_STREAMS_MAX / 2], go[PPS_STREAMS_MAX / 2];
    double legendre[PPS_STREAMS_MAX];
    pps_ray ray;
    pps_ray_init(&ray, dom->slab.thickness * dom->stretch, 1 / dom->mu0, tau, mu);
    for (int j = 0; j < order->n; j++) {
        at[j] = pps_mode_at(&order->mode[j], tau);
    }
    pps_order_project(order, d, mu, ge, go, legendre);
    double rest = dom->sky ? sky_uncollided(&ray)
                           : pps_discrete_single(d, mu, dom->mu0) * ray.beam;
    return ray_sum(order, &ray, at, ge, go) + rest;
}

/* albedo p of the scattering angle, as single scattering takes it. The exact p is
 * albedo p / (1 - albedo f) per scaled optical depth (TMS). */
static double single_source(const pps_dom *dom, double mu, double phi) {
    const pps_discrete *d = &dom->discrete;
    double x = pps_cos_scattering(dom->mu0, mu, phi);
    if (dom->corrected) {
        return dom->slab.albedo / dom->stretch * pps_hg(dom->slab.g, x);
    }
    /* The plain discrete problem: sum of strength_l P_l(x), P_l(1) = 1. */
    return d->albedo / (4 * PI) * pps_legendre_product(d->n_moments, d->strength, x, 1);
}

/* What one call of pps_dom_radiance works with, in one block. */
typedef struct {
    const pps_grid *at;
    pps_ray *ray;             /* n_tau x n_mu */
    pps_mode_depth *depth;    /* n_tau x n */
    double *ge, *go;          /* n_mu x n */
    double *legendre;         /* n_moments */
    double *term, *last_term; /* n_tau x n_mu: what order m, m - 1 adds */
    void *memory[4];
} field_scratch;

static void scratch_free(field_scratch *s) {
    for (int i = 0; i < 4; i++) {
        free(s->memory[i]);
    }
}

static pps_status scratch_alloc(field_scratch *s, const pps_dom *dom,
                                const pps_grid *at) {
    size_t n = (size_t)dom->discrete.n, rays = at->n_tau * at->n_mu;
    *s = (field_scratch){.at = at};
    s->memory[0] = s->ray = malloc((rays + 1) * sizeof *s->ray);
    s->memory[1] = s->depth = malloc((at->n_tau * n + 1) * sizeof *s->depth);
    s->memory[2] = s->ge =
        malloc((2 * at->n_mu * n + (size_t)dom->discrete.n_moments) * sizeof *s->ge);
    s->memory[3] = s->term = calloc(2 * rays + 1, sizeof *s->term);
    for (int i = 0; i < 4; i++) {
        if (!s->memory[i]) {
            scratch_free(s);
            return PPS_ERR_MEMORY;
        }
    }
    s->go = s->ge + at->n_mu * n;
    s->legendre = s->go + at->n_mu * n;
    s->last_term = s->term + rays;
    return PPS_OK;
}

/* Everything but multiple scattering: single scattering, or the sky seen through. */
static void first_light(const pps_dom *dom, field_scratch *s, double *radiance) {
    const pps_grid *at = s->at;
    double w = dom->slab.thickness * dom->stretch, q = 1 / dom->mu0;
    for (size_t k = 0; k < at->n_tau; k++) {
        for (size_t j = 0; j < at->n_mu; j++) {
            pps_ray_init(&s->ray[k * at->n_mu + j], w, q, at->tau[k] * dom->stretch,
                         at->mu[j]);
        }
    }
    for (size_t j = 0; j < at->n_mu; j++) {
        for (size_t i = 0; i < at->n_phi; i++) {
            double source = dom->sky ? 0 : single_source(dom, at->mu[j], at->phi[i]);
            for (size_t k = 0; k < at->n_tau; k++) {
                size_t ray = k * at->n_mu + j;
                radiance[ray * at->n_phi + i] =
                    dom->sky ? sky_uncollided(&s->ray[ray]) : source * s->ray[ray].beam;
            }
        }
    }
}

/* The terms of one order: term[k * n_mu + j], without the factor cos(m phi). */
static void order_terms(const pps_dom *dom, const pps_order *order, field_scratch *s) {
    const pps_grid *at = s->at;
    size_t n = (size_t)order->n;
    for (size_t j = 0; j < at->n_mu; j++) {
        pps_order_project(order, &dom->discrete, at->mu[j], s->ge + j * n,
                          s->go + j * n, s->legendre);
    }
    for (size_t k = 0; k < at->n_tau; k++) {
        double tau = at->tau[k] * dom->stretch;
        pps_mode_depth *depth = s->depth + k * n;
        for (size_t i = 0; i < n; i++) {
            depth[i] = pps_mode_at(&order->mode[i], tau);
        }
        for (size_t j = 0; j < at->n_mu; j++) {
            size_t ray = k * at->n_mu + j;
            s->term[ray] =
                ray_sum(order, &s->ray[ray], depth, s->ge + j * n, s->go + j * n);
        }
    }
}

/* Adds an order; true where it is below the tolerance everywhere. */
static bool add_order(const pps_dom *dom, int m, field_scratch *s, double *radiance) {
    const pps_grid *at = s->at;
    bool small = true;
    for (size_t i = 0; i < at->n_phi; i++) {
        double angle = remainder(at->phi[i], 360);
        double cosine = pps_cos_degrees(m * angle);
        for (size_t ray = 0; ray < at->n_tau * at->n_mu; ray++) {
            double *value = &radiance[ray * at->n_phi + i];
            *value += cosine * s->term[ray];
            small = small && fabs(s->term[ray]) <= dom->tolerance * fabs(*value);
        }
    }
    return small;
}

/* The last two terms against the values they went into, small values against 1e-3 of the
 * largest. */
static double azimuth_rest(const field_scratch *s, const double *radiance) {
    size_t n_phi = s->at->n_phi, rays = s->at->n_tau * s->at->n_mu;
    double largest = 0, rest = 0;
    for (size_t i = 0; i < rays * n_phi; i++) {
        largest = fmax(largest, fabs(radiance[i]));
    }
    for (size_t i = 0; i < rays * n_phi; i++) {
        size_t ray = i / n_phi;
        double last = fabs(s->term[ray]) + fabs(s->last_term[ray]);
        if (last > 0) {
            rest = fmax(rest, last / fmax(fabs(radiance[i]), 1e-3 * largest));
        }
    }
    return rest;
}

pps_status pps_dom_radiance_orders(const pps_dom *dom, int n_orders, const pps_grid *at,
                                   double *radiance, double *rest) {
    if (!(dom->mu0 > 0) || !radiance || pps_grid_check(at, dom->slab.thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    field_scratch s;
    pps_status status = scratch_alloc(&s, dom, at);
    if (status) {
        return status;
    }
    first_light(dom, &s, radiance);
    int small_in_a_row = 0, m = 0;
    bool no_azimuth = dom->sky || dom->mu0 == 1; /* nothing depends on it */
    n_orders = no_azimuth ? 1 : n_orders;
    for (; m < n_orders && small_in_a_row < 2; m++) {
        double *swap = s.last_term;
        s.last_term = s.term;
        s.term = swap;
        order_terms(dom, &dom->order[m], &s);
        small_in_a_row = add_order(dom, m, &s, radiance) ? small_in_a_row + 1 : 0;
    }
    bool complete = m == dom->discrete.n_moments || dom->slab.g == 0 || no_azimuth;
    *rest = complete ? 0 : azimuth_rest(&s, radiance);
    scratch_free(&s);
    return PPS_OK;
}

pps_status pps_dom_radiance(const pps_dom *dom, const pps_grid *at, double *radiance) {
    double rest;
    return pps_dom_radiance_orders(dom, dom->n_orders, at, radiance, &rest);
}
