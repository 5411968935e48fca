/* Integrals over a hemisphere, on Gauss panels graded towards mu = 0 and mu = mu0.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/hemisphere.h"

#include <math.h>

#include <ppscat/phase.h>

#include "core/mode.h"
#include "core/quadrature.h"

static const double PI = 3.14159265358979323846;

enum { PANEL_POINTS = 16 };
static const double PANEL_RATIO =
    4; /* 16 points then hold 1e-15 beside a singularity */

typedef struct {
    pps_radiance_of_mu radiance;
    const void *context;
    double node[PANEL_POINTS], weight[PANEL_POINTS];
    pps_hemisphere sum;
} integration;

static void panel(integration *in, double from, double to) {
    for (int i = 0; i < PANEL_POINTS; i++) {
        double mu = from + (to - from) * in->node[i];
        double part = (to - from) * in->weight[i] * in->radiance(in->context, mu);
        in->sum.flux += 2 * PI * mu * part;
        in->sum.mean += part / 2;
    }
}

/* Panels from `at` to `to` (either side of it) that grow away from `at`. */
static void graded(integration *in, double at, double to, double smallest) {
    double length = fabs(to - at), side = to > at ? 1 : -1, near = 0, far = smallest;
    while (near < length) {
        far = fmin(far, length);
        double a = at + side * near, b = at + side * far;
        panel(in, fmin(a, b), fmax(a, b));
        near = far;
        far *= PANEL_RATIO;
    }
}

pps_hemisphere pps_hemisphere_integral(pps_radiance_of_mu radiance, const void *context,
                                       double run, double mu0, double g) {
    integration in = {.radiance = radiance, .context = context};
    if (run <= 0) {
        return in.sum;
    }
    pps_gauss_unit(PANEL_POINTS, in.node, in.weight);
    double grazing = fmax(fmin(run, 1) / 40, 1e-300);
    double peak = fmin(mu0, fmax(0.1 * (1 - fabs(g)) * (1 - fabs(g)), 1e-15));
    graded(&in, 0, mu0 / 2, grazing);
    graded(&in, mu0, mu0 / 2, peak);
    if (mu0 < 1) {
        graded(&in, mu0, 1, peak);
    }
    return in.sum;
}

typedef struct {
    double g, mu0, w, tau, sign;
} single;

static double single_radiance(const void *context, double mu) {
    const single *s = context;
    pps_ray ray;
    pps_ray_init(&ray, s->w, 1 / s->mu0, s->tau, s->sign * mu);
    return pps_hg_azimuth_mean(s->g, s->sign * mu, s->mu0) * ray.beam;
}

pps_hemisphere pps_single_hemisphere(double g, double mu0, double w, double tau,
                                     int down) {
    single context = {g, mu0, w, tau, down ? 1 : -1};
    return pps_hemisphere_integral(single_radiance, &context, down ? tau : w - tau, mu0,
                                   g);
}

static double backward(const void *context, double mu) {
    return pps_hg_backward(*(const double *)context, mu);
}

double pps_hg_backward_diffuse(double g) {
    /* R(mu) turns from 1/2 at grazing angles within mu ~ 1 - |g|. */
    return 2 * pps_hemisphere_integral(backward, &g, 10 * (1 - fabs(g)), 1, 0).mean;
}
