/* The simplified plane-parallel model (SPP), in the form that holds everywhere.
 *
 *   T, R     forward, backward    Eq. 10, with the factor 2 pi that T + R = 1 needs
 *   lambda                        Eq. 17
 *   rho      1/alpha, Eq. 17, written so that it is 0 at albedo 0 and 1 at albedo 1
 *   kappa    c2 = -kappa times the incident light, Eq. 20
 *   s(x)     E1(x; 0, 2 lambda) = (1 - e^(-2 lambda x)) / (2 lambda)
 *
 * Eqs. 19 and 22 are quotients of nothing by nothing at albedo 1, and overflow in thick
 * slabs. With B = mu0/(1 - albedo T + lambda mu0), Den = B + rho^2 s(w) they become
 *   D(tau) = kappa { e^(-lambda tau) [B + rho^2 s(w - tau)]/Den - e^(-q tau) },
 *   U(tau) = kappa rho e^(-lambda tau) s(w - tau)/Den.
 * Near the lit side the two terms of D cancel; there
 *   D(tau) = kappa { (q - lambda) E1(tau; lambda, q)
 *                    - rho^2 e^(-lambda (2w - tau)) s(tau)/Den }.
 * Misprints mended (tests/test_spp.c decides): Eq. 19's third term is
 * c3 (U+ + alpha U-) e^(+lambda tau); the beam decays as e^(-tau/mu0); c3 has the
 * opposite sign; kappa = 1 (as printed, 1/T).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/expdiff.h>
#include <ppscat/phase.h>
#include <ppscat/spp.h>

#include "core/hemisphere.h"
#include "core/method.h"
#include "spp/spp.h"

static const double PI = 3.14159265358979323846;

/* Solve for light of cosine mu0, the share `backward` of which is scattered back. */
static pps_status init(pps_spp *spp, const pps_slab *slab, double mu0, double backward,
                       pps_spp_kappa kappa) {
    double albedo = slab->albedo, co_albedo = 1 - albedo, q = 1 / mu0;
    double forward = 1 - backward;
    double one_minus_delta = co_albedo + 2 * albedo * backward;
    double root = sqrt(one_minus_delta * co_albedo); /* lambda mu0 */
    double gamma = co_albedo + albedo * backward;    /* 1 - albedo T */
    *spp = (pps_spp){
        .thickness = slab->thickness,
        .q = q,
        .albedo = albedo,
        .lambda = q * root,
        .forward = forward,
        .backward = backward,
        .rho = albedo * backward / (gamma + root),
        .kappa = kappa == PPS_SPP_PRINTED ? 1 / forward : 1,
        .b = mu0 / (gamma + root),
        /* 1 - root without cancellation: 1 - root^2 = albedo (1 + (T - R)(1 - albedo)) */
        .q_minus_lambda =
            q * albedo * (1 + (1 - 2 * backward) * co_albedo) / (1 + root),
    };
    if (isinf(slab->thickness) && spp->lambda == 0) {
        spp->den = INFINITY;
    } else {
        spp->den = spp->b +
                   spp->rho * spp->rho * pps_exp1(slab->thickness, 0, 2 * spp->lambda);
    }
    return isfinite(spp->kappa) ? PPS_OK : PPS_ERR_UNSUPPORTED;
}

pps_status pps_spp_init(pps_spp *spp, const pps_slab *slab, double mu0,
                        pps_spp_kappa kappa) {
    if (pps_slab_check(slab) || pps_mu0_check(mu0)) {
        return PPS_ERR_ARGUMENT;
    }
    return init(spp, slab, mu0, pps_hg_backward(slab->g, mu0), kappa);
}

pps_status pps_spp_init_sky(spp_state *state, double thickness, pps_spp_kappa kappa) {
    state->slab.thickness = thickness;
    state->sky = true;
    return init(&state->spp, &state->slab, 0.5, pps_hg_backward_diffuse(state->slab.g),
                kappa);
}

bool pps_spp_near_top(const pps_spp *spp, double tau) {
    return spp->q * tau < 1 || spp->lambda > spp->q / 2;
}

/* rho s(w - tau)/Den: U without kappa e^(-lambda tau). Conservative half-space: 1. */
static double up_share(const pps_spp *spp, double tau) {
    if (isinf(spp->den)) {
        return 1 / spp->rho;
    }
    return spp->rho * pps_exp1(spp->thickness - tau, 0, 2 * spp->lambda) / spp->den;
}

double pps_spp_down(const pps_spp *spp, double tau) {
    double lambda = spp->lambda, q = spp->q, rho = spp->rho, w = spp->thickness;
    if (pps_spp_near_top(spp, tau)) {
        double reflected =
            isinf(w) ? 0 : exp(-lambda * (2 * w - tau)) * pps_exp1(tau, 0, 2 * lambda);
        return spp->kappa * (spp->q_minus_lambda * pps_exp1(tau, lambda, q) -
                             rho * rho * reflected / spp->den);
    }
    return spp->kappa *
           (exp(-lambda * tau) * (spp->b / spp->den + rho * up_share(spp, tau)) -
            exp(-q * tau));
}

double pps_spp_up(const pps_spp *spp, double tau) {
    return spp->kappa * exp(-spp->lambda * tau) * up_share(spp, tau);
}

/* As a method: radiance D/(2 pi) down and U/(2 pi) up. */

/* D without the beam, or with it where it is sky light and so diffuse. */
static void amplitudes(const spp_state *s, double tau, double *down, double *up) {
    *down = pps_spp_down(&s->spp, tau);
    *up = pps_spp_up(&s->spp, tau);
    if (s->sky) {
        *down = 2 * PI * (*down + exp(-s->spp.q * tau));
        *up *= 2 * PI;
    }
}

static pps_flux flux_at(const spp_state *s, double tau) {
    double d, u, mu0 = 1 / s->spp.q, beam = s->sky ? 0 : exp(-tau * s->spp.q);
    amplitudes(s, tau, &d, &u);
    /* Every direction has |cos| = mu0 in this model, so that mu0 D and mu0 U are the
     * fluxes that conserve energy with the beam's mu0 e^(-tau/mu0). */
    return (pps_flux){.up = mu0 * u,
                      .down = mu0 * d,
                      .direct = mu0 * beam,
                      .mean_diffuse = (d + u) / (4 * PI),
                      .mean = (d + u + beam) / (4 * PI)};
}

static pps_status spp_init(void *state, const pps_slab *slab, const pps_options *opts) {
    (void)opts;
    spp_state *s = state;
    s->slab = *slab;
    return PPS_OK;
}

static pps_status consistent_solve(void *state, double thickness, double mu0) {
    spp_state *s = state;
    s->slab.thickness = thickness;
    s->sky = false;
    return pps_spp_init(&s->spp, &s->slab, mu0, PPS_SPP_CONSISTENT);
}

static pps_status consistent_solve_sky(void *state, double thickness) {
    return pps_spp_init_sky(state, thickness, PPS_SPP_CONSISTENT);
}

static pps_status printed_solve(void *state, double thickness, double mu0) {
    spp_state *s = state;
    s->slab.thickness = thickness;
    s->sky = false;
    return pps_spp_init(&s->spp, &s->slab, mu0, PPS_SPP_PRINTED);
}

static pps_status printed_solve_sky(void *state, double thickness) {
    return pps_spp_init_sky(state, thickness, PPS_SPP_PRINTED);
}

static pps_status spp_radiance(void *state, const pps_grid *at, double *radiance) {
    const spp_state *s = state;
    for (size_t k = 0; k < at->n_tau; k++) {
        double down, up;
        amplitudes(s, at->tau[k], &down, &up);
        for (size_t j = 0; j < at->n_mu; j++) {
            for (size_t i = 0; i < at->n_phi; i++) {
                *radiance++ = (at->mu[j] > 0 ? down : up) / (2 * PI);
            }
        }
    }
    return PPS_OK;
}

static pps_status spp_flux(void *state, size_t n, const double *tau, pps_flux *flux) {
    const spp_state *s = state;
    for (size_t i = 0; i < n; i++) {
        flux[i] = flux_at(s, tau[i]);
    }
    return PPS_OK;
}

static const pps_method_ops consistent_ops = {.state_size = sizeof(spp_state),
                                              .init = spp_init,
                                              .solve = consistent_solve,
                                              .solve_sky = consistent_solve_sky,
                                              .radiance = spp_radiance,
                                              .flux = spp_flux};
static const pps_method_ops printed_ops = {.state_size = sizeof(spp_state),
                                           .init = spp_init,
                                           .solve = printed_solve,
                                           .solve_sky = printed_solve_sky,
                                           .radiance = spp_radiance,
                                           .flux = spp_flux};

const pps_method pps_method_spp = {
    .name = "spp",
    .cost = "two exponentials a depth",
    .summary =
        "simplified plane-parallel model (SPP Eq. 19, misprints mended, kappa = 1)",
    .limits =
        "same radiance in every direction of a hemisphere; fluence 0.6 of the truth; "
        "reflectance within 0.35 of what falls in",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &consistent_ops,
};

const pps_method pps_method_spp_printed = {
    .name = "spp-printed",
    .cost = "two exponentials a depth",
    .summary = "the same with c2 as printed in Eq. 20 (kappa = 1/T)",
    .limits = "as spp; does not conserve energy, unbounded as g -> -1",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &printed_ops,
};
