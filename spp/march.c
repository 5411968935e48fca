/* Ray marching in closed form (SPP A.1).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "spp/march.h"

#include <math.h>

#include <ppscat/phase.h>

#include "core/hemisphere.h"
#include "core/phase.h"

static const double PI = 3.14159265358979323846;

static double diffuse_part(const pps_march *march, const pps_ray *ray, double mu) {
    return march->diffuse ? march->diffuse(march->solution, ray, mu) : 0;
}

/* What does not scatter in the slab: sky light on its way down. */
static double uncollided(const pps_march *march, const pps_ray *ray) {
    return march->sky && ray->down ? ray->ect : 0;
}

void pps_march_radiance(const pps_march *march, const pps_grid *at, double *radiance) {
    double albedo = march->slab.albedo, g = march->slab.g;
    for (size_t k = 0; k < at->n_tau; k++) {
        for (size_t j = 0; j < at->n_mu; j++) {
            pps_ray ray;
            pps_ray_init(&ray, march->slab.thickness, 1 / march->mu0, at->tau[k],
                         at->mu[j]);
            double diffuse =
                albedo * diffuse_part(march, &ray, at->mu[j]) + uncollided(march, &ray);
            double beam = march->sky ? 0 : albedo * ray.beam;
            for (size_t i = 0; i < at->n_phi; i++) {
                double x = pps_cos_scattering(march->mu0, at->mu[j], at->phi[i]);
                *radiance++ = diffuse + beam * pps_hg(g, x);
            }
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
        double source = diffuse_part(march, &ray, mu);
        if (!march->sky) {
            source += mean[i] * ray.beam;
        }
        radiance[i] = march->slab.albedo * source + uncollided(march, &ray);
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
