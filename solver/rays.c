/* Ray integrals, the vector loops.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/rays.h"

#include <math.h>

#include "core/expdiff.h"
#include "core/lanes.h"
#include "solver/series.h"

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
 * sinh(y)/y, y = (c - k) t/2, which has no difference in it. So with E1(t; 0, k + c). */
static inline void apart(const pps_mode_here *m, const double *restrict ect,
                         const pps_mode_view *view, size_t at, double *restrict same,
                         double *restrict opposite) {
    for (size_t i = at; i < at + PPS_LANES; i++) {
        same[i] = view->near_over[i] * (m->e - ect[i]);
        opposite[i] = view->far_over[i] * (m->other * (1 - m->e * ect[i]));
    }
}

static inline void together(const pps_mode_here *m, const pps_run *run,
                            const pps_mode_view *view, size_t at,
                            double *restrict same, double *restrict opposite) {
    for (size_t i = at; i < at + PPS_LANES; i++) {
        double roots = run->t * (m->root * run->root[i]);
        double z = (run->c[i] - m->k) * run->t, sum = (run->c[i] + m->k) * run->t;
        double near = view->near[i] * roots * lane_sinh_over(z * z / 4);
        double far = view->far[i] * m->other * roots * lane_sinh_over(sum * sum / 4);
        same[i] = z < 1 && z > -1 ? near : same[i];
        opposite[i] = sum < 1 ? far : opposite[i];
    }
}

PPS_CLONES void pps_mode_rays(const pps_run *run, const pps_mode_here *mode,
                              const pps_mode_view *view, double *same,
                              double *opposite) {
    for (size_t at = 0; at < run->n; at += PPS_LANES) {
        apart(mode, run->ect, view, at, same, opposite);
        int close = 0; /* as (c + k) t < 1 implies |c - k| t < 1 */
        for (size_t i = at; i < at + PPS_LANES; i++) {
            double z = (run->c[i] - mode->k) * run->t;
            close |= z < 1 && z > -1;
        }
        if (close) {
            together(mode, run, view, at, same, opposite);
        }
    }
}

PPS_CLONES void pps_beam_rays(const pps_run *run, double q, double e, double root,
                              double other, double *integral) {
    for (size_t i = 0; i < run->n; i++) {
        double c = run->c[i];
        double part =
            run->down ? lane_exp1(run->t, q, c, e, run->ect[i], root, run->root[i])
                      : other * lane_exp1(run->t, 0, q + c, 1, e * run->ect[i], 1,
                                          root * run->root[i]);
        integral[i] = c * part;
    }
}

PPS_CLONES void pps_rays_sum(size_t n, size_t n_modes, size_t stride, const double *x,
                             const double *y, const double *a, const double *b,
                             size_t step, double *sum) {
    for (size_t at = 0; at < n; at += PPS_LANES) {
        double block[PPS_LANES];
        for (size_t l = 0; l < PPS_LANES; l++) {
            block[l] = sum[at + l];
        }
        for (size_t j = 0; j < n_modes; j++) {
            double aj = a[j * step], bj = b[j * step];
            const double *xj = x + j * stride + at, *yj = y + j * stride + at;
            for (size_t l = 0; l < PPS_LANES; l++) {
                block[l] += xj[l] * aj + yj[l] * bj;
            }
        }
        for (size_t l = 0; l < PPS_LANES; l++) {
            sum[at + l] = block[l];
        }
    }
}

PPS_CLONES void pps_rays_add_product(size_t n, const double *restrict x,
                                     const double *restrict y, double *restrict sum) {
    for (size_t i = 0; i < n; i++) {
        sum[i] += x[i] * y[i];
    }
}

/* Down: E2(t; k, q, c). Up, t to the bottom and tau to the top: what Theta does on from
 * here, E1(tau; k, q) E1(t; 0, k + c) + e^(-q tau) E2(t; 0, k + c, q + c). */
PPS_CLONES static void theta_down(const pps_run *run, double k, double q, double p,
                                  const double *restrict ge, const double *restrict go,
                                  double *restrict sum) {
    for (size_t i = 0; i < run->n; i++) {
        double c = run->c[i];
        sum[i] += p * (ge[i] + k * go[i]) * (c * lane_exp2(run->t, k, q, c));
    }
}

PPS_CLONES static void theta_up(const pps_run *run, double k, double q, double p,
                                double theta, double eqt, const double *restrict ge,
                                const double *restrict go, double *restrict sum) {
    double t = run->t, ekt = lane_exp(-k * t), root = lane_exp(-k * t / 2);
    for (size_t i = 0; i < run->n; i++) {
        double c = run->c[i];
        double fall =
            lane_exp1(t, 0, k + c, 1, ekt * run->ect[i], 1, root * run->root[i]);
        double rest = lane_exp2(t, 0, k + c, q + c);
        sum[i] += p * (ge[i] + k * go[i]) * (c * (theta * fall + eqt * rest));
    }
}

void pps_theta_rays(const pps_run *run, double k, double q, double p, const double *ge,
                    const double *go, double *sum) {
    if (run->down) {
        theta_down(run, k, q, p, ge, go, sum);
    } else {
        theta_up(run, k, q, p, pps_exp1(run->rest, k, q), exp(-q * run->rest), ge, go,
                 sum);
    }
}

PPS_CLONES void pps_series_source(size_t n, size_t stride, const double *restrict ge,
                                  const double *restrict go, const double *restrict a,
                                  const double *restrict b, double *restrict source) {
    for (size_t d = 0; d < PPS_SERIES_TERMS; d++) {
        double ad = a[d * PPS_LANES], bd = b[d * PPS_LANES];
        double *restrict row = source + d * stride;
        for (size_t i = 0; i < n; i++) {
            row[i] += ge[i] * ad + go[i] * bd;
        }
    }
}

PPS_CLONES void pps_series_rays(size_t n, size_t stride, const double *moment,
                                const double *source, double *sum) {
    for (size_t at = 0; at < n; at += PPS_LANES) {
        double block[PPS_LANES] = {0};
        for (size_t d = PPS_SERIES_TERMS; d-- > 0;) { /* from small to large */
            for (size_t l = 0; l < PPS_LANES; l++) {
                block[l] += moment[d * n + at + l] * source[d * stride + at + l];
            }
        }
        for (size_t l = 0; l < PPS_LANES; l++) {
            sum[at + l] += block[l];
        }
    }
}

PPS_CLONES bool pps_add_order(size_t n, size_t n_phi, const double *cosine,
                              const double *term, double tolerance, double *value) {
    double excess[PPS_LANES] = {0};
    for (size_t p = 0; p < n_phi; p++) {
        double *row = value + p * n;
        for (size_t at = 0; at < n; at += PPS_LANES) {
            for (size_t l = 0; l < PPS_LANES; l++) {
                double new = row[at + l] + cosine[p] * term[at + l];
                double over = fabs(term[at + l]) - tolerance * fabs(new);
                row[at + l] = new;
                excess[l] = over > excess[l] ? over : excess[l];
            }
        }
    }
    for (int l = 0; l < PPS_LANES; l++) {
        if (excess[l] > 0) {
            return false;
        }
    }
    return true;
}
