/* The method "hemispheric": SPP's two uniform hemispheres with the right mean cosine.
 *
 * SPP lets diffuse light run along |cos| = mu0 like the beam, and reads fluxes as fluence.
 * Here it runs along |cos| = 1/2, the mean over a uniform hemisphere, while the beam keeps
 * mu0: e = 2 (1 - albedo), f = 2 (1 - delta), delta = albedo (T - R), T and R of SPP
 * Eq. 10 at mu0. Same cost and as independent of the view as SPP.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/phase.h>

#include "core/hemisphere.h"
#include "core/method.h"
#include "spp/twostream.h"

static const double PI = 3.14159265358979323846;

typedef struct {
    pps_slab slab;
    pps_twostream two;
} hemispheric;

static pps_status hemispheric_init(void *state, const pps_slab *slab,
                                   const pps_options *opts) {
    (void)opts;
    ((hemispheric *)state)->slab = *slab;
    return PPS_OK;
}

void pps_hemispheric_solve(pps_twostream *two, const pps_slab *slab, double mu0) {
    double albedo = slab->albedo, backward = pps_hg_backward(slab->g, mu0);
    double e = 2 * (1 - albedo), f = e + 4 * albedo * backward;
    pps_twostream_solve(two, slab->thickness, mu0, e, f, albedo,
                        albedo * (1 - 2 * backward));
}

static pps_status hemispheric_solve(void *state, double thickness, double mu0) {
    hemispheric *h = state;
    pps_slab slab = {h->slab.albedo, h->slab.g, thickness};
    pps_hemispheric_solve(&h->two, &slab, mu0);
    return PPS_OK;
}

static pps_status hemispheric_solve_sky(void *state, double thickness) {
    hemispheric *h = state;
    double albedo = h->slab.albedo, backward = pps_hg_backward_diffuse(h->slab.g);
    double e = 2 * (1 - albedo), f = e + 4 * albedo * backward;
    pps_twostream_solve_sky(&h->two, thickness, e, f);
    return PPS_OK;
}

static pps_status hemispheric_radiance(void *state, const pps_grid *at,
                                       double *radiance) {
    const hemispheric *h = state;
    for (size_t k = 0; k < at->n_tau; k++) {
        pps_flux flux = pps_twostream_flux(&h->two, at->tau[k]);
        for (size_t j = 0; j < at->n_mu; j++) {
            for (size_t i = 0; i < at->n_phi; i++) {
                *radiance++ = (at->mu[j] > 0 ? flux.down : flux.up) / PI;
            }
        }
    }
    return PPS_OK;
}

static pps_status hemispheric_flux(void *state, size_t n, const double *tau,
                                   pps_flux *flux) {
    const hemispheric *h = state;
    for (size_t i = 0; i < n; i++) {
        flux[i] = pps_twostream_flux(&h->two, tau[i]);
    }
    return PPS_OK;
}

static const pps_method_ops ops = {.state_size = sizeof(hemispheric),
                                   .init = hemispheric_init,
                                   .solve = hemispheric_solve,
                                   .solve_sky = hemispheric_solve_sky,
                                   .radiance = hemispheric_radiance,
                                   .flux = hemispheric_flux};

const pps_method pps_method_hemispheric = {
    .name = "hemispheric",
    .cost = "three exponentials a depth",
    .summary = "SPP's hemispheres with mean cosine 1/2 for diffuse light",
    .limits = "same radiance in every direction of a hemisphere; fluence to 3-11 %; "
              "reflectance within 0.1 of what falls in",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &ops,
};
