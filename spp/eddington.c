/* The method "eddington": Eddington two-stream fluxes as the source, marched along the
 * ray.
 *
 * gamma1 = (7 - albedo (4 + 3g))/4, gamma2 = -(1 - albedo (4 - 3g))/4,
 * gamma3 = (2 - 3 g mu0)/4 (MW80, Table 1), so that e = 2 (1 - albedo),
 * f = 3/2 (1 - albedo g). The radiance in the source is I0 + I1 mu with
 * I0 = (F+ + F-)/(2 pi), I1 = 3 (F+ - F-)/(4 pi); one scattering makes it I0 + g I1 mu.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/method.h"
#include "spp/march.h"
#include "spp/twostream.h"

static const double PI = 3.14159265358979323846;

typedef struct {
    pps_slab slab;
    double mu0;
    bool sky;
    pps_twostream two;
} eddington;

static pps_status eddington_init(void *state, const pps_slab *slab,
                                 const pps_options *opts) {
    (void)opts;
    ((eddington *)state)->slab = *slab;
    return PPS_OK;
}

static pps_status eddington_solve(void *state, double thickness, double mu0) {
    eddington *d = state;
    double albedo = d->slab.albedo, g = d->slab.g;
    d->slab.thickness = thickness;
    d->mu0 = mu0;
    d->sky = false;
    pps_twostream_solve(&d->two, thickness, mu0, 2 * (1 - albedo),
                        1.5 * (1 - albedo * g), albedo, 1.5 * albedo * g * mu0);
    return PPS_OK;
}

static pps_status eddington_solve_sky(void *state, double thickness) {
    eddington *d = state;
    double albedo = d->slab.albedo;
    d->slab.thickness = thickness;
    d->mu0 = 1;
    d->sky = true;
    pps_twostream_solve_sky(&d->two, thickness, 2 * (1 - albedo),
                            1.5 * (1 - albedo * d->slab.g));
    return PPS_OK;
}

static void terms(const void *solution, const pps_ray *ray, double term[2]) {
    const eddington *d = solution;
    pps_twostream_ray(&d->two, ray, &term[0], &term[1]);
}

/* Of the sum of the fluxes and of their difference. */
static void shares(const void *solution, double mu, double share[2]) {
    const eddington *d = solution;
    share[0] = 1 / (2 * PI);
    share[1] = 3 * d->slab.g * mu / (4 * PI);
}

static pps_status eddington_radiance(void *state, const pps_grid *at,
                                     double *radiance) {
    const eddington *d = state;
    pps_march march = {.slab = d->slab,
                       .mu0 = d->mu0,
                       .shares = shares,
                       .terms = terms,
                       .solution = d,
                       .sky = d->sky};
    pps_march_radiance(&march, at, radiance);
    return PPS_OK;
}

static pps_status eddington_flux(void *state, size_t n, const double *tau,
                                 pps_flux *flux) {
    const eddington *d = state;
    for (size_t i = 0; i < n; i++) {
        flux[i] = pps_twostream_flux(&d->two, tau[i]);
    }
    return PPS_OK;
}

static const pps_method_ops ops = {.state_size = sizeof(eddington),
                                   .init = eddington_init,
                                   .solve = eddington_solve,
                                   .solve_sky = eddington_solve_sky,
                                   .radiance = eddington_radiance,
                                   .flux = eddington_flux};

const pps_method pps_method_eddington = {
    .name = "eddington",
    .cost = "about ten exponentials a direction",
    .summary = "Eddington two-stream source marched along the ray",
    .limits = "4-6 % for |g| <= 0.5 in thick slabs; 35 % at g = 0.8; fluxes are the "
              "two-stream's own, reflectance within 0.16 of what falls in; both may be "
              "negative in thin forward-scattering slabs",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &ops,
};
