/* Is an answer right? Methods against a solution on other nodes with more streams.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability_judge.h"

#include <math.h>
#include <string.h>

#include <ppscat/mc.h>

/* The accuracy that a method states. Those not listed are closed forms: approximations
 * whose reflectance is to be within half of the exact one. */
typedef struct {
    const char *method;
    double tolerances; /* the limit, in tolerances asked for */
} promise;
static const promise promises[] = {
    {"exact", 1}, {"adding", 1}, {"rk", 1}, {"rk-shooting", 1}, {"mc", 0}};
static const double closed_form_limit = 0.5;
static const double resolved = 1e-8; /* what the trusted solution is good for */

static const double nothing = 1e-290;   /* below, numbers lose digits */
static const double negligible = 1e-12; /* below zero by that share of the largest */
static const double small_share = 1e-3; /* radiances below that share count as it */

static const double mus[SAMPLE_MUS] = {-0.9, -0.4, -0.05, 0.05, 0.4, 0.9};
static const double phis[SAMPLE_PHIS] = {0, 120};

const char *verdict_text(verdict v) {
    static const char *const text[] = {[OK] = "ok",
                                       [INACCURATE] = "inaccurate",
                                       [NOT_FINITE] = "not_finite",
                                       [NEGATIVE] = "negative",
                                       [REFUSED] = "refused",
                                       [TOO_SLOW] = "too_slow"};

    return text[v];
}

static const promise *promise_of(const pps_method *method) {
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; i++) {
        if (strcmp(promises[i].method, method->name) == 0)
            return &promises[i];
    }
    return NULL;
}

bool judged_in_full(const pps_method *method) { return promise_of(method) != NULL; }

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

pps_status sample_model(pps_model *model, const pps_method *method, double thickness,
                        double mu0, sample *out) {
    double tau[SAMPLE_DEPTHS];
    pps_grid at = {SAMPLE_DEPTHS, SAMPLE_MUS, SAMPLE_PHIS, tau, mus, phis};
    pps_flux flux[SAMPLE_DEPTHS];
    pps_status status = pps_model_solve(model, thickness, mu0);

    *out = (sample){0};
    sample_depths(thickness, tau);
    if (!status && method->fluxes) {
        status = pps_model_flux(model, SAMPLE_DEPTHS, tau, flux);
        if (!status)
            take_fluxes(flux, out);
    }
    if (!status && method->fields) {
        status = pps_model_radiance(model, &at, out->radiance);
        out->has_radiance = !status;
    }
    return status;
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

/* ---- the trusted solution ---- */

enum { FLUX_STREAMS = 384, RADIANCE_STREAMS = 192, SLOW_STREAMS = 320 };

/* Graded and mapped nodes see grazing beams and thin slabs, but carry fewer moments:
 * Gauss nodes for strong peaks. */
static pps_nodes trusted_nodes(double g, double thickness, int streams) {
    if (thickness < 0.1)
        return PPS_NODES_GRADED;
    return pow(fabs(g), 0.8 * streams) < 1e-7 ? PPS_NODES_MAPPED : PPS_NODES_GAUSS;
}

/* A solver of the case, solved. */
static pps_status trusted_solve(const trusted *t, trusted_solver *kept, int streams,
                                int orders, double thickness, double mu0,
                                pps_dom **out) {
    pps_nodes nodes = trusted_nodes(t->slab.g, thickness, streams);
    pps_dom_opts opts = {
        .streams = streams, .nodes = nodes, .orders = orders, .tolerance = 1e-8};
    pps_status status = PPS_OK;

    kept += nodes;
    if (!kept->dom)
        status = pps_dom_create(&t->slab, &opts, &kept->dom);
    if (!status && kept->thickness != thickness)
        status = pps_dom_set_thickness(kept->dom, thickness);
    kept->thickness = status ? 0 : thickness;
    *out = kept->dom;
    return status ? status : pps_dom_solve(kept->dom, mu0);
}

pps_status trusted_sample(trusted *t, double thickness, double mu0, bool radiance,
                          sample *out) {
    bool slow /* to converge */ = fabs(t->slab.g) > 0.7 || thickness < 0.1;
    double tau[SAMPLE_DEPTHS];
    pps_grid at = {SAMPLE_DEPTHS, SAMPLE_MUS, SAMPLE_PHIS, tau, mus, phis};
    pps_flux flux[SAMPLE_DEPTHS];
    pps_dom *dom;
    pps_status status =
        trusted_solve(t, t->flux, FLUX_STREAMS, 1, thickness, mu0, &dom);

    *out = (sample){0};
    sample_depths(thickness, tau);
    if (!status)
        status = pps_dom_flux(dom, SAMPLE_DEPTHS, tau, flux);
    if (!status)
        take_fluxes(flux, out);
    if (status || !radiance)
        return status;
    status = trusted_solve(t, t->radiance, slow ? SLOW_STREAMS : RADIANCE_STREAMS, 0,
                           thickness, mu0, &dom);
    if (!status)
        status = pps_dom_radiance(dom, &at, out->radiance);
    out->has_radiance = !status;
    return status;
}

void trusted_free(trusted *t) {
    for (int nodes = 0; nodes <= PPS_NODES_GRADED; nodes++) {
        pps_dom_free(t->flux[nodes].dom);
        pps_dom_free(t->radiance[nodes].dom);
    }
}

/* ---- judging ---- */

/* The numbers of a sample in a row: 3 fluxes, then radiances. */
static size_t numbers(const sample *s, double x[SAMPLE_NUMBERS]) {
    size_t n = 0;

    if (s->has_flux) {
        x[n++] = s->up;
        x[n++] = s->down;
        x[n++] = s->mean;
    }
    for (size_t i = 0; s->has_radiance && i < SAMPLE_RADIANCES; i++)
        x[n++] = s->radiance[i];
    return n;
}

static double largest(size_t n, const double *x) {
    double most = 0;

    for (size_t i = 0; i < n; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* What no right answer is, whatever its accuracy. */
static verdict judge_sanity(const sample *got) {
    double x[SAMPLE_NUMBERS];
    size_t n = numbers(got, x);
    double most = largest(n, x);

    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i]))
            return NOT_FINITE;
    }
    for (size_t i = 0; i < n; i++) {
        if (x[i] < -negligible * most)
            return NEGATIVE;
    }
    return OK;
}

static double relative(double got, double want, double scale) {
    double difference = fabs(got - want);

    return difference < nothing ? 0 : difference / fmax(fabs(want), scale);
}

static double flux_error(const sample *got, const sample *want) {
    double worst = relative(got->up, want->up, 0);

    worst = fmax(worst, relative(got->down, want->down, 0));
    return fmax(worst, relative(got->mean, want->mean, 0));
}

static double radiance_error(const sample *got, const sample *want) {
    double scale = small_share * largest(SAMPLE_RADIANCES, want->radiance), worst = 0;

    for (size_t i = 0; i < SAMPLE_RADIANCES; i++)
        worst = fmax(worst, relative(got->radiance[i], want->radiance[i], scale));
    return worst;
}

/* Within four standard deviations wherever one is known. */
static bool within_chance(const sample *got, const sample *want) {
    double x[SAMPLE_NUMBERS], y[SAMPLE_NUMBERS];
    size_t n = numbers(got, x);

    numbers(want, y);
    for (size_t i = 0; i < n; i++) {
        if (fabs(x[i] - y[i]) > 4 * got->deviation[i] + resolved * fabs(y[i]))
            return false;
    }
    return true;
}

verdict judge_sample(const pps_method *method, double tolerance, const sample *got,
                     const sample *want, double *error) {
    const promise *kept = promise_of(method);
    double limit =
        kept ? fmax(kept->tolerances * tolerance, resolved) : closed_form_limit;
    verdict v = judge_sanity(got);

    *error = (double)NAN;
    if (v == NOT_FINITE)
        return v;
    if (got->has_flux)
        *error = kept ? flux_error(got, want) : relative(got->up, want->up, 0);
    if (kept && got->has_radiance && want->has_radiance)
        *error = fmax(*error, radiance_error(got, want));
    if (v == OK && (got->deviation ? !within_chance(got, want) : *error > limit))
        v = INACCURATE;
    return v;
}
