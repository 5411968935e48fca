/* Marching a sum of exponentials along a path: divided differences E1 (A.1).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/ray_march.h"

#include <math.h>

#include <ppscat/expdiff.h>

pps_marched pps_ray_march(const pps_slab_light *light, double d, double mu, double h) {
    double w = light->w, lambda = light->lambda;
    double to_face = mu > 0 ? d / mu : mu < 0 ? (w - d) / -mu : (double)INFINITY;
    double inside = fmin(h, to_face), face = mu > 0 ? 0 : w;
    /* e^(-k (d - s mu)) e^(-s): e^(-k d) times E1 of the rates 0 and 1 - k mu. */
    double direct = exp(-d) * pps_exp1(inside, 0, 1 - mu);
    pps_marched m = {direct, light->c * direct};
    if (light->c != 0) {
        m.scattered +=
            light->a * exp(-lambda * d) * pps_exp1(inside, 0, 1 - lambda * mu) +
            light->b * exp(-lambda * (w - d)) * pps_exp1(inside, 0, 1 + lambda * mu);
    }
    if (h > inside) {
        double rest = exp(-inside) - exp(-h);
        m.direct += rest * exp(-face);
        m.scattered += rest * pps_slab_light_sum(light, face);
    }
    return m;
}
