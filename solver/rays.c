/* Ray integrals, the vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/rays.h"

#include <math.h>

#include "core/lanes.h"
#include "core/series.h"

PPS_CLONES void pps_mode_view_fill(size_t n, double signed_k, const double *restrict c,
                                   const double *restrict ge, const double *restrict go,
                                   double *restrict near, double *restrict near_over,
                                   double *restrict far, double *restrict far_over) {
    double k = fabs(signed_k);
    for (size_t i = 0; i < n; i++) {
        near[i] = c[i] * (ge[i] + signed_k * go[i]);
        near_over[i] = near[i] / (c[i] - k);
        far[i] = c[i] * (ge[i] - signed_k * go[i]);
        far_over[i] = far[i] / (c[i] + k);
    }
}

/* E1(t; k, c) = (e^(-k t) - e^(-c t))/(c - k) where the rates are apart; else with
 * sinh(y)/y, y = (c - k) t/2, which has no difference in it. So with E1(t; 0, k + c);
 * (c + k) t < 1 implies |c - k| t < 1. */
PPS_LANE void mode_row(const pps_runs *runs, const pps_mode_here *m,
                       const pps_mode_view *view, size_t depth, double *same,
                       double *opposite) {
    double t = runs->t[depth], e = m->e[depth * m->step];
    double root = t * m->root[depth * m->step], other = m->other[depth * m->step];
    const double *ect_row = runs->ect + depth * runs->row;
    const double *root_row = runs->root + depth * runs->row;
    for (size_t i = 0; i < runs->n; i += FOUR) {
        four c = four_at(runs->c + i), ect = four_at(ect_row + i);
        four z = (c - m->k) * t, sum = (c + m->k) * t;
        four x = four_at(view->near_over + i) * (e - ect);
        four y = four_at(view->far_over + i) * (other * (1 - e * ect));
        four_int close = four_within_one(z), both = sum < 1;
        if (four_any(close)) {
            four roots = root * four_at(root_row + i);
            x = four_choose(
                close, four_at(view->near + i) * roots * four_sinh_over(z * z / 4), x);
            if (four_any(both)) {
                four mean = roots * four_sinh_over(sum * sum / 4);
                y = four_choose(both, four_at(view->far + i) * other * mean, y);
            }
        }
        four_to(same + i, x);
        four_to(opposite + i, y);
    }
}

PPS_CLONES void pps_mode_rays(const pps_runs *runs, const pps_mode_here *mode,
                              const pps_mode_view *view, size_t apart, double *same,
                              double *opposite) {
    for (size_t k = 0; k < runs->n_tau; k++) {
        if (runs->t[k] > 0) {
            mode_row(runs, mode, view, k, same + k * apart, opposite + k * apart);
            continue;
        }
        for (size_t i = 0; i < runs->n; i++) { /* at the edge where they enter */
            same[k * apart + i] = opposite[k * apart + i] = 0;
        }
    }
}

PPS_CLONES void pps_beam_rays(const pps_run *run, double q, double e, double root,
                              double other, double *integral) {
    four one = four_of(1), zero = four_of(0);
    for (size_t i = 0; i < run->n; i += FOUR) {
        four c = four_at(run->c + i), ect = four_at(run->ect + i);
        four root_c = four_at(run->root + i);
        four part = run->down ? four_exp1(run->t, four_of(q), c, four_of(e), ect,
                                          four_of(root), root_c)
                              : other * four_exp1(run->t, zero, q + c, one, e * ect,
                                                  one, root * root_c);
        four_to(integral + i, c * part);
    }
}

PPS_CLONES void pps_rays_sum(size_t n, size_t n_modes, const double *x, const double *y,
                             const double *a, const double *b, size_t step,
                             double *sum) {
    for (size_t at = 0; at < n; at += PPS_LANES) {
        const double *xj = x + at, *yj = y + at;
        four left = four_at(sum + at), right = four_at(sum + at + FOUR);
        for (size_t j = 0; j < n_modes; j++, xj += n, yj += n) {
            double aj = a[j * step], bj = b[j * step];
            left += four_at(xj) * aj + four_at(yj) * bj;
            right += four_at(xj + FOUR) * aj + four_at(yj + FOUR) * bj;
        }
        four_to(sum + at, left);
        four_to(sum + at + FOUR, right);
    }
}

PPS_CLONES void pps_rays_add_product(size_t n, const double *restrict x,
                                     const double *restrict y, double *restrict sum) {
    for (size_t i = 0; i < n; i++) {
        sum[i] += x[i] * y[i];
    }
}

/* ---- resonance ---- */

/* Down: E2(t; k, q, c) = (E1(t; k, q) - E1(t; q, c)) / (c - k) where c is apart from k;
 * `beam` is c E1(t; q, c). */
PPS_CLONES static void theta_down(const pps_run *run, const pps_resonance *r,
                                  const double *ge, const double *go,
                                  const double *beam, double *sum) {
    for (size_t i = 0; i < run->n; i += FOUR) {
        four c = four_at(run->c + i), z = (c - r->k) * run->t;
        four part = (c * r->theta - four_at(beam + i)) / (c - r->k);
        four_int close = four_within_one(z);
        if (four_any(close)) {
            four near = c * four_exp2(run->t, four_of(r->k), four_of(r->q), c);
            part = four_choose(close, near, part);
        }
        four source = r->p * (four_at(ge + i) + r->k * four_at(go + i));
        four_to(sum + i, four_at(sum + i) + source * part);
    }
}

/* Up, t to the bottom and tau to the top: what Theta does on from here,
 * E1(tau; k, q) E1(t; 0, k + c) + e^(-q tau) E2(t; 0, k + c, q + c), the last as above with
 * E1(t; k + c, q + c) = e^(-c t) E1(t; k, q). */
PPS_CLONES static void theta_up(const pps_run *run, const pps_resonance *r,
                                const double *ge, const double *go, double *sum) {
    four zero = four_of(0), one = four_of(1);
    for (size_t i = 0; i < run->n; i += FOUR) {
        four c = four_at(run->c + i), ect = four_at(run->ect + i);
        four fall = four_exp1(run->t, zero, r->k + c, one, r->ekx * ect, one,
                              r->root * four_at(run->root + i));
        four part = (fall - ect * r->theta_on) / (r->q + c);
        four_int close = (r->k + c) * run->t < 1;
        if (four_any(close)) {
            part =
                four_choose(close, four_exp2(run->t, zero, r->k + c, r->q + c), part);
        }
        four ray = c * (r->theta * fall + r->eqt * part);
        four source = r->p * (four_at(ge + i) + r->k * four_at(go + i));
        four_to(sum + i, four_at(sum + i) + source * ray);
    }
}

void pps_theta_rays(const pps_run *run, const pps_resonance *mode, const double *ge,
                    const double *go, const double *beam, double *sum) {
    if (run->down) {
        theta_down(run, mode, ge, go, beam, sum);
    } else {
        theta_up(run, mode, ge, go, sum);
    }
}

/* ---- series ---- */

PPS_CLONES void pps_series_source(size_t n, size_t stride, const double *restrict ge,
                                  const double *restrict go, const double *restrict a,
                                  const double *restrict b, double *restrict source) {
    for (size_t i = 0; i < n; i += FOUR) {
        four even = four_at(ge + i), odd = four_at(go + i);
        for (size_t d = 0; d < PPS_SERIES_TERMS; d++) {
            double *to = source + d * stride + i;
            double ad = a[d * PPS_LANES], bd = b[d * PPS_LANES];
            four_to(to, four_at(to) + (even * ad + odd * bd));
        }
    }
}

PPS_CLONES void pps_series_rays(size_t n, size_t stride, const double *moment,
                                const double *source, double *sum) {
    for (size_t i = 0; i < n; i += FOUR) {
        four total = {0};
        for (size_t d = PPS_SERIES_TERMS; d-- > 0;) { /* from small to large */
            total += four_at(moment + d * n + i) * four_at(source + d * stride + i);
        }
        four_to(sum + i, four_at(sum + i) + total);
    }
}

/* ---- azimuth ---- */

PPS_CLONES static void add_terms(size_t n, size_t n_phi, const double *restrict cosine,
                                 const double *restrict term, double *restrict value) {
    for (size_t p = 0; p < n_phi; p++) {
        double factor = cosine[p];
        for (size_t i = 0; i < n; i++) {
            value[p * n + i] += factor * term[i];
        }
    }
}

/* Most orders are told by their first few numbers. */
PPS_CLONES static bool is_small(size_t n, size_t n_phi, const double *term,
                                double tolerance, const double *value) {
    for (size_t p = 0; p < n_phi; p++) {
        for (size_t i = 0; i < n; i += FOUR) {
            four size = four_abs(four_at(term + i));
            if (four_any(size > tolerance * four_abs(four_at(value + p * n + i)))) {
                return false;
            }
        }
    }
    return true;
}

bool pps_add_order(size_t n, size_t n_phi, const double *cosine, const double *term,
                   double tolerance, double *value) {
    add_terms(n, n_phi, cosine, term, value);
    return is_small(n, n_phi, term, tolerance, value);
}
