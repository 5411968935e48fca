/* The aureole: what the forward peak that delta-M takes off scatters twice.
 *
 * Delta-M writes p = f D + (1 - f) p', D having moments 1 below l = L and g^l / f from there
 * on, and takes light scattered by D as not scattered. TMS gives the light scattered once
 * by D back its direction, but lets it go on through the scaled slab, where D no longer
 * scatters it: with x = albedo f s, s the path, it counts x e^x D where sum of x^n D^n / n!
 * is right, D^n being D folded with itself. To second order in x the excess is
 *
 *     (albedo f)^2 [2 D - D^2](Theta) c int int e^-(path) ..,
 *
 * the IMS correction of NT88, whose form with the second path scaled, the first not, is
 * right to all orders where D^n = D. There light turns from mu0 to mu in the second
 * scattering; here in either, half and half, so that transmission stays reciprocal:
 *
 *     c/2 [q E2(tau; c, sigma q, sigma q) + c E2(tau; q, sigma c, sigma c)],
 *
 * sigma = 1 - albedo f, at true depths. Errors with few streams fall two to nine times
 * (g = .8 and .9, 8 streams), nothing changes where f^2 is beyond the last digit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/aureole.h"

#include <math.h>

#include "core/lanes.h"
#include "core/phase.h"

static const double PI = 3.14159265358979323846;

bool pps_aureole_matters(const pps_dom *dom) {
    double peak = dom->slab.albedo * dom->f * dom->discrete.n_moments;
    return dom->corrected && !dom->beams.sky && peak * peak > 1e-18;
}

/* f^2 (2 D - D^2) = 2 f p - p^2 + ((1 - f) p')^2, squares by folding: p^2 is
 * Henyey-Greenstein of g^2, the last has these coefficients of P_l(x). */
void pps_aureole_fold(const pps_dom *dom, double *coefficient) {
    for (int l = 0; l < dom->discrete.n_moments; l++) {
        double moments = (1 - dom->f) * dom->discrete.strength[l];
        coefficient[l] = moments * moments / ((2 * l + 1) * 4 * PI);
    }
}

/* sum of coefficient_l P_l(x). */
PPS_LANE four legendre_sum(int n_moments, const double *coefficient, four x) {
    four before = four_of(1), here = x, sum = coefficient[0] + coefficient[1] * x;
    for (int l = 2; l < n_moments; l++) {
        four next =
            x * here * ((2 * l - 1) / (double)l) - before * ((l - 1) / (double)l);
        sum += coefficient[l] * next;
        before = here;
        here = next;
    }
    return sum;
}

/* Scattering cosines, and 2 f p - p^2 there. */
PPS_CLONES static void peak_sources(double f, double g, double mu0, double cosine,
                                    size_t n, const double *restrict mu,
                                    double *restrict x, double *restrict source) {
    double sine0 = (1 - mu0) * (1 + mu0), g2 = g * g;
    double once = 2 * f * (1 - g) * (1 + g) / (4 * PI);
    double twice = (1 - g2) * (1 + g2) / (4 * PI);
    for (size_t i = 0; i < n; i++) {
        double sines = sqrt(sine0 * (1 - mu[i]) * (1 + mu[i]));
        double here = mu0 * mu[i] + sines * cosine;
        here = here > 1 ? 1 : here;
        x[i] = here;
        source[i] = once / pps_hg_over(g, here) - twice / pps_hg_over(g2, here);
    }
}

PPS_CLONES void pps_aureole_sources(const pps_dom *dom, const double *coefficient,
                                    double mu0, double cosine, size_t n,
                                    const double *mu, double *x, double *source) {
    double factor = -dom->slab.albedo * dom->slab.albedo;
    peak_sources(dom->f, dom->slab.g, mu0, cosine, n, mu, x, source);
    for (size_t i = 0; i < n; i += FOUR) {
        four folded =
            legendre_sum(dom->discrete.n_moments, coefficient, four_at(x + i));
        four_to(source + i, factor * (four_at(source + i) + folded));
    }
}

PPS_CLONES void pps_aureole_rays(const pps_dom *dom, double mu0, double tau, size_t n,
                                 const double *c, double *integral) {
    double q = 1 / mu0, sigma = dom->stretch;
    for (size_t i = 0; i < n; i += FOUR) {
        four ci = four_at(c + i);
        four last = q * four_exp2(tau, ci, four_of(sigma * q), four_of(sigma * q));
        four first = ci * four_exp2(tau, four_of(q), sigma * ci, sigma * ci);
        four_to(integral + i, ci * (last + first) / 2);
    }
}
