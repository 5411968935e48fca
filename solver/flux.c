/* Fluxes and mean intensities: sums over the modes of order 0, by nodes next to an edge,
 * and with exact single scattering in thin slabs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "core/lanes.h"
#include "core/series.h"
#include "solver/dom.h"
#include "solver/thin.h"
#include <ppscat/expdiff.h>

static const double PI = 3.14159265358979323846;

/* A block of beams at one scaled depth: sums over modes. */
typedef struct {
    double even[PPS_LANES], odd[PPS_LANES];  /* (down + up) and (down - up), over 2 */
    double mean[PPS_LANES], size[PPS_LANES]; /* mean intensity; |even| + |odd| summed */
} mode_sums;

/* What psi_j and phi_j of a mode add to them. */
typedef struct {
    double even, odd, mean;
} mode_weights;

/* V of l = 0 is the mean intensity, W of l = 1 the net flux of mode j. */
static inline mode_weights weights_of(const pps_order *order, size_t j) {
    return (mode_weights){.even = PI * order->flux_s[j],
                          .odd = PI * order->w[j * (size_t)order->n_odd],
                          .mean = order->v[j * (size_t)order->n_even] / 2};
}

/* The same for half a block, in registers. */
typedef struct {
    four even, odd, mean, size;
} four_sums;

PPS_LANE four_sums sums_at(const mode_sums *sum, size_t at) {
    return (four_sums){four_at(sum->even + at), four_at(sum->odd + at),
                       four_at(sum->mean + at), four_at(sum->size + at)};
}

PPS_LANE void sums_to(mode_sums *sum, size_t at, const four_sums *value) {
    four_to(sum->even + at, value->even);
    four_to(sum->odd + at, value->odd);
    four_to(sum->mean + at, value->mean);
    four_to(sum->size + at, value->size);
}

PPS_LANE void add_mode(const mode_weights *of, four psi, four phi, four_sums *sum) {
    four even = of->even * psi, odd = of->odd * phi;
    sum->even += even;
    sum->odd += odd;
    sum->mean += of->mean * psi;
    sum->size += four_abs(even) + four_abs(odd);
}

PPS_CLONES static void add_values(size_t n, const mode_weights *of, const double *psi,
                                  const double *phi, mode_sums *sum) {
    for (size_t at = 0; at < n; at += FOUR) {
        four_sums part = sums_at(sum, at);
        add_mode(of, four_at(psi + at), four_at(phi + at), &part);
        sums_to(sum, at, &part);
    }
}

/* What the loops below work on: beams first .. first + PPS_LANES - 1 (fewer at the end). */
typedef struct {
    const pps_dom *dom;
    size_t first, n;
} beam_block;

/* Depths that are handled together. */
enum { DEPTHS = 16 };

/* Modes k w < 1: from the series of the nearer edge. */
static void sum_series(const beam_block *block, size_t n_tau, const double *tau,
                       mode_sums *sum) {
    const pps_order *order = &block->dom->order[0];
    const pps_beams *beams = &block->dom->beams;
    const pps_solution *s = &order->solution;
    double w = pps_dom_scaled_thickness(block->dom), one[PPS_LANES];
    double a[2][PPS_SERIES_TERMS * PPS_LANES], b[2][PPS_SERIES_TERMS * PPS_LANES];
    for (int l = 0; l < PPS_LANES; l++) {
        one[l] = 1;
    }
    for (size_t j = 0; j < (size_t)order->n_series; j++) {
        mode_weights of = weights_of(order, j);
        size_t at = j * beams->padded + block->first;
        for (int side = 0; side < 2; side++) {
            pps_series series = {.n = block->n,
                                 .q = beams->q + block->first,
                                 .beam = side ? beams->decay + block->first : one,
                                 .alpha = s->source_a + at,
                                 .beta = s->source_b + at,
                                 .psi = s->edge_psi[side] + at,
                                 .phi = s->edge_phi[side] + at};
            pps_series_expand(&series, side ? -w : w, order->k[j], a[side], b[side]);
        }
        for (size_t k = 0; k < n_tau; k++) {
            double psi[PPS_LANES], phi[PPS_LANES];
            int side = tau[k] > w / 2;
            double u = (side ? w - tau[k] : tau[k]) / w;
            pps_series_value(block->n, a[side], b[side], u, psi, phi);
            add_values(block->n, &of, psi, phi, &sum[k]);
        }
    }
}

/* Depths of one call, scaled, and what all beams share there: e^(-k tau) of every mode,
 * then e^(-k (w - tau)) of every mode, a row a depth. */
typedef struct {
    size_t n;
    double tau[DEPTHS], scaled[DEPTHS];
    double decay[DEPTHS * PPS_STREAMS_MAX];
} depths;

static void depths_at(const pps_dom *dom, size_t n_tau, const double *tau, depths *at) {
    const pps_order *order = &dom->order[0];
    size_t n = (size_t)order->n;
    double w = pps_dom_scaled_thickness(dom), *exponent = at->decay;
    at->n = n_tau;
    for (size_t k = 0; k < n_tau; k++, exponent += 2 * n) {
        at->tau[k] = tau[k];
        at->scaled[k] = tau[k] * dom->stretch;
        for (size_t j = 0; j < n; j++) {
            double k_j = order->k[j];
            exponent[j] = -k_j * at->scaled[k];
            exponent[n + j] = isinf(w) ? -HUGE_VAL : -k_j * (w - at->scaled[k]);
        }
    }
    pps_exp_array(n_tau * 2 * n, at->decay, at->decay);
}

/* The exponentials, homogeneous of modes k w >= 1 and particular of all. */
PPS_CLONES static void sum_exponentials(const pps_order *order, size_t padded,
                                        size_t first, size_t n, const double *decay,
                                        const double *eqt, mode_sums *out) {
    const pps_solution *s = &order->solution;
    size_t n_modes = (size_t)order->n;
    for (size_t at = 0; at < n; at += FOUR) {
        four_sums sum = sums_at(out, at);
        four beam = four_at(eqt + at);
        for (size_t j = 0; j < n_modes; j++) {
            size_t i = j * padded + first + at;
            mode_weights of = weights_of(order, j);
            four falls = four_at(s->c1 + i) * decay[j];
            four grows = four_at(s->c2 + i) * decay[n_modes + j];
            four psi = (falls + grows) + four_at(s->p + i) * beam;
            four phi = order->k[j] * (falls - grows) + four_at(s->r + i) * beam;
            add_mode(&of, psi, phi, &sum);
        }
        sums_to(out, at, &sum);
    }
}

/* What the loops above leave of a special mode: of a resonant one p Theta and k p Theta,
 * from exponentials that are known; ekt = e^(-k tau), eqt = e^(-q tau). */
static void special_state(const pps_mode *mode, double tau, double ekt, double eqt,
                          double *psi, double *phi) {
    if (mode->kind == PPS_MODE_RESONANT) {
        double theta = pps_exp1_known(tau, mode->k, mode->q, ekt, eqt);
        *psi = mode->p * theta;
        *phi = mode->k * *psi;
    } else {
        pps_mode_state(mode, tau, psi, phi);
    }
}

/* The special modes, one by one; e^(-k tau) of every mode, e^(-q tau) of the beams. */
static void sum_special(const beam_block *block, double tau, const double *decay,
                        const double *eqt, mode_sums *sum) {
    const pps_solution *s = &block->dom->order[0].solution;
    for (size_t i = 0; i < s->n_special; i++) {
        const pps_special *special = &s->special[i];
        if (special->beam < block->first || special->beam >= block->first + block->n) {
            continue;
        }
        mode_weights of = weights_of(&block->dom->order[0], (size_t)special->j);
        size_t l = special->beam - block->first;
        double psi, phi;
        special_state(&special->mode, tau, decay[special->j], eqt[l], &psi, &phi);
        sum->even[l] += of.even * psi;
        sum->odd[l] += of.odd * phi;
        sum->mean[l] += of.mean * psi;
        sum->size[l] += fabs(of.even * psi) + fabs(of.odd * phi);
    }
}

/* ---- next to an edge ---- */

/* A hemispheric flux near the edge where it starts from 0, as the sum over nodes of
 * radiances integrated along their rays: no cancellation, but n times the work. */
static double flux_by_nodes(const pps_dom *dom, size_t b, double tau, double sign) {
    enum { MOST = PPS_STREAMS_MAX / 2 };
    const pps_discrete *d = &dom->discrete;
    const pps_order *order = &dom->order[0];
    double w = pps_dom_scaled_thickness(dom), sum = 0;
    double mu0 = dom->beams.mu0[b];
    pps_mode mode[MOST];
    pps_mode_depth at[MOST];
    for (int j = 0; j < d->n; j++) {
        mode[j] = pps_order_mode(order, j, w, &dom->beams, b);
        at[j] = pps_mode_at(&mode[j], tau);
    }
    for (int first = 0; first < d->n; first += PPS_LANES) {
        double mu[PPS_LANES], legendre[PPS_STREAMS_MAX * PPS_LANES];
        double ge[MOST * PPS_LANES], go[MOST * PPS_LANES];
        for (int l = 0; l < PPS_LANES; l++) {
            mu[l] = d->mu[first + l < d->n ? first + l : first];
        }
        pps_order_project(order, d, PPS_LANES, mu, ge, go, legendre);
        for (int l = 0; l < PPS_LANES && first + l < d->n; l++) {
            pps_ray ray;
            pps_ray_init(&ray, w, dom->beams.q[b], tau, sign * mu[l]);
            double radiance =
                dom->beams.sky ? (ray.down ? ray.ect : 0)
                               : pps_discrete_single(d, sign * mu[l], mu0) * ray.beam;
            for (int j = 0; j < d->n; j++) {
                double psi, phi;
                pps_mode_ray(&mode[j], &ray, &at[j], &psi, &phi);
                radiance +=
                    ge[j * PPS_LANES + l] * psi + sign * go[j * PPS_LANES + l] * phi;
            }
            sum += d->weight[first + l] * mu[l] * radiance;
        }
    }
    return 2 * PI * sum;
}

/* Below this share of its parts a flux is recomputed by flux_by_nodes. */
static const double CANCELLED = 1e-3;

static double flux_down(const pps_dom *dom, size_t b, double tau, double flux,
                        double size) {
    if (tau <= 0) {
        return dom->beams.sky ? PI : 0; /* what falls in */
    }
    return fabs(flux) >= CANCELLED * size ? flux : flux_by_nodes(dom, b, tau, 1);
}

static double flux_up(const pps_dom *dom, size_t b, double tau, double flux,
                      double size) {
    if (tau >= pps_dom_scaled_thickness(dom)) {
        return 0; /* nothing comes up from below */
    }
    return fabs(flux) >= CANCELLED * size ? flux : flux_by_nodes(dom, b, tau, -1);
}

/* ---- all together ---- */

/* The beams at the depths, without gaps: beam l at depth k stands at [k * n + l], n beams
 * in the block, and a few more may be read. e^(-q tau), the same of the scaled depth, and
 * what delta-M left in the beam, which is diffuse light of the true problem: the
 * difference of the two. */
enum { MOST_HERE = DEPTHS * PPS_LANES + FOUR };
typedef struct {
    double direct[MOST_HERE], scaled[MOST_HERE], peak[MOST_HERE];
} beams_here;

PPS_CLONES static void beams_at(size_t n, const double *rates, size_t n_tau,
                                const double *tau, const double *scaled,
                                beams_here *beams) {
    size_t all = n * n_tau;
    for (size_t k = 0; k < n_tau; k++) {
        for (size_t l = 0; l < n; l++) { /* their exponents */
            beams->scaled[k * n + l] = -rates[l] * scaled[k];
            beams->peak[k * n + l] = rates[l] * (tau[k] - scaled[k]);
        }
    }
    for (size_t l = 0; l < FOUR; l++) {
        beams->scaled[all + l] = beams->peak[all + l] = 0;
    }
    for (size_t at = 0; at < all; at += FOUR) {
        four here = four_exp(four_at(beams->scaled + at));
        four z = four_at(beams->peak + at), root = four_exp(-z / 2);
        four_to(beams->direct + at, here * (root * root));
        four_to(beams->scaled + at, here);
        four_to(beams->peak + at, here * (z * four_decay_mean(z, root)));
    }
}

/* Beam l of the block, which stands at [here] of `beams`. */
static pps_flux flux_of_beam(const beam_block *block, size_t l, double tau,
                             const mode_sums *sum, const beams_here *beams, size_t here,
                             const pps_thin *thin) {
    const pps_dom *dom = block->dom;
    size_t b = block->first + l;
    double mu0 = dom->beams.mu0[b], scaled = tau * dom->stretch;
    double direct = dom->beams.sky ? 0 : beams->direct[here];
    pps_flux flux = {
        .down = flux_down(dom, b, scaled, sum->even[l] + sum->odd[l], sum->size[l]),
        .up = flux_up(dom, b, scaled, sum->even[l] - sum->odd[l], sum->size[l]),
        .direct = mu0 * direct,
        .mean_diffuse = sum->mean[l],
    };
    if (thin) {
        pps_thin_correct(thin, b, tau, &flux);
    } else if (!dom->beams.sky) {
        flux.down += mu0 * beams->peak[here];
        flux.mean_diffuse += beams->peak[here] / (4 * PI);
    }
    flux.mean = flux.mean_diffuse + direct / (4 * PI);
    return flux;
}

/* flux[l * stride + k]. */
static void block_fluxes(const beam_block *block, const depths *at,
                         const pps_thin *thin, size_t stride, pps_flux *flux) {
    const pps_dom *dom = block->dom;
    mode_sums sum[DEPTHS];
    beams_here beams;
    memset(sum, 0, at->n * sizeof *sum);
    if (dom->order[0].n_series > 0) {
        sum_series(block, at->n, at->scaled, sum);
    }
    beams_at(block->n, dom->beams.q + block->first, at->n, at->tau, at->scaled, &beams);
    for (size_t k = 0; k < at->n; k++) {
        size_t here = k * block->n;
        const double *decay = at->decay + k * 2 * (size_t)dom->order[0].n;
        sum_exponentials(&dom->order[0], dom->beams.padded, block->first, block->n,
                         decay, beams.scaled + here, &sum[k]);
        sum_special(block, at->scaled[k], decay, beams.scaled + here, &sum[k]);
        for (size_t l = 0; l < block->n; l++) {
            flux[l * stride + k] =
                flux_of_beam(block, l, at->tau[k], &sum[k], &beams, here + l, thin);
        }
    }
}

/* All beams at up to DEPTHS depths. */
static void fluxes_at(const pps_dom *dom, const pps_thin *thin, size_t n_tau,
                      const double *tau, size_t stride, pps_flux *flux) {
    depths at;
    depths_at(dom, n_tau, tau, &at);
    for (size_t b = 0; b < dom->beams.n; b += PPS_LANES) {
        size_t left = dom->beams.n - b;
        beam_block block = {dom, b, left < PPS_LANES ? left : PPS_LANES};
        block_fluxes(&block, &at, thin, stride, flux + b * stride);
    }
}

pps_status pps_dom_flux(const pps_dom *dom, size_t n, const double *tau,
                        pps_flux *flux) {
    if (dom->beams.n == 0 || !flux || pps_tau_check(n, tau, dom->slab.thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    pps_thin *thin = NULL;
    if (pps_thin_applies(dom) && pps_thin_create(dom, &thin)) {
        return PPS_ERR_MEMORY;
    }
    for (size_t k = 0; k < n; k += DEPTHS) {
        fluxes_at(dom, thin, n - k < DEPTHS ? n - k : DEPTHS, tau + k, n, flux + k);
    }
    pps_thin_free(thin);
    return PPS_OK;
}
