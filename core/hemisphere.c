/* Integrals over a hemisphere, on Gauss panels graded towards mu = 0 and mu = mu0.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/hemisphere.h"

#include <math.h>

#include <ppscat/phase.h>

#include "core/beam.h"
#include "core/phase.h"
#include "core/quadrature.h"

static const double PI = 3.14159265358979323846;

static const double PANEL_RATIO = 4; /* a panel then holds 1e-15 beside a singularity */

typedef struct {
    pps_radiances_of_mu radiances;
    const void *context;
    double node[PPS_PANEL], weight[PPS_PANEL];
    pps_hemisphere sum;
} integration;

static void panel(integration *in, double from, double to) {
    double mu[PPS_PANEL], radiance[PPS_PANEL];
    for (int i = 0; i < PPS_PANEL; i++) {
        mu[i] = from + (to - from) * in->node[i];
    }
    in->radiances(in->context, PPS_PANEL, mu, radiance);
    for (int i = 0; i < PPS_PANEL; i++) {
        double part = (to - from) * in->weight[i] * radiance[i];
        in->sum.flux += 2 * PI * mu[i] * part;
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

pps_hemisphere pps_hemisphere_integral(pps_radiances_of_mu radiances,
                                       const void *context, double run, double mu0,
                                       double g) {
    integration in = {.radiances = radiances, .context = context};
    if (run <= 0) {
        return in.sum;
    }
    pps_gauss_unit(PPS_PANEL, in.node, in.weight);
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
    double g, mu0, w, tau;
    int down;
} single;

static void single_radiances(const void *context, size_t n, const double *mu,
                             double *radiance) {
    const single *s = context;
    double beam[PPS_PANEL];
    pps_hg_azimuth_means(s->down ? s->g : -s->g, s->mu0, n, mu, radiance);
    pps_beam_integrals(s->mu0, s->tau, s->w - s->tau, s->down, n, mu, beam);
    for (size_t i = 0; i < n; i++) {
        radiance[i] *= beam[i];
    }
}

pps_hemisphere pps_single_hemisphere(double g, double mu0, double w, double tau,
                                     int down) {
    single context = {g, mu0, w, tau, down};
    return pps_hemisphere_integral(single_radiances, &context, down ? tau : w - tau,
                                   mu0, g);
}

static void backward(const void *context, size_t n, const double *mu,
                     double *fraction) {
    for (size_t i = 0; i < n; i++) {
        fraction[i] = pps_hg_backward(*(const double *)context, mu[i]);
    }
}

double pps_hg_backward_diffuse(double g) {
    /* R(mu) turns from 1/2 at grazing angles within mu ~ 1 - |g|. */
    return 2 * pps_hemisphere_integral(backward, &g, 10 * (1 - fabs(g)), 1, 0).mean;
}
