/* ppscat as the peers' benchmark sees it: whole cases and sweeps timed inside C, so that
 * neither a process start nor a line of CSV nor a Python call is in the time.
 *
 * Built by scripts/bench-peers.sh as a shared library that scripts/peers/ppscat.py loads;
 * no part of the build. Seconds are of CPU time, all threads together.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <time.h>

#include <ppscat/ppscat.h>

typedef struct {
    pps_slab slab;
    double mu0;
    int streams, nodes, delta_m, orders; /* as pps_dom_opts */
    pps_grid at;                         /* n_mu = 0: fluxes only */
} peers_case;

/* What peers_run repeats. */
enum { WHOLE_CASE, CREATE, ONE_MORE_BEAM };

PPS_API int peers_run(const peers_case *c, int what, int repeats, double *radiance,
                      pps_flux *flux, double *seconds);
PPS_API int peers_eigenvalues(const peers_case *c, int m, double *k);
PPS_API int peers_nodes(const peers_case *c, double *mu);
PPS_API int peers_reference(const peers_case *c, double tolerance, double *radiance,
                            pps_flux *flux);

/* Lists of a sweep; every case at n_depths even depths from edge to edge. */
typedef struct {
    const double *albedo, *g, *thickness, *mu0, *phi;
    size_t n_albedo, n_g, n_thickness, n_mu0, n_depths, n_phi; /* n_phi = 0: fluxes */
    int streams, nodes;
} peers_sweep_lists;

/* radiance[case][depth][mu][phi] at the nodes, if n_phi > 0, and flux[case][depth]; cases
 * with albedo slowest and mu0 fastest. */
PPS_API int peers_sweep(const peers_sweep_lists *s, double *radiance, pps_flux *flux,
                        double *seconds);

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static pps_status create(const peers_case *c, pps_dom **dom) {
    pps_dom_opts opts = {.streams = c->streams,
                         .nodes = (pps_nodes)c->nodes,
                         .delta_m = (pps_delta_m)c->delta_m,
                         .orders = c->orders};
    return pps_dom_create(&c->slab, &opts, dom);
}

static pps_status beam(const peers_case *c, pps_dom *dom, double *radiance,
                       pps_flux *flux) {
    pps_status status = pps_dom_solve(dom, c->mu0);
    if (!status && c->at.n_mu > 0) {
        status = pps_dom_radiance(dom, &c->at, radiance);
    }
    if (!status && flux) {
        status = pps_dom_flux(dom, c->at.n_tau, c->at.tau, flux);
    }
    return status;
}

/* Mean seconds of one repeat; the outputs are those of the last. */
int peers_run(const peers_case *c, int what, int repeats, double *radiance,
              pps_flux *flux, double *seconds) {
    pps_dom *kept = NULL;
    pps_status status = what == ONE_MORE_BEAM ? create(c, &kept) : PPS_OK;
    double start = now();
    for (int i = 0; i < repeats && !status; i++) {
        pps_dom *dom = kept;
        if (what != ONE_MORE_BEAM) {
            status = create(c, &dom);
        }
        if (!status && what != CREATE) {
            status = beam(c, dom, radiance, flux);
        }
        if (what != ONE_MORE_BEAM) {
            pps_dom_free(dom);
        }
    }
    *seconds = (now() - start) / repeats;
    pps_dom_free(kept);
    return (int)status;
}

int peers_eigenvalues(const peers_case *c, int m, double *k) {
    pps_dom *dom;
    pps_status status = create(c, &dom);
    if (!status) {
        status = pps_dom_eigenvalues(dom, m, k);
    }
    pps_dom_free(dom);
    return (int)status;
}

int peers_nodes(const peers_case *c, double *mu) {
    double weight[PPS_STREAMS_MAX / 2];
    pps_dom *dom;
    pps_status status = create(c, &dom);
    if (!status) {
        status = pps_dom_nodes(dom, mu, weight);
    }
    pps_dom_free(dom);
    return (int)status;
}

/* The method `exact` to a tolerance: radiance (n_mu = 0: none) and flux. */
int peers_reference(const peers_case *c, double tolerance, double *radiance,
                    pps_flux *flux) {
    pps_options opts = {.tolerance = tolerance};
    pps_model *model;
    pps_status status =
        pps_model_create(pps_method_find("exact"), &c->slab, &opts, &model);
    if (!status) {
        status = pps_model_solve(model, c->slab.thickness, c->mu0);
    }
    if (!status && c->at.n_mu > 0) {
        status = pps_model_radiance(model, &c->at, radiance);
    }
    if (!status) {
        status = pps_model_flux(model, c->at.n_tau, c->at.tau, flux);
    }
    pps_model_free(model);
    return (int)status;
}

/* ---- a sweep: eigenproblems once per (albedo, g), factors once per thickness ---- */

typedef struct {
    const peers_sweep_lists *s;
    peers_case c;
    double mu[PPS_STREAMS_MAX];
    double *tau, *radiance;
    pps_flux *flux;
} sweep;

static pps_status sweep_beams(sweep *w, pps_dom *dom) {
    const peers_sweep_lists *s = w->s;
    pps_status status = PPS_OK;
    for (size_t i = 0; i < s->n_mu0 && !status; i++) {
        w->c.mu0 = s->mu0[i];
        status = beam(&w->c, dom, w->radiance, w->flux);
        w->radiance += w->c.at.n_tau * w->c.at.n_mu * w->c.at.n_phi;
        w->flux += s->n_depths;
    }
    return status;
}

static pps_status sweep_slab(sweep *w) {
    const peers_sweep_lists *s = w->s;
    size_t n = (size_t)s->streams / 2;
    pps_dom *dom;
    pps_status status = create(&w->c, &dom);
    if (!status && s->n_phi > 0) {
        status = pps_dom_nodes(dom, w->mu + n, w->mu); /* the weights are overwritten */
        for (size_t j = 0; j < n; j++) {
            w->mu[j] = -w->mu[2 * n - 1 - j];
        }
        w->c.at.n_mu = 2 * n;
    }
    for (size_t i = 0; i < s->n_thickness && !status; i++) {
        for (size_t k = 0; k < s->n_depths; k++) {
            w->tau[k] = s->thickness[i] * (double)k / (double)(s->n_depths - 1);
        }
        status = pps_dom_set_thickness(dom, s->thickness[i]);
        if (!status) {
            status = sweep_beams(w, dom);
        }
    }
    pps_dom_free(dom);
    return status;
}

int peers_sweep(const peers_sweep_lists *s, double *radiance, pps_flux *flux,
                double *seconds) {
    double start = now();
    double *tau = malloc(s->n_depths * sizeof *tau);
    pps_status status = tau ? PPS_OK : PPS_ERR_MEMORY;
    sweep w = {.s = s, .tau = tau, .radiance = radiance, .flux = flux};
    w.c.at = (pps_grid){s->n_depths, 0, s->n_phi, tau, w.mu, s->phi};
    w.c.streams = s->streams;
    w.c.nodes = s->nodes;
    for (size_t a = 0; a < s->n_albedo && !status; a++) {
        for (size_t g = 0; g < s->n_g && !status; g++) {
            w.c.slab = (pps_slab){s->albedo[a], s->g[g], s->thickness[0]};
            w.c.orders = s->n_phi == 0 ? 1 : s->g[g] == 0 ? 0 : s->streams;
            w.c.at.n_mu = 0;
            status = sweep_slab(&w);
        }
    }
    free(tau);
    *seconds = now() - start;
    return (int)status;
}
