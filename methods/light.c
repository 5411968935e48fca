/* Beam, sky and ground together, by superposition of black-ground solutions.
 *
 * The slab is solved for a beam of 1 and for an isotropic sky of 1. Light from a
 * Lambertian ground is sky light seen from below: depth tau and direction mu of one are
 * w - tau and -mu of the other. With E the flux that beam and sky send down to a black
 * ground and S the flux that a radiance of 1 from the ground brings back to it, a ground
 * of reflectance A shines with the radiance
 *     L = (A/pi) (E + S L) = (A/pi) E / (1 - A S/pi).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "methods/light.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

static bool has_ground(const pps_lit *lit) {
    return lit->light.ground > 0 && isfinite(lit->thickness);
}

static pps_status solve_beam(const pps_lit *lit) {
    return lit->ops->solve(lit->state, lit->thickness, lit->mu0);
}

static pps_status solve_sky(const pps_lit *lit) {
    return lit->ops->solve_sky(lit->state, lit->thickness);
}

/* L, the radiance of the ground. Leaves the state solved for the sky. */
static pps_status ground_radiance(const pps_lit *lit, double *radiance) {
    double edges[2] = {0, lit->thickness}, falls = 0;
    pps_flux flux[2];
    pps_status status = PPS_OK;
    if (lit->light.beam > 0) {
        status = solve_beam(lit);
        if (!status) {
            status = lit->ops->flux(lit->state, 1, &lit->thickness, flux);
        }
        falls = lit->light.beam * (flux[0].down + flux[0].direct);
    }
    if (!status) {
        status = solve_sky(lit);
    }
    if (!status) {
        status = lit->ops->flux(lit->state, 2, edges, flux);
    }
    if (status) {
        return status;
    }
    falls += lit->light.sky * flux[1].down;
    double share = lit->light.ground / PI;
    *radiance = share * falls / (1 - share * flux[0].up);
    return PPS_OK;
}

/* sum += factor * part over n numbers. */
static void add(size_t n, double factor, const double *part, double *sum) {
    for (size_t i = 0; i < n; i++) {
        sum[i] += factor * part[i];
    }
}

/* The grid upside down, for light from below; memory is n_tau + n_mu doubles. */
static pps_grid flipped(const pps_lit *lit, const pps_grid *at, double *memory) {
    double *tau = memory, *mu = memory + at->n_tau;
    for (size_t k = 0; k < at->n_tau; k++) {
        tau[k] = lit->thickness - at->tau[k];
    }
    for (size_t j = 0; j < at->n_mu; j++) {
        mu[j] = -at->mu[j];
    }
    return (pps_grid){at->n_tau, at->n_mu, at->n_phi, tau, mu, at->phi};
}

pps_status pps_lit_radiance(const pps_lit *lit, const pps_grid *at, double *radiance) {
    size_t n = at->n_tau * at->n_mu * at->n_phi;
    double *part = malloc((n + at->n_tau + at->n_mu + 1) * sizeof *part), ground = 0;
    if (!part) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        radiance[i] = 0;
    }
    pps_status status = has_ground(lit) ? ground_radiance(lit, &ground) : PPS_OK;
    if (!status && lit->light.beam > 0) {
        status = solve_beam(lit);
        if (!status && !(status = lit->ops->radiance(lit->state, at, part))) {
            add(n, lit->light.beam, part, radiance);
        }
    }
    if (!status && (lit->light.sky > 0 || ground > 0)) {
        status = solve_sky(lit);
    }
    if (!status && lit->light.sky > 0 &&
        !(status = lit->ops->radiance(lit->state, at, part))) {
        add(n, lit->light.sky, part, radiance);
    }
    if (!status && ground > 0) {
        pps_grid below = flipped(lit, at, part + n);
        if (!(status = lit->ops->radiance(lit->state, &below, part))) {
            add(n, ground, part, radiance);
        }
    }
    free(part);
    return status;
}

/* Adds factor times the fluxes; from below, up and down change places. */
static void add_flux(size_t n, double factor, bool below, const pps_flux *part,
                     pps_flux *sum) {
    for (size_t i = 0; i < n; i++) {
        sum[i].up += factor * (below ? part[i].down : part[i].up);
        sum[i].down += factor * (below ? part[i].up : part[i].down);
        sum[i].direct += factor * part[i].direct;
        sum[i].mean_diffuse += factor * part[i].mean_diffuse;
        sum[i].mean += factor * part[i].mean;
    }
}

pps_status pps_lit_flux(const pps_lit *lit, size_t n, const double *tau,
                        pps_flux *flux) {
    pps_flux *part = malloc((n + 1) * sizeof *part);
    double *below = malloc((n + 1) * sizeof *below), ground = 0;
    pps_status status = part && below ? PPS_OK : PPS_ERR_MEMORY;
    for (size_t i = 0; !status && i < n; i++) {
        flux[i] = (pps_flux){0};
        below[i] = lit->thickness - tau[i];
    }
    if (!status && has_ground(lit)) {
        status = ground_radiance(lit, &ground);
    }
    if (!status && lit->light.beam > 0) {
        status = solve_beam(lit);
        if (!status && !(status = lit->ops->flux(lit->state, n, tau, part))) {
            add_flux(n, lit->light.beam, false, part, flux);
        }
    }
    if (!status && (lit->light.sky > 0 || ground > 0)) {
        status = solve_sky(lit);
    }
    if (!status && lit->light.sky > 0 &&
        !(status = lit->ops->flux(lit->state, n, tau, part))) {
        add_flux(n, lit->light.sky, false, part, flux);
    }
    if (!status && ground > 0 &&
        !(status = lit->ops->flux(lit->state, n, below, part))) {
        add_flux(n, ground, true, part, flux);
    }
    free(part);
    free(below);
    return status;
}
