/* Three exponentials: the homogeneous pair and the particular solution, matched at the
 * two faces.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/slab_light.h"

#include <math.h>

static const double CONSERVATIVE = 1e-12, RESONANCE = 1e-6;

double pps_slab_m(pps_slab_closure closure) {
    return closure == PPS_SLAB_HEMISPHERIC ? 2 : 1;
}

double pps_slab_kappa(pps_slab_closure closure) {
    return closure == PPS_SLAB_DARK ? 0 : closure == PPS_SLAB_SPP_PRINTED ? 2 : 1;
}

/* lambda away from 1, where e^(-lambda z) and e^(-z) are one function. With m = 1 that is
 * albedo 0 alone, where their difference is the answer. */
static double off_resonance(double m, double lambda) {
    return m > 1 && fabs(lambda - 1) < RESONANCE ? 1 + RESONANCE : lambda;
}

void pps_slab_light_init(pps_slab_light *light, pps_slab_closure closure, double albedo,
                         double w) {
    *light = (pps_slab_light){.m = 1, .lambda = 1, .w = w};
    if (closure == PPS_SLAB_DARK || !(albedo > 0)) {
        return;
    }
    double m = pps_slab_m(closure), kappa = pps_slab_kappa(closure);
    double lambda = off_resonance(m, m * sqrt(fmax(1 - albedo, CONSERVATIVE)));
    double r = lambda / m, a = 1 - r * r; /* the albedo that belongs to lambda */
    double c = m == 1 ? -1 : -m * m * a / ((1 - lambda) * (1 + lambda));
    double e = exp(-lambda * w), det = (1 + r) * (1 + r) - (1 - r) * (1 - r) * e * e;
    double top = -c * (1 + 1 / m), bottom = -c * (1 - 1 / m) * exp(-w);
    light->m = m;
    light->lambda = lambda;
    light->a = kappa * ((1 + r) * top - (1 - r) * e * bottom) / det;
    light->b = kappa * ((1 + r) * bottom - (1 - r) * e * top) / det;
    light->c = kappa * c;
}

double pps_slab_light_sum(const pps_slab_light *light, double z) {
    return light->a * exp(-light->lambda * z) +
           light->b * exp(-light->lambda * (light->w - z)) + light->c * exp(-z);
}

double pps_slab_light_net(const pps_slab_light *light, double z) {
    double r = light->lambda / light->m;
    return r * (light->a * exp(-light->lambda * z) -
                light->b * exp(-light->lambda * (light->w - z))) +
           light->c / light->m * exp(-z);
}
