/* Ray marching in closed form (SPP A.1).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "spp/march.h"

#include <math.h>

#include <ppscat/phase.h>

#include "core/hemisphere.h"
#include "core/phase.h"

static const double PI = 3.14159265358979323846;

static void shares_of(const pps_march *march, double mu, double share[2]) {
    share[0] = share[1] = 0;
    if (march->shares) {
        march->shares(march->solution, mu, share);
    }
}

/* What does not depend on azimuth: multiple scattering, and sky light on its way down. */
static double diffuse_part(const pps_march *march, const double share[2],
                           const pps_ray *ray) {
    double sum = march->sky && ray->down ? ray->ect : 0, term[2];
    if (march->shares) {
        march->terms(march->solution, ray, term);
        sum += march->slab.albedo * (share[0] * term[0] + share[1] * term[1]);
    }
    return sum;
}

/* Azimuths of a direction that are handled together. */
enum { AZIMUTHS = 64 };

/* All depths in direction j, azimuths first .. first + n - 1. */
static void march_direction(const pps_march *march, const pps_grid *at, size_t j,
                            size_t first, size_t n, const double *cosine,
                            double *radiance) {
    double mu = at->mu[j], share[2], phase[AZIMUTHS];
    shares_of(march, mu, share);
    pps_hg_azimuths(march->slab.g, march->mu0, mu, n, cosine, phase);
    for (size_t k = 0; k < at->n_tau; k++) {
        pps_ray ray;
        pps_ray_init(&ray, march->slab.thickness, 1 / march->mu0, at->tau[k], mu);
        double diffuse = diffuse_part(march, share, &ray);
        double beam = march->sky ? 0 : march->slab.albedo * ray.beam;
        double *out = radiance + (k * at->n_mu + j) * at->n_phi + first;
        for (size_t i = 0; i < n; i++) {
            out[i] = diffuse + beam * phase[i];
        }
    }
}

void pps_march_radiance(const pps_march *march, const pps_grid *at, double *radiance) {
    for (size_t first = 0; first < at->n_phi; first += AZIMUTHS) {
        size_t left = at->n_phi - first, n = left < AZIMUTHS ? left : AZIMUTHS;
        double cosine[AZIMUTHS];
        for (size_t i = 0; i < n; i++) {
            cosine[i] = pps_cos_degrees(at->phi[first + i]);
        }
        for (size_t j = 0; j < at->n_mu; j++) {
            march_direction(march, at, j, first, n, cosine, radiance);
        }
    }
}

/* One hemisphere at one depth, as the integrand of pps_hemisphere_integral. */
typedef struct {
    const pps_march *march;
    double tau, sign;
} hemisphere;

static void azimuth_means(const void *context, size_t n, const double *abs_mu,
                          double *radiance) {
    const hemisphere *h = context;
    const pps_march *march = h->march;
    double mean[PPS_PANEL];
    pps_hg_azimuth_means(h->sign * march->slab.g, march->mu0, n, abs_mu, mean);
    for (size_t i = 0; i < n; i++) {
        double mu = h->sign * abs_mu[i];
        pps_ray ray;
        pps_ray_init(&ray, march->slab.thickness, 1 / march->mu0, h->tau, mu);
        double share[2];
        shares_of(march, mu, share);
        radiance[i] = diffuse_part(march, share, &ray);
        if (!march->sky) {
            radiance[i] += march->slab.albedo * mean[i] * ray.beam;
        }
    }
}

void pps_march_flux(const pps_march *march, size_t n, const double *tau,
                    pps_flux *flux) {
    double mu0 = march->mu0, w = march->slab.thickness, g = march->slab.g;
    for (size_t i = 0; i < n; i++) {
        hemisphere down = {march, tau[i], 1}, up = {march, tau[i], -1};
        double run = march->sky && tau[i] == 0 ? 1 : tau[i]; /* sky light starts full */
        pps_hemisphere d = pps_hemisphere_integral(azimuth_means, &down, run, mu0, g);
        pps_hemisphere u =
            pps_hemisphere_integral(azimuth_means, &up, w - tau[i], mu0, g);
        double beam = march->sky ? 0 : exp(-tau[i] / mu0);
        flux[i] = (pps_flux){.up = u.flux,
                             .down = d.flux,
                             .direct = mu0 * beam,
                             .mean_diffuse = d.mean + u.mean,
                             .mean = d.mean + u.mean + beam / (4 * PI)};
    }
}
