/* What `stability` compares: the numbers taken from an answer, and trusted ones.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability_truth.h"

#include <math.h>
#include <stdlib.h>

#include <ppscat/mc.h>

static const double PI = 3.14159265358979323846;

static const double mus[SAMPLE_MUS] = {-0.9, -0.4, -0.05, 0.05, 0.4, 0.9};
static const double phis[SAMPLE_PHIS] = {0, 120};

/* ---- sampling ---- */

static void sample_depths(double thickness, double tau[SAMPLE_DEPTHS]) {
    tau[0] = 0;
    tau[1] = isinf(thickness) ? 1 : thickness / 2;
    tau[2] = isinf(thickness) ? 5 : thickness;
}

static void take_fluxes(const pps_flux flux[SAMPLE_DEPTHS], sample *out) {
    out->has_flux = true;
    out->up = flux[0].up;
    out->mean = flux[1].mean_diffuse;
    out->down = flux[2].down;
}

static pps_status sample_solved(pps_model *model, double thickness, bool fluxes,
                                bool radiance, sample *out) {
    double tau[SAMPLE_DEPTHS];
    pps_grid at = {SAMPLE_DEPTHS, SAMPLE_MUS, SAMPLE_PHIS, tau, mus, phis};
    pps_flux flux[SAMPLE_DEPTHS];
    pps_status status = PPS_OK;

    *out = (sample){0};
    sample_depths(thickness, tau);
    if (fluxes) {
        status = pps_model_flux(model, SAMPLE_DEPTHS, tau, flux);
        if (!status)
            take_fluxes(flux, out);
    }
    if (!status && radiance) {
        status = pps_model_radiance(model, &at, out->radiance);
        out->has_radiance = !status;
    }
    return status;
}

pps_status sample_model(pps_model *model, const pps_method *method, double thickness,
                        double mu0, sample *out) {
    pps_status status = pps_model_solve(model, thickness, mu0);

    return status
               ? status
               : sample_solved(model, thickness, method->fluxes, method->fields, out);
}

pps_status sample_mc(const pps_slab *slab, double mu0, const pps_options *options,
                     double deviation[SAMPLE_NUMBERS], sample *out) {
    pps_mc_opts opts = {.photons = options->photons, .seed = options->seed};
    double tau[SAMPLE_DEPTHS];
    pps_grid at = {SAMPLE_DEPTHS, SAMPLE_MUS, SAMPLE_PHIS, tau, mus, phis};
    pps_flux flux[SAMPLE_DEPTHS], spread[SAMPLE_DEPTHS];
    pps_status status;

    *out = (sample){.deviation = deviation};
    sample_depths(slab->thickness, tau);
    status = pps_mc_flux(slab, mu0, &opts, SAMPLE_DEPTHS, tau, flux, spread);
    if (status)
        return status;
    take_fluxes(flux, out);
    deviation[0] = spread[0].up;
    deviation[1] = spread[2].down;
    deviation[2] = spread[1].mean_diffuse;
    status = pps_mc_radiance(slab, mu0, &opts, &at, out->radiance, deviation + 3);
    out->has_radiance = !status;
    return status;
}

/* ---- trusted solutions ---- */

static const double hopeless = 0.99; /* |g| at which `adding` works long and refuses */

enum {
    FLUX_STREAMS = 384,
    RADIANCE_STREAMS = 192,
    SLOW_STREAMS = 320,
    RK_STREAMS = 16
};
static const double resolved = 1e-8; /* what many streams are good for */

/* What `adding` is asked for, in tolerances of the judged; the first that it can do. */
static const double sharpness[] = {0.03, 1, 30};
enum { N_SHARPNESS = sizeof sharpness / sizeof sharpness[0] };

/* Discrete ordinates, kept for one thickness. */
typedef struct {
    pps_dom *dom;
    double thickness; /* 0 before the first */
} solver;

struct truths {
    pps_slab slab;
    int rk_streams;
    bool plain; /* without correction of single scattering */
    double tolerance;
    pps_model *adding[N_SHARPNESS];
    solver flux[PPS_NODES_GRADED + 1], radiance[PPS_NODES_GRADED + 1], nodes;
};

truths *truths_new(const pps_slab *slab, const pps_options *options) {
    truths *t = calloc(1, sizeof *t);

    if (t) {
        t->slab = *slab;
        t->rk_streams = options->streams ? options->streams : RK_STREAMS;
        t->plain = options->delta_m == PPS_DELTA_M_OFF;
        t->tolerance = options->tolerance;
    }
    return t;
}

void truths_free(truths *t) {
    if (!t)
        return;
    for (int i = 0; i < N_SHARPNESS; i++)
        pps_model_free(t->adding[i]);
    for (int nodes = 0; nodes <= PPS_NODES_GRADED; nodes++) {
        pps_dom_free(t->flux[nodes].dom);
        pps_dom_free(t->radiance[nodes].dom);
    }
    pps_dom_free(t->nodes.dom);
    free(t);
}

static pps_status solve(solver *s, const pps_slab *slab, const pps_dom_opts *opts,
                        double thickness, double mu0) {
    pps_status status = PPS_OK;

    if (!s->dom)
        status = pps_dom_create(slab, opts, &s->dom);
    if (!status && s->thickness != thickness)
        status = pps_dom_set_thickness(s->dom, thickness);
    s->thickness = status ? 0 : thickness;
    return status ? status : pps_dom_solve(s->dom, mu0);
}

static pps_status take_dom(const pps_dom *dom, double thickness, bool radiance,
                           sample *out) {
    double tau[SAMPLE_DEPTHS];
    pps_grid at = {SAMPLE_DEPTHS, SAMPLE_MUS, SAMPLE_PHIS, tau, mus, phis};
    pps_flux flux[SAMPLE_DEPTHS];
    pps_status status;

    sample_depths(thickness, tau);
    if (radiance) {
        status = pps_dom_radiance(dom, &at, out->radiance);
        out->has_radiance = !status;
        return status;
    }
    status = pps_dom_flux(dom, SAMPLE_DEPTHS, tau, flux);
    if (!status)
        take_fluxes(flux, out);
    return status;
}

/* Graded and mapped nodes see grazing beams and thin slabs, but carry fewer moments:
 * Gauss nodes for strong peaks. */
static pps_nodes many_nodes(double g, double thickness, int streams) {
    if (thickness < 0.1)
        return PPS_NODES_GRADED;
    return pow(fabs(g), 0.8 * streams) < 1e-7 ? PPS_NODES_MAPPED : PPS_NODES_GAUSS;
}

static pps_status by_streams(truths *t, double thickness, double mu0, bool radiance,
                             sample *out) {
    bool slow /* to converge */ = fabs(t->slab.g) > 0.7 || thickness < 0.1;
    int streams = !radiance ? FLUX_STREAMS : slow ? SLOW_STREAMS : RADIANCE_STREAMS;
    pps_nodes nodes = many_nodes(t->slab.g, thickness, streams);
    pps_dom_opts opts = {.streams = streams,
                         .nodes = nodes,
                         .orders = radiance ? 0 : 1,
                         .tolerance = resolved};
    solver *s = radiance ? &t->radiance[nodes] : &t->flux[nodes];
    pps_status status = solve(s, &t->slab, &opts, thickness, mu0);

    out->accuracy = resolved;
    return status ? status : take_dom(s->dom, thickness, radiance, out);
}

/* The share of single scattering that so many moments of the phase function miss. */
static double missed_by_moments(double g, int n, double cosine) {
    double before = 0, p = 1, power = 1, sum = 0;

    for (int l = 0; l < n; l++) {
        double next = ((2 * l + 1) * cosine * p - l * before) / (l + 1);
        sum += (2 * l + 1) * power * p;
        power *= g;
        before = p;
        p = next;
    }
    return 1 - sum / (4 * PI * pps_hg(g, cosine));
}

/* `rk` takes single scattering with the exact phase function. */
static pps_status correct_single(const truths *t, double thickness, double mu0,
                                 sample *out) {
    pps_slab slab = {t->slab.albedo, t->slab.g, thickness};
    const pps_method *method = pps_method_find("single");
    pps_model *model;
    sample once;
    pps_status status = pps_model_create(method, &slab, NULL, &model);

    if (!status)
        status = pps_model_solve(model, thickness, mu0);
    if (!status)
        status = sample_solved(model, thickness, false, true, &once);
    pps_model_free(model);
    for (size_t i = 0; !status && i < SAMPLE_RADIANCES; i++) {
        double cosine = pps_cos_scattering(mu0, mus[i / SAMPLE_PHIS % SAMPLE_MUS],
                                           phis[i % SAMPLE_PHIS]);
        double share = missed_by_moments(slab.g, t->rk_streams, cosine);
        out->radiance[i] += share * once.radiance[i];
    }
    return status;
}

static pps_status on_own_nodes(truths *t, double thickness, double mu0, bool radiance,
                               sample *out) {
    pps_dom_opts opts = {.streams = t->rk_streams, .delta_m = PPS_DELTA_M_OFF};
    pps_status status = solve(&t->nodes, &t->slab, &opts, thickness, mu0);

    if (!status)
        status = take_dom(t->nodes.dom, thickness, radiance, out);
    if (!status && radiance && !t->plain)
        status = correct_single(t, thickness, mu0, out);
    return status;
}

static pps_status by_adding(truths *t, double thickness, double mu0, bool radiance,
                            sample *out) {
    pps_status status = PPS_ERR_TOLERANCE;

    for (int i = 0; i < N_SHARPNESS && status && status != PPS_ERR_MEMORY; i++) {
        pps_options opts = {.tolerance = sharpness[i] * t->tolerance};
        status = PPS_OK;
        if (!t->adding[i])
            status = pps_model_create(pps_method_find("adding"), &t->slab, &opts,
                                      &t->adding[i]);
        if (!status)
            status = pps_model_solve(t->adding[i], thickness, mu0);
        if (!status)
            status = sample_solved(t->adding[i], thickness, true, radiance, out);
        out->accuracy = opts.tolerance;
    }
    return status;
}

pps_status truths_sample(truths *t, truth_kind kind, double thickness, double mu0,
                         bool radiance, sample *out) {
    pps_status (*one)(truths *, double, double, bool, sample *) =
        kind == ON_OWN_NODES ? on_own_nodes : by_streams;
    pps_status status;

    *out = (sample){0};
    if (kind == BY_ADDING && fabs(t->slab.g) < hopeless) {
        status = by_adding(t, thickness, mu0, radiance, out);
        if (!status || status == PPS_ERR_MEMORY)
            return status;
    }
    status = one(t, thickness, mu0, false, out);
    if (!status && radiance)
        status = one(t, thickness, mu0, true, out);
    return status;
}
