/* Closed forms in batches: vector loops over depths.
 *
 * "hemispheric" is one mode (core/mode.h) whose psi is F+ + F-; the fluence is
 * 2 psi + e^(-q tau). Each kind of mode has its loop.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/closed.h>

#include <math.h>
#include <string.h>

#include <ppscat/phase.h>

#include "core/lanes.h"
#include "core/series.h"
#include "spp/twostream.h"

/* The series of a thin slab, 2 psi as powers of tau/w. */
static void expand(pps_hemispheric *h, const pps_mode *mode) {
    double lane[6][PPS_LANES], a[PPS_SERIES_TERMS * PPS_LANES];
    double b[PPS_SERIES_TERMS * PPS_LANES];
    const double value[6] = {mode->q, 1, mode->alpha, mode->beta, mode->c1, mode->c2};
    for (int i = 0; i < 6; i++) {
        for (int l = 0; l < PPS_LANES; l++) {
            lane[i][l] = value[i];
        }
    }
    pps_series series = {1, lane[0], lane[1], lane[2], lane[3], lane[4], lane[5]};
    pps_series_expand(&series, mode->w, mode->k, a, b);
    for (int d = 0; d < PPS_SERIES_TERMS; d++) {
        h->series[d] = 2 * a[d * PPS_LANES];
    }
}

pps_status pps_hemispheric_init(pps_hemispheric *h, const pps_slab *slab, double mu0) {
    if (pps_slab_check(slab) || pps_mu0_check(mu0)) {
        return PPS_ERR_ARGUMENT;
    }
    pps_twostream two;
    pps_hemispheric_solve(&two, slab, mu0);
    const pps_mode *m = &two.mode;
    *h = (pps_hemispheric){
        .kind = (int)m->kind, .thickness = m->w, .k = m->k, .q = m->q, .beam = 1};
    switch (m->kind) {
    case PPS_MODE_THIN:
        expand(h, m);
        break;
    case PPS_MODE_SMALL:
        h->beam += 2 * m->p;
        h->bottom = 2 * m->c1;
        h->top = 2 * m->c2;
        h->sinh_over = m->k > 0 ? m->k / sinh(m->k * m->w) : 1 / m->w;
        break;
    case PPS_MODE_RESONANT:
        h->resonance = 2 * m->p;
        h->falls = 2 * m->c1;
        h->grows = 2 * m->c2;
        break;
    case PPS_MODE_NORMAL:
        h->beam += 2 * m->p;
        h->falls = 2 * m->c1;
        h->grows = 2 * m->c2;
        break;
    }
    return PPS_OK;
}

PPS_LANE four thin(const pps_hemispheric *h, four tau) {
    four u = tau / h->thickness, sum = four_of(h->series[PPS_SERIES_TERMS - 1]);
    for (int d = PPS_SERIES_TERMS - 1; d-- > 0;) {
        sum = sum * u + h->series[d];
    }
    return sum + four_exp(-h->q * tau);
}

/* sinh(k t)/k for k t < 1. */
PPS_LANE four sinh_series(double k, four t) {
    four y2 = (k * t) * (k * t), p = four_of(1.0 / 121645100408832000);
    p = p * y2 + 1.0 / 355687428096000;
    p = p * y2 + 1.0 / 1307674368000;
    p = p * y2 + 1.0 / 6227020800;
    p = p * y2 + 1.0 / 39916800;
    p = p * y2 + 1.0 / 362880;
    p = p * y2 + 1.0 / 5040;
    p = p * y2 + 1.0 / 120;
    p = p * y2 + 1.0 / 6;
    return t * (1 + y2 * p);
}

PPS_LANE four small(const pps_hemispheric *h, four tau) {
    four rise = h->bottom * sinh_series(h->k, tau);
    four fall = h->top * sinh_series(h->k, h->thickness - tau);
    return h->sinh_over * (rise + fall) + h->beam * four_exp(-h->q * tau);
}

PPS_LANE four normal(const pps_hemispheric *h, four tau, four eqt) {
    four ekt = four_exp(-h->k * tau);
    four sum = h->falls * ekt + h->beam * eqt;
    return h->grows != 0 ? sum + h->grows * four_exp(-h->k * (h->thickness - tau))
                         : sum; /* nothing grows in a half-space */
}

PPS_LANE four resonant(const pps_hemispheric *h, four tau) {
    four ekt = four_exp(-h->k * tau), eqt = four_exp(-h->q * tau);
    four z = (h->q - h->k) * tau; /* Theta as E1 of core/expdiff.h */
    four near = tau * four_exp(-(h->k + h->q) / 2 * tau) * four_sinh_over(z * z / 4);
    four theta = four_choose(four_within_one(z), near, (ekt - eqt) / (h->q - h->k));
    return normal(h, tau, eqt) + h->resonance * theta;
}

PPS_LANE four fluence_of(const pps_hemispheric *h, four tau, int kind) {
    switch (kind) {
    case PPS_MODE_THIN:
        return thin(h, tau);
    case PPS_MODE_SMALL:
        return small(h, tau);
    case PPS_MODE_RESONANT:
        return resonant(h, tau);
    default:
        return normal(h, tau, four_exp(-h->q * tau));
    }
}

PPS_LANE void fluences(const pps_hemispheric *h, size_t n, const double *tau,
                       double *fluence, int kind) {
    size_t i = 0;
    for (; i + FOUR <= n; i += FOUR) {
        four_to(fluence + i, fluence_of(h, four_at(tau + i), kind));
    }
    if (i < n) {
        double rest[FOUR] = {0};
        memcpy(rest, tau + i, (n - i) * sizeof *rest);
        four_to(rest, fluence_of(h, four_at(rest), kind));
        memcpy(fluence + i, rest, (n - i) * sizeof *rest);
    }
}

PPS_CLONES void pps_hemispheric_fluence(const pps_hemispheric *h, size_t n,
                                        const double *tau, double *fluence) {
    switch (h->kind) {
    case PPS_MODE_THIN:
        fluences(h, n, tau, fluence, PPS_MODE_THIN);
        break;
    case PPS_MODE_SMALL:
        fluences(h, n, tau, fluence, PPS_MODE_SMALL);
        break;
    case PPS_MODE_RESONANT:
        fluences(h, n, tau, fluence, PPS_MODE_RESONANT);
        break;
    default:
        fluences(h, n, tau, fluence, PPS_MODE_NORMAL);
    }
}
