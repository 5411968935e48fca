/* Thin slabs: what the discrete problem has of single scattering, replaced by all of it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/thin.h"

#include <math.h>
#include <stdlib.h>

#include "core/beam.h"
#include "core/hemisphere.h"
#include "core/vector.h"

static const double PI = 3.14159265358979323846;
static const double THIN = 0.1; /* optical thickness */

struct pps_thin {
    const pps_dom *dom;
    size_t padded;    /* nodes, in whole blocks; the last ones weigh nothing */
    double *mu;       /* padded */
    double *weight;   /* padded */
    double *phase[2]; /* a row of nodes a beam: albedo p upwards, downwards */
    double *scale;    /* a beam: multiple scattering, exact over discrete */
    double *integral; /* padded: scratch */
};

bool pps_thin_applies(const pps_dom *dom) {
    return dom->corrected && !dom->beams.sky && dom->slab.thickness < THIN;
}

/* albedo / 4pi sum of strength_l P_l(mu_i) P_l(mu0) of nodes both ways: sums of even and
 * of odd l. legendre: n_moments rows of nodes; at0: P_l(mu0). */
PPS_CLONES static void phases(const pps_discrete *d, size_t padded,
                              const double *legendre, const double *at0,
                              double *restrict up, double *restrict down) {
    for (size_t i = 0; i < padded; i++) {
        up[i] = down[i] = 0;
    }
    for (int l = 0; l < d->n_moments; l++) {
        double factor = d->albedo / (4 * PI) * d->strength[l] * at0[l];
        double *sum = l % 2 ? up : down; /* odd, even */
        for (size_t i = 0; i < padded; i++) {
            sum[i] += factor * legendre[(size_t)l * padded + i];
        }
    }
    for (size_t i = 0; i < padded; i++) {
        double even = down[i], odd = up[i];
        down[i] = even + odd;
        up[i] = even - odd;
    }
}

/* What the discrete problem has of single scattering in one hemisphere. */
static pps_hemisphere discrete_single(const pps_thin *thin, size_t b, double scaled,
                                      int down) {
    const pps_dom *dom = thin->dom;
    double rest = pps_dom_scaled_thickness(dom) - scaled;
    const double *phase = thin->phase[down] + b * thin->padded;
    pps_hemisphere sum = {0};
    pps_beam_integrals(dom->beams.mu0[b], scaled, rest, down, thin->padded, thin->mu,
                       thin->integral);
    for (int i = 0; i < dom->discrete.n; i++) {
        double part = thin->weight[i] * thin->integral[i] * phase[i];
        sum.flux += 2 * PI * thin->mu[i] * part;
        sum.mean += part / 2;
    }
    return sum;
}

static pps_hemisphere exact_single(const pps_dom *dom, double mu0, double tau,
                                   int down) {
    const pps_slab *slab = &dom->slab;
    pps_hemisphere h = pps_single_hemisphere(slab->g, mu0, slab->thickness, tau, down);
    return (pps_hemisphere){slab->albedo * h.flux, slab->albedo * h.mean};
}

/* What is scattered once and meets the slab again, exact over discrete. */
static double multiple_scale(const pps_thin *thin, size_t b) {
    const pps_dom *dom = thin->dom;
    double mu0 = dom->beams.mu0[b], w = dom->slab.thickness, scaled = w * dom->stretch;
    double exact = -dom->slab.albedo * mu0 * expm1(-w / mu0) -
                   exact_single(dom, mu0, 0, 0).flux -
                   exact_single(dom, mu0, w, 1).flux;
    double discrete = -dom->discrete.albedo * mu0 * expm1(-scaled / mu0) -
                      discrete_single(thin, b, 0, 0).flux -
                      discrete_single(thin, b, scaled, 1).flux;
    return exact > 0 && discrete > 0 ? exact / discrete : 1;
}

static pps_status thin_alloc(pps_thin *thin) {
    size_t beams = thin->dom->beams.n, padded = thin->padded;
    thin->mu = malloc((3 * padded + 2 * beams * padded + beams) * sizeof *thin->mu);
    if (!thin->mu) {
        return PPS_ERR_MEMORY;
    }
    thin->weight = thin->mu + padded;
    thin->integral = thin->weight + padded;
    thin->phase[0] = thin->integral + padded;
    thin->phase[1] = thin->phase[0] + beams * padded;
    thin->scale = thin->phase[1] + beams * padded;
    return PPS_OK;
}

static pps_status fill(pps_thin *thin) {
    const pps_dom *dom = thin->dom;
    const pps_discrete *d = &dom->discrete;
    size_t padded = thin->padded, moments = (size_t)d->n_moments;
    double *legendre = malloc(moments * (padded + 1) * sizeof *legendre);
    if (!legendre) {
        return PPS_ERR_MEMORY;
    }
    double *at0 = legendre + moments * padded;
    for (size_t i = 0; i < padded; i++) {
        bool is_node = i < (size_t)d->n;
        thin->mu[i] = d->mu[is_node ? i : 0];
        thin->weight[i] = is_node ? d->weight[i] : 0;
    }
    pps_discrete_legendre(d, 0, padded, thin->mu, legendre);
    for (size_t b = 0; b < dom->beams.n; b++) {
        pps_discrete_legendre(d, 0, 1, &dom->beams.mu0[b], at0);
        phases(d, padded, legendre, at0, thin->phase[0] + b * padded,
               thin->phase[1] + b * padded);
        thin->scale[b] = multiple_scale(thin, b);
    }
    free(legendre);
    return PPS_OK;
}

pps_status pps_thin_create(const pps_dom *dom, pps_thin **out) {
    pps_thin *thin = calloc(1, sizeof *thin);
    *out = NULL;
    if (!thin) {
        return PPS_ERR_MEMORY;
    }
    thin->dom = dom;
    thin->padded = pps_padded((size_t)dom->discrete.n);
    pps_status status = thin_alloc(thin);
    if (!status) {
        status = fill(thin);
    }
    if (status) {
        pps_thin_free(thin);
        return status;
    }
    *out = thin;
    return PPS_OK;
}

void pps_thin_free(pps_thin *thin) {
    if (thin) {
        free(thin->mu);
        free(thin);
    }
}

void pps_thin_correct(const pps_thin *thin, size_t b, double tau, pps_flux *flux) {
    double mu0 = thin->dom->beams.mu0[b], mean = 0;
    for (int down = 0; down < 2; down++) {
        pps_hemisphere exact = exact_single(thin->dom, mu0, tau, down);
        pps_hemisphere discrete =
            discrete_single(thin, b, tau * thin->dom->stretch, down);
        double *hemisphere = down ? &flux->down : &flux->up;
        *hemisphere = exact.flux + thin->scale[b] * (*hemisphere - discrete.flux);
        flux->mean_diffuse -= discrete.mean;
        mean += exact.mean;
    }
    flux->mean_diffuse = mean + thin->scale[b] * flux->mean_diffuse;
}
