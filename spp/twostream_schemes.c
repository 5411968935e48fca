/* The methods "twostream-...": two-stream schemes of the literature, as fluxes.
 *
 * A scheme is one row of a table of closures (twostream.h; F+ downward):
 *   e = gamma1 - gamma2 = e0 (1 - albedo)
 *   f = gamma1 + gamma2 = f0 - albedo (f1 + f2 g)
 *   1 - 2 gamma3        = b0 g mu0
 * In this form nothing cancels as albedo -> 1, as the printed gamma1 - gamma2 does.
 * Solved as one mode, a scheme is finite at albedo 0 and 1, in a half-space and on
 * resonance (k = 1/mu0). What it says is not clipped: the closures themselves allow
 * negative fluxes, and more light out than in.
 *
 * With delta scaling (JWW76) the share g^2 of the scattering goes straight on; that
 * light is reported as diffuse, which it is in the true problem.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "core/method.h"
#include "spp/twostream.h"

static const double PI = 3.14159265358979323846;

typedef struct {
    double e0, f0, f1, f2, b0;
} closure;

#define SQRT3 1.7320508075688772935

/* MW80 and Toon89, Table 1 of each. Toon89 leaves gamma3 of the hemispheric mean open:
 * here (2 - g mu0)/4, as is usual. PIFM, the "practical improved flux
 * method": ZWK80. */
static const closure eddington = {2, 1.5, 0, 1.5, 1.5};
static const closure quadrature = {SQRT3, SQRT3, 0, SQRT3, SQRT3};
static const closure hemispheric_mean = {2, 2, 0, 2, 0.5};
static const closure pifm = {2, 2, 0.5, 1.5, 1.5};

typedef struct {
    closure closure;
    double albedo, g;             /* scaled */
    double co_albedo;             /* 1 - scaled albedo, exact where that is near 1 */
    double stretch, tail_stretch; /* scaled optical depth / true, and 1 - that */
    pps_twostream two;
} scheme;

static void init_scheme(scheme *s, const pps_slab *slab, const closure *c, bool delta) {
    double albedo = slab->albedo, g = slab->g, peak = delta ? g * g : 0;
    *s = (scheme){.closure = *c, .tail_stretch = albedo * peak};
    /* 1 - albedo g^2, by parts */
    s->stretch = (1 - albedo) + albedo * (delta ? (1 - g) * (1 + g) : 1);
    s->albedo = albedo * (delta ? (1 - g) * (1 + g) : 1) / s->stretch;
    s->co_albedo = (1 - albedo) / s->stretch;
    s->g = delta ? g / (1 + g) : g;
}

static double e_of(const scheme *s) { return s->closure.e0 * s->co_albedo; }

static double f_of(const scheme *s) {
    const closure *c = &s->closure;
    return c->f0 - s->albedo * (c->f1 + c->f2 * s->g);
}

static pps_status scheme_solve(void *state, double thickness, double mu0) {
    scheme *s = state;
    pps_twostream_solve(&s->two, thickness * s->stretch, mu0, e_of(s), f_of(s),
                        s->albedo, s->albedo * s->closure.b0 * s->g * mu0);
    return PPS_OK;
}

static pps_status scheme_solve_sky(void *state, double thickness) {
    scheme *s = state;
    pps_twostream_solve_sky(&s->two, thickness * s->stretch, e_of(s), f_of(s));
    return PPS_OK;
}

static pps_flux flux_at(const scheme *s, double tau) {
    pps_flux flux = pps_twostream_flux(&s->two, tau * s->stretch);
    if (s->two.sky) {
        return flux;
    }
    double q = s->two.mode.q, beam = exp(-q * tau);
    /* e^(-q tau stretch) - e^(-q tau): scattered, but straight on */
    double peak = exp(-q * tau * s->stretch) * -expm1(-q * tau * s->tail_stretch);
    flux.down += peak / q;
    flux.direct = beam / q;
    flux.mean_diffuse += peak / (4 * PI);
    flux.mean = flux.mean_diffuse + beam / (4 * PI);
    return flux;
}

static pps_status scheme_flux(void *state, size_t n, const double *tau,
                              pps_flux *flux) {
    for (size_t i = 0; i < n; i++) {
        flux[i] = flux_at(state, tau[i]);
    }
    return PPS_OK;
}

#define LIMITS                                                                         \
    "fluxes only; reflectance within 0.18 of what falls in (hemispheric mean 0.3, "    \
    "with delta and g < 0 0.45); may be negative, or more than falls in, in thin "     \
    "slabs and for grazing beams"

/* A row: the identifier of the method, its name, its closure, scaled or not. */
#define SCHEMES(X)                                                                     \
    X(twostream_eddington, "twostream-eddington", eddington, false,                    \
      "Eddington two-stream fluxes (MW80)", LIMITS)                                    \
    X(twostream_eddington_delta, "twostream-eddington-delta", eddington, true,         \
      "delta-Eddington two-stream fluxes (JWW76)", LIMITS "; not meant for g < 0")     \
    X(twostream_quadrature, "twostream-quadrature", quadrature, false,                 \
      "two-stream fluxes with one Gauss node, mu = 1/sqrt 3 (MW80)", LIMITS)           \
    X(twostream_quadrature_delta, "twostream-quadrature-delta", quadrature, true,      \
      "the same with delta scaling", LIMITS "; not meant for g < 0")                   \
    X(twostream_hemispheric_mean, "twostream-hemispheric-mean", hemispheric_mean,      \
      false, "two-stream fluxes of uniform hemispheres (Toon89)", LIMITS)              \
    X(twostream_hemispheric_mean_delta, "twostream-hemispheric-mean-delta",            \
      hemispheric_mean, true, "the same with delta scaling",                           \
      LIMITS "; not meant for g < 0")                                                  \
    X(twostream_pifm, "twostream-pifm", pifm, false,                                   \
      "two-stream fluxes by the practical improved flux method", LIMITS)               \
    X(twostream_pifm_delta, "twostream-pifm-delta", pifm, true,                        \
      "the same with delta scaling", LIMITS "; not meant for g < 0")

#define SCHEME_METHOD(id, method_name, row, delta, text, limits_text)                  \
    static pps_status init_##id(void *state, const pps_slab *slab,                     \
                                const pps_options *opts) {                             \
        (void)opts;                                                                    \
        init_scheme(state, slab, &(row), delta);                                       \
        return PPS_OK;                                                                 \
    }                                                                                  \
    static const pps_method_ops ops_##id = {.state_size = sizeof(scheme),              \
                                            .init = init_##id,                         \
                                            .solve = scheme_solve,                     \
                                            .solve_sky = scheme_solve_sky,             \
                                            .flux = scheme_flux};                      \
    const pps_method pps_method_##id = {                                               \
        .name = (method_name),                                                         \
        .cost = "three exponentials a depth",                                          \
        .summary = (text),                                                             \
        .limits = (limits_text),                                                       \
        .fields = false,                                                               \
        .fluxes = true,                                                                \
        .half_space = true,                                                            \
        .ops = &ops_##id,                                                              \
    };

SCHEMES(SCHEME_METHOD)
