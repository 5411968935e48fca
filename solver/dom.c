/* Discrete ordinates: create, thickness, beam. The eigenproblem is in modes.c, the boundary
 * in boundary.c, the outputs in flux.c and radiance.c.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/dom.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/legendre.h"
#include "core/quadrature.h"
#include "core/vector.h"

/* Above this smallest node the eigenproblem may be squared: sqrt(eps) k_max stays well
 * below the k that matter. */
static const double SQUARED_NODE = 1e-3;

static bool opts_valid(const pps_dom_opts *o) {
    bool streams = o->streams == 0 || (o->streams >= 2 && o->streams % 2 == 0 &&
                                       o->streams <= PPS_STREAMS_MAX);
    bool enums = o->nodes >= PPS_NODES_AUTO && o->nodes <= PPS_NODES_GRADED &&
                 o->delta_m >= PPS_DELTA_M_AUTO && o->delta_m <= PPS_DELTA_M_OFF;
    bool clash = o->delta_m == PPS_DELTA_M_OFF && o->nodes > PPS_NODES_GAUSS;
    return streams && enums && !clash && o->orders >= 0 && o->tolerance >= 0 &&
           o->tolerance < 1;
}

/* Moments l < L that the nodes carry. Beyond, the Legendre functions lose their
 * orthogonality on them: Gauss nodes carry 2n, the others, coarser about mu = 1, fewer. */
static int moments_for(pps_nodes nodes, int streams) {
    int n_moments = nodes == PPS_NODES_GAUSS    ? streams
                    : nodes == PPS_NODES_MAPPED ? streams * 7 / 8
                                                : streams * 5 / 8;
    return n_moments > 2 ? n_moments : 2;
}

pps_nodes pps_dom_choose_nodes(const pps_slab *slab, int streams) {
    /* Mapped nodes converge exponentially and see grazing directions, but carry fewer
     * moments: they win where these resolve the phase function as well as Gauss nodes do
     * the grazing directions (errors fall as streams^-3 or faster), and always in thin
     * slabs, where those directions matter most. In very thin slabs few moments matter,
     * as single scattering is taken exactly. The factors: tests/test_dom.c. */
    if (slab->thickness < 0.01) {
        return PPS_NODES_GRADED;
    }
    double left_out = pow(fabs(slab->g), moments_for(PPS_NODES_MAPPED, streams));
    double seen = pow(16.0 / streams, 3);
    bool mapped = slab->thickness < 0.1 ||
                  (slab->thickness < 1 ? left_out < 1e-3 * seen
                                       : streams > 8 && left_out < 2e-5 * seen);
    return mapped ? PPS_NODES_MAPPED : PPS_NODES_GAUSS;
}

int pps_dom_orders_for(double g, double tolerance, int n_moments) {
    /* Orders m >= 1 enter by multiple scattering alone (single scattering is summed in
     * closed form), so that order m is of the size of g^(2m). */
    double digits = log(100 / tolerance);
    double needed = g == 0 ? 1 : 4 + ceil(digits / (-2 * log(fabs(g))));
    return needed < n_moments ? (int)needed : n_moments;
}

/* Delta-M: moments (g^l - f)/(1 - f) with f the first moment left out. */
static void scale_peak(pps_dom *dom, bool scaled) {
    pps_discrete *d = &dom->discrete;
    double albedo = dom->slab.albedo, power = 1;
    dom->f = scaled ? pow(dom->slab.g, d->n_moments) : 0;
    dom->stretch = 1 - albedo * dom->f;
    d->albedo = albedo * (1 - dom->f) / dom->stretch;
    d->co_albedo = (1 - albedo) / dom->stretch;
    for (int l = 0; l < d->n_moments; l++) {
        d->strength[l] = (2 * l + 1) * (power - dom->f) / (1 - dom->f);
        power *= dom->slab.g;
    }
}

static void quadrature_bias(pps_discrete *d, pps_nodes nodes) {
    double p[PPS_STREAMS_MAX];
    memset(d->bias, 0, (size_t)d->n_moments * sizeof *d->bias);
    for (int i = 0; nodes != PPS_NODES_GAUSS && i < d->n; i++) {
        pps_legendre(0, d->n_moments, d->mu[i], p);
        for (int l = 2; l < d->n_moments; l += 2) {
            d->bias[l] += d->weight[i] * p[l];
        }
    }
}

static pps_status discretise(pps_dom *dom, int streams, bool scaled) {
    pps_discrete *d = &dom->discrete;
    d->n = streams / 2;
    d->n_moments = moments_for(dom->nodes, streams);
    size_t n = (size_t)d->n;
    d->mu = malloc((3 * n + 2 * (size_t)d->n_moments) * sizeof *d->mu);
    if (!d->mu) {
        return PPS_ERR_MEMORY;
    }
    d->weight = d->mu + n;
    d->root_weight = d->weight + n;
    d->strength = d->root_weight + n;
    d->bias = d->strength + d->n_moments;
    pps_hemisphere_nodes(dom->nodes, d->n, d->mu, d->weight);
    for (int i = 0; i < d->n; i++) {
        d->root_weight[i] = sqrt(d->weight[i]);
    }
    quadrature_bias(d, dom->nodes);
    d->squared = d->mu[0] > SQUARED_NODE;
    scale_peak(dom, scaled);
    return PPS_OK;
}

double pps_dom_scaled_thickness(const pps_dom *dom) {
    return dom->slab.thickness * dom->stretch;
}

/* Eigenproblems and factors of the orders below n_orders. */
static pps_status prepare_orders(pps_dom *dom, int n_orders) {
    while (dom->n_ready < n_orders) {
        pps_order *order = &dom->order[dom->n_ready];
        pps_status status = pps_order_create(order, &dom->discrete, dom->n_ready);
        if (!status) {
            status = pps_order_set_thickness(order, pps_dom_scaled_thickness(dom));
            if (status) {
                pps_order_free(order);
            }
        }
        if (status) {
            return status;
        }
        dom->n_ready++;
    }
    return PPS_OK;
}

pps_status pps_dom_create(const pps_slab *slab, const pps_dom_opts *opts,
                          pps_dom **out) {
    static const pps_dom_opts defaults = {0};
    const pps_dom_opts *o = opts ? opts : &defaults;
    *out = NULL;
    if (pps_slab_check(slab) || !opts_valid(o)) {
        return PPS_ERR_ARGUMENT;
    }
    if (o->delta_m == PPS_DELTA_M_ON && slab->g < 0) {
        return PPS_ERR_UNSUPPORTED;
    }
    pps_dom *dom = calloc(1, sizeof *dom);
    if (!dom) {
        return PPS_ERR_MEMORY;
    }
    dom->slab = *slab;
    dom->corrected = o->delta_m != PPS_DELTA_M_OFF;
    dom->tolerance = o->tolerance > 0 ? o->tolerance : 1e-15;
    int streams = o->streams > 0 ? o->streams : 32;
    dom->nodes = o->nodes;
    if (o->nodes == PPS_NODES_AUTO) {
        dom->nodes =
            dom->corrected ? pps_dom_choose_nodes(slab, streams) : PPS_NODES_GAUSS;
    }
    pps_status status = discretise(dom, streams, dom->corrected && slab->g > 0);
    if (!status) {
        int most = dom->discrete.n_moments;
        int orders = o->orders < most ? o->orders : most;
        if (orders == 0) {
            orders = pps_dom_orders_for(slab->g, dom->tolerance, most);
        }
        dom->n_orders = orders;
        dom->order = calloc((size_t)orders, sizeof *dom->order);
        status = dom->order ? prepare_orders(dom, 1) : PPS_ERR_MEMORY;
    }
    if (status) {
        pps_dom_free(dom);
        return status;
    }
    *out = dom;
    return PPS_OK;
}

void pps_dom_free(pps_dom *dom) {
    if (!dom) {
        return;
    }
    for (int m = 0; m < dom->n_ready; m++) {
        pps_order_free(&dom->order[m]);
    }
    free(dom->order);
    free(dom->discrete.mu);
    free(dom->beams.mu0);
    pps_view_free(dom->view);
    free(dom->scratch);
    free(dom);
}

pps_status pps_dom_want_orders(pps_dom *dom, int n_orders, double tolerance) {
    int most = dom->discrete.n_moments;
    n_orders = n_orders < most ? n_orders : most;
    dom->tolerance = tolerance > 0 ? tolerance : dom->tolerance;
    if (n_orders <= dom->n_orders) {
        return PPS_OK;
    }
    pps_order *order = calloc((size_t)n_orders, sizeof *order);
    if (!order) {
        return PPS_ERR_MEMORY;
    }
    memcpy(order, dom->order, (size_t)dom->n_ready * sizeof *order);
    free(dom->order);
    dom->order = order;
    dom->n_orders = n_orders;
    return PPS_OK;
}

pps_status pps_dom_set_thickness(pps_dom *dom, double thickness) {
    if (!(thickness > 0)) {
        return PPS_ERR_ARGUMENT;
    }
    dom->slab.thickness = thickness;
    dom->beams.n = 0;
    for (int m = 0; m < dom->n_ready; m++) {
        pps_status status =
            pps_order_set_thickness(&dom->order[m], pps_dom_scaled_thickness(dom));
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

pps_status pps_dom_set_directions(pps_dom *dom, size_t n_mu, const double *mu) {
    pps_view *view = NULL;
    pps_status status = pps_grid_check(&(pps_grid){.n_mu = n_mu, .mu = mu}, 1);
    if (!status && n_mu > 0) {
        status = pps_view_create(n_mu, mu, &view);
    }
    if (!status && view) {
        status = pps_view_keep(view, dom->n_ready, dom->order, &dom->discrete);
    }
    if (status) {
        pps_view_free(view);
        return status;
    }
    pps_view_free(dom->view);
    dom->view = view;
    return PPS_OK;
}

/* ---- beams ---- */

/* Room for n beams in the handle. */
static pps_status reserve_beams(pps_dom *dom, size_t n) {
    pps_beams *beams = &dom->beams;
    size_t padded = pps_padded(n);
    if (padded > dom->capacity) {
        double *memory = malloc(3 * padded * sizeof *memory);
        double *scratch =
            malloc(pps_order_scratch(&dom->discrete, padded) * sizeof *scratch);
        if (!memory || !scratch) {
            free(memory);
            free(scratch);
            return PPS_ERR_MEMORY;
        }
        free(beams->mu0);
        free(dom->scratch);
        dom->scratch = scratch;
        dom->capacity = padded;
        beams->mu0 = memory;
        dom->n_lit = 0;
    }
    beams->q = beams->mu0 + dom->capacity;
    beams->decay = beams->q + dom->capacity;
    return PPS_OK;
}

static pps_status reserve_orders(pps_dom *dom, int n_orders) {
    pps_status status = prepare_orders(dom, n_orders);
    for (int m = 0; m < n_orders && !status; m++) {
        status = pps_order_reserve(&dom->order[m], pps_padded(dom->n_wanted));
    }
    if (!status && dom->view) {
        status = pps_view_keep(dom->view, n_orders, dom->order, &dom->discrete);
    }
    return status;
}

/* The beams, padded with copies of the first; whether they are those of last time. */
static bool set_beams(pps_dom *dom, size_t n, const double *mu0, bool sky) {
    pps_beams *beams = &dom->beams;
    bool same = dom->n_lit > 0 && dom->n_wanted == n && beams->sky == sky &&
                memcmp(beams->mu0, mu0, n * sizeof *mu0) == 0;
    beams->padded = pps_padded(n);
    beams->sky = sky;
    for (size_t b = 0; b < beams->padded; b++) {
        beams->mu0[b] = mu0[b < n ? b : 0];
        beams->q[b] = 1 / beams->mu0[b];
        beams->decay[b] = exp(-beams->q[b] * pps_dom_scaled_thickness(dom));
    }
    return same;
}

static pps_status solve(pps_dom *dom, size_t n, const double *mu0, bool sky) {
    bool azimuth = false;
    for (size_t b = 0; b < n; b++) {
        azimuth = azimuth || (!sky && mu0[b] < 1);
    }
    int n_orders = azimuth ? dom->n_orders : 1;
    dom->beams.n = 0;
    pps_status status = reserve_beams(dom, n);
    bool same = !status && set_beams(dom, n, mu0, sky);
    dom->n_wanted = n;
    if (!same) {
        dom->n_lit = 0;
    }
    if (!status) {
        status = reserve_orders(dom, n_orders);
    }
    if (status) {
        return status;
    }
    dom->beams.n = n;
    for (int m = 0; m < n_orders; m++) {
        if (m >= dom->n_lit) {
            pps_order_light(&dom->order[m], &dom->discrete, &dom->beams, dom->scratch);
        }
        pps_order_solve(&dom->order[m], pps_dom_scaled_thickness(dom), &dom->beams,
                        dom->scratch);
    }
    dom->n_lit = n_orders > dom->n_lit ? n_orders : dom->n_lit;
    dom->n_solved = n_orders;
    return PPS_OK;
}

pps_status pps_dom_solve_beams(pps_dom *dom, size_t n, const double *mu0) {
    if (n == 0 || !mu0) {
        return PPS_ERR_ARGUMENT;
    }
    for (size_t b = 0; b < n; b++) {
        if (pps_mu0_check(mu0[b])) {
            return PPS_ERR_ARGUMENT;
        }
    }
    return solve(dom, n, mu0, false);
}

pps_status pps_dom_solve(pps_dom *dom, double mu0) {
    return pps_dom_solve_beams(dom, 1, &mu0);
}

pps_status pps_dom_solve_sky(pps_dom *dom) {
    double mu0 = 1; /* of no meaning */
    return solve(dom, 1, &mu0, true);
}

pps_status pps_dom_nodes(const pps_dom *dom, double *mu, double *weight) {
    size_t bytes = (size_t)dom->discrete.n * sizeof *mu;
    memcpy(mu, dom->discrete.mu, bytes);
    memcpy(weight, dom->discrete.weight, bytes);
    return PPS_OK;
}

pps_status pps_dom_eigenvalues(const pps_dom *dom, int m, double *k) {
    if (m < 0 || m >= dom->n_orders) {
        return PPS_ERR_ARGUMENT;
    }
    size_t bytes = (size_t)dom->discrete.n * sizeof *k;
    if (m < dom->n_ready) {
        memcpy(k, dom->order[m].k, bytes);
        return PPS_OK;
    }
    pps_order order;
    pps_status status = pps_order_create(&order, &dom->discrete, m);
    if (!status) {
        memcpy(k, order.k, bytes);
        pps_order_free(&order);
    }
    return status;
}

void pps_dom_query(const pps_dom *dom, pps_dom_info *info) {
    *info = (pps_dom_info){
        .streams = 2 * dom->discrete.n,
        .orders = dom->n_orders,
        .moments = dom->discrete.n_moments,
        .nodes = dom->nodes,
        .delta_fraction = dom->f,
        .diffusion_exponent = dom->order[0].k[0] * dom->stretch,
    };
}
