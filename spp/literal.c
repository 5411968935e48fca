/* The method "spp-literal": SPP Eqs. 17 and 19-22 in the shape they are printed, with
 * their misprints mended (docs/theory.md section 7), and nothing else done for them.
 *
 *   D(tau) = c1 alpha e^(-lambda tau) + c2 e^(-tau/mu0) + c3 e^(lambda tau)
 *   U(tau) = c1 e^(-lambda tau) + c3 alpha e^(lambda tau)
 *
 * It is there to be compared with spp.c, which is the same function in a form that
 * holds. Here e^(lambda w) overflows at lambda w > 709, alpha is 0/0 at albedo 0 and
 * cancels as albedo or the backward share R -> 0, c1 and c3 are 0/0 at albedo 1. What
 * comes out as no number is refused; digits lost short of that are left for all to see.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/phase.h>

#include "core/method.h"

static const double PI = 3.14159265358979323846;

typedef struct {
    pps_slab slab;
    double mu0, lambda, alpha; /* Eq. 17 */
    double c1, c2, c3;         /* Eqs. 20-22 */
} literal;

static pps_status literal_init(void *state, const pps_slab *slab,
                               const pps_options *opts) {
    (void)opts;
    ((literal *)state)->slab = *slab;
    return PPS_OK;
}

static pps_status literal_solve(void *state, double thickness, double mu0) {
    literal *s = state;
    double albedo = s->slab.albedo;
    double backward = pps_hg_backward(s->slab.g, mu0), forward = 1 - backward;
    double delta = albedo * (forward - backward);
    s->mu0 = mu0;
    s->lambda = sqrt((1 - delta) * (1 - albedo)) / mu0;
    s->alpha = albedo * backward / (1 - albedo * forward - s->lambda * mu0);
    double e1 = exp(-s->lambda * thickness), e3 = exp(s->lambda * thickness);
    double determinant = s->alpha * s->alpha * e3 - e1;
    s->c2 = -1;
    s->c1 = -s->alpha * e3 * s->c2 / determinant;
    s->c3 = s->c2 * e1 / determinant;
    bool finite = isfinite(s->alpha) && isfinite(s->c1) && isfinite(s->c3);
    return finite ? PPS_OK : PPS_ERR_UNSUPPORTED;
}

/* D and U; false where one is no number. */
static bool amplitudes(const literal *s, double tau, double *down, double *up) {
    double fall = exp(-s->lambda * tau), rise = exp(s->lambda * tau);
    *down = s->c1 * s->alpha * fall + s->c2 * exp(-tau / s->mu0) + s->c3 * rise;
    *up = s->c1 * fall + s->c3 * s->alpha * rise;
    return isfinite(*down) && isfinite(*up);
}

static pps_status literal_radiance(void *state, const pps_grid *at, double *radiance) {
    const literal *s = state;
    for (size_t k = 0; k < at->n_tau; k++) {
        double down, up;
        if (!amplitudes(s, at->tau[k], &down, &up)) {
            return PPS_ERR_UNSUPPORTED;
        }
        for (size_t j = 0; j < at->n_mu; j++) {
            for (size_t i = 0; i < at->n_phi; i++) {
                *radiance++ = (at->mu[j] > 0 ? down : up) / (2 * PI);
            }
        }
    }
    return PPS_OK;
}

static pps_status literal_flux(void *state, size_t n, const double *tau,
                               pps_flux *flux) {
    const literal *s = state;
    for (size_t i = 0; i < n; i++) {
        double down, up, beam = exp(-tau[i] / s->mu0);
        if (!amplitudes(s, tau[i], &down, &up)) {
            return PPS_ERR_UNSUPPORTED;
        }
        flux[i] = (pps_flux){.up = s->mu0 * up, /* as spp.c */
                             .down = s->mu0 * down,
                             .direct = s->mu0 * beam,
                             .mean_diffuse = (down + up) / (4 * PI),
                             .mean = (down + up + beam) / (4 * PI)};
    }
    return PPS_OK;
}

static const pps_method_ops ops = {.state_size = sizeof(literal),
                                   .init = literal_init,
                                   .solve = literal_solve,
                                   .radiance = literal_radiance,
                                   .flux = literal_flux};

const pps_method pps_method_spp_literal = {
    .name = "spp-literal",
    .cost = "three exponentials a depth",
    .summary =
        "SPP Eqs. 19-22 as printed in shape (misprints mended), evaluated naively",
    .limits = "as spp, and loses digits as albedo -> 0 or 1, as R -> 0 and in thin "
              "slabs; refuses albedo 0 and 1, half-spaces and lambda w > 709",
    .fields = true,
    .fluxes = true,
    .half_space = false,
    .ops = &ops,
};
