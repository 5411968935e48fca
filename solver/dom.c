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
    double p[PPS_STREAMS_MAX], sum[PPS_STREAMS_MAX] = {0};
    for (int i = 0; nodes != PPS_NODES_GAUSS && i < d->n; i++) {
        pps_legendre(0, d->n_moments, d->mu[i], p);
        for (int l = 2; l < d->n_moments; l += 2) {
            sum[l] += d->weight[i] * p[l];
        }
    }
    memcpy(d->bias, sum, (size_t)d->n_moments * sizeof *sum);
}

static pps_status discretise(pps_dom *dom, int streams, bool scaled) {
    pps_discrete *d = &dom->discrete;
    d->n = streams / 2;
    d->n_moments = moments_for(dom->nodes, streams);
    size_t n = (size_t)d->n;
    d->mu = malloc((2 * n + 2 * (size_t)d->n_moments) * sizeof *d->mu);
    if (!d->mu) {
        return PPS_ERR_MEMORY;
    }
    d->weight = d->mu + n;
    d->strength = d->weight + n;
    d->bias = d->strength + d->n_moments;
    pps_hemisphere_nodes(dom->nodes, d->n, d->mu, d->weight);
    quadrature_bias(d, dom->nodes);
    d->squared = d->mu[0] > SQUARED_NODE;
    scale_peak(dom, scaled);
    return PPS_OK;
}

static pps_status create_orders(pps_dom *dom, int wanted) {
    dom->order = calloc((size_t)wanted, sizeof *dom->order);
    dom->scratch = malloc(pps_order_scratch(&dom->discrete) * sizeof *dom->scratch);
    if (!dom->order || !dom->scratch) {
        return PPS_ERR_MEMORY;
    }
    for (int m = 0; m < wanted; m++) {
        pps_status status = pps_order_create(&dom->order[m], &dom->discrete, m);
        if (status) {
            return status;
        }
        dom->n_orders++;
    }
    return pps_dom_set_thickness(dom, dom->slab.thickness);
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
        status = create_orders(dom, orders);
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
    for (int m = 0; m < dom->n_orders; m++) {
        pps_order_free(&dom->order[m]);
    }
    free(dom->order);
    free(dom->discrete.mu);
    free(dom->scratch);
    free(dom);
}

pps_status pps_dom_set_thickness(pps_dom *dom, double thickness) {
    if (!(thickness > 0)) {
        return PPS_ERR_ARGUMENT;
    }
    dom->slab.thickness = thickness;
    dom->mu0 = 0;
    for (int m = 0; m < dom->n_orders; m++) {
        pps_status status =
            pps_order_set_thickness(&dom->order[m], thickness * dom->stretch);
        if (status) {
            return status;
        }
    }
    return PPS_OK;
}

pps_status pps_dom_solve(pps_dom *dom, double mu0) {
    if (pps_mu0_check(mu0)) {
        return PPS_ERR_ARGUMENT;
    }
    for (int m = 0; m < dom->n_orders; m++) {
        pps_order_solve(&dom->order[m], &dom->discrete,
                        dom->slab.thickness * dom->stretch, mu0, dom->scratch);
    }
    dom->mu0 = mu0;
    dom->sky = false;
    return PPS_OK;
}

pps_status pps_dom_solve_sky(pps_dom *dom) {
    pps_order_solve_sky(&dom->order[0], dom->slab.thickness * dom->stretch,
                        dom->scratch);
    dom->mu0 = 1;
    dom->sky = true;
    return PPS_OK;
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
    memcpy(k, dom->order[m].k, (size_t)dom->discrete.n * sizeof *k);
    return PPS_OK;
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
