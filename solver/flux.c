/* Fluxes and mean intensities: sums over the modes of order 0, by nodes next to an edge,
 * and with exact single scattering in thin slabs.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "core/hemisphere.h"
#include "solver/dom.h"

static const double PI = 3.14159265358979323846;

/* Sums over modes at one scaled depth: the hemispheric fluxes and the mean intensity. */
typedef struct {
    double even, odd; /* (down + up) and (down - up), over 2 */
    double mean, size;
} mode_sums;

static mode_sums sum_modes(const pps_order *order, double tau) {
    mode_sums sum = {0};
    for (int j = 0; j < order->n; j++) {
        double psi, phi;
        pps_mode_state(&order->mode[j], tau, &psi, &phi);
        /* V of l = 0 is the mean intensity, W of l = 1 the net flux of mode j. */
        double even = PI * order->flux_s[j] * psi;
        double odd = PI * order->w[(size_t)j * (size_t)order->n_odd] * phi;
        sum.even += even;
        sum.odd += odd;
        sum.mean += order->v[(size_t)j * (size_t)order->n_even] * psi / 2;
        sum.size += fabs(even) + fabs(odd);
    }
    return sum;
}

/* A hemispheric flux near the edge where it starts from 0, as the sum over nodes of
 * radiances integrated along their rays: no cancellation, but n times the work. */
static double flux_by_nodes(const pps_dom *dom, double tau, double sign) {
    const pps_discrete *d = &dom->discrete;
    double sum = 0;
    for (int i = 0; i < d->n; i++) {
        double radiance = pps_dom_mean_radiance(dom, tau, sign * d->mu[i]);
        sum += d->weight[i] * d->mu[i] * radiance;
    }
    return 2 * PI * sum;
}

/* Below this share of its parts a flux is recomputed by flux_by_nodes. */
static const double CANCELLED = 1e-3;

static double flux_down(const pps_dom *dom, double tau, const mode_sums *sum) {
    double flux = sum->even + sum->odd;
    if (tau <= 0) {
        return dom->sky ? PI : 0; /* what falls in */
    }
    return fabs(flux) > CANCELLED * sum->size ? flux : flux_by_nodes(dom, tau, 1);
}

static double flux_up(const pps_dom *dom, double tau, const mode_sums *sum) {
    double flux = sum->even - sum->odd;
    if (tau >= dom->slab.thickness * dom->stretch) {
        return 0; /* nothing comes up from below */
    }
    return fabs(flux) > CANCELLED * sum->size ? flux : flux_by_nodes(dom, tau, -1);
}

/* Thin slabs. Single scattering dominates there, and directions mu ~ thickness, which no
 * node resolves, carry much of the mean intensity. Below this thickness fluxes and mean
 * intensity take their single-scattering part from the exact integral, as radiances
 * always do. What is left, multiple scattering, is scaled with the energy that single
 * scattering hands over to it, so that energy is conserved to rounding as before. */
static const double THIN = 0.1;

/* What the discrete problem has of single scattering in one hemisphere. */
static pps_hemisphere discrete_single(const pps_dom *dom, double scaled, int down) {
    const pps_discrete *d = &dom->discrete;
    pps_hemisphere sum = {0};
    for (int i = 0; i < d->n; i++) {
        pps_ray ray;
        double mu = down ? d->mu[i] : -d->mu[i];
        pps_ray_init(&ray, dom->slab.thickness * dom->stretch, 1 / dom->mu0, scaled,
                     mu);
        double part = d->weight[i] * ray.beam * pps_discrete_single(d, mu, dom->mu0);
        sum.flux += 2 * PI * d->mu[i] * part;
        sum.mean += part / 2;
    }
    return sum;
}

static pps_hemisphere exact_single(const pps_dom *dom, double tau, int down) {
    const pps_slab *slab = &dom->slab;
    pps_hemisphere h =
        pps_single_hemisphere(slab->g, dom->mu0, slab->thickness, tau, down);
    return (pps_hemisphere){slab->albedo * h.flux, slab->albedo * h.mean};
}

/* What is scattered once and meets the slab again, exact over discrete. */
static double multiple_scale(const pps_dom *dom) {
    double w = dom->slab.thickness, scaled = w * dom->stretch, mu0 = dom->mu0;
    double exact = -dom->slab.albedo * mu0 * expm1(-w / mu0) -
                   exact_single(dom, 0, 0).flux - exact_single(dom, w, 1).flux;
    double discrete = -dom->discrete.albedo * mu0 * expm1(-scaled / mu0) -
                      discrete_single(dom, 0, 0).flux -
                      discrete_single(dom, scaled, 1).flux;
    return exact > 0 && discrete > 0 ? exact / discrete : 1;
}

static void correct_single(const pps_dom *dom, double tau, double scale,
                           pps_flux *flux) {
    double mean = 0;
    for (int down = 0; down < 2; down++) {
        pps_hemisphere exact = exact_single(dom, tau, down);
        pps_hemisphere discrete = discrete_single(dom, tau * dom->stretch, down);
        double *hemisphere = down ? &flux->down : &flux->up;
        *hemisphere = exact.flux + scale * (*hemisphere - discrete.flux);
        flux->mean_diffuse -= discrete.mean;
        mean += exact.mean;
    }
    flux->mean_diffuse = mean + scale * flux->mean_diffuse;
}

static pps_flux flux_at(const pps_dom *dom, double tau, double thin_scale) {
    double mu0 = dom->mu0, scaled = tau * dom->stretch;
    double beam = dom->sky ? 0 : exp(-tau / mu0);
    mode_sums sum = sum_modes(&dom->order[0], scaled);
    pps_flux flux = {
        .down = flux_down(dom, scaled, &sum),
        .up = flux_up(dom, scaled, &sum),
        .direct = mu0 * beam,
        .mean_diffuse = sum.mean,
    };
    if (thin_scale > 0) {
        correct_single(dom, tau, thin_scale, &flux);
    } else if (!dom->sky) {
        /* What delta-M left in the beam is diffuse light of the true problem. */
        double peak = exp(-scaled / mu0) * -expm1(-(tau - scaled) / mu0);
        flux.down += mu0 * peak;
        flux.mean_diffuse += peak / (4 * PI);
    }
    flux.mean = flux.mean_diffuse + beam / (4 * PI);
    return flux;
}

pps_status pps_dom_flux(const pps_dom *dom, size_t n, const double *tau,
                        pps_flux *flux) {
    if (!(dom->mu0 > 0) || !flux || pps_tau_check(n, tau, dom->slab.thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    bool thin = dom->corrected && !dom->sky && dom->slab.thickness < THIN;
    double scale = thin ? multiple_scale(dom) : 0;
    for (size_t i = 0; i < n; i++) {
        flux[i] = flux_at(dom, tau[i], scale);
    }
    return PPS_OK;
}
