/* The boundary conditions of one azimuthal order: two small positive definite systems, for
 * all beams at once.
 *
 * Nothing diffuse falls in: G psi + phi = 0 at the top, G psi - phi = 0 at the bottom,
 * G = X^T X. Even and odd about the mid-plane that is
 *     Ae even = (R0 + Rw)/2,  Ao odd = (Rw - R0)/2,
 *     Ae = G + diag(k tanh k h),  Ao = G + diag(k coth k h),  h = w/2,
 * with R0 = -(G psi_p + phi_p)(0), Rw = -(G psi_p - phi_p)(w). In thick slabs even + odd
 * cancels to nothing; there the values at the edges come from
 *     bottom = [Ae^-1 Rw + Ao^-1 Rw + Ae^-1 Dd Ao^-1 R0]/2,  Dd = diag(2k / sinh k w),
 * and the top with R0 and Rw exchanged.
 *
 * Matrices of right-hand sides have a row a mode: R0 of the n beams, then Rw of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/series.h"
#include "core/vector.h"
#include "solver/lapack.h"
#include "solver/order.h"
#include <ppscat/expdiff.h>

/* In slabs thinner than this a mode with k w < 1 is a series from one edge, which costs it
 * this factor of its accuracy at the other; in thicker ones it is a special mode. */
static const double SERIES_THICKNESS = 8;

/* A = L L^T with the reciprocals of L's diagonal. */
static bool factorise(int n, double *a) {
    if (!pps_cholesky(n, a)) {
        return false;
    }
    for (int j = 0; j < n; j++) {
        a[j + j * n] = 1 / a[j + j * n];
    }
    return true;
}

/* What a mode needs of the thickness, from e = e^(-k w) where k w >= 1. */
static void mode_thickness(pps_order *order, int j, double w) {
    double k = order->k[j], e = k > 0 ? exp(-k * w) : 0;
    bool small = isfinite(w) && k * w < 1;
    order->decay[j] = e;
    order->n_small += small;
    if (small) {
        order->tanh[j] = pps_k_tanh(k, w / 2);
        order->coth[j] = pps_k_coth(k, w / 2);
        order->csch[j] = pps_2k_csch(k, w);
        order->sum_over[j] = 0; /* of exponentials, which it is not made of */
        return;
    }
    order->tanh[j] = k * ((1 - e) / (1 + e));
    order->coth[j] = k * ((1 + e) / (1 - e));
    order->sum_over[j] = 1 / ((1 - e) * (1 + e));
    order->csch[j] = 4 * k * e * order->sum_over[j];
}

pps_status pps_order_set_thickness(pps_order *order, double thickness) {
    int n = order->n;
    size_t nn = (size_t)n * (size_t)n;
    memcpy(order->even, order->gram, nn * sizeof *order->even);
    memcpy(order->odd, order->gram, nn * sizeof *order->odd);
    order->n_small = 0;
    for (int j = 0; j < n; j++) {
        mode_thickness(order, j, thickness);
        order->even[j + j * n] += order->tanh[j];
        order->odd[j + j * n] += order->coth[j];
    }
    order->n_series = thickness < SERIES_THICKNESS ? order->n_small : 0;
    bool definite = factorise(n, order->even) && factorise(n, order->odd);
    return definite ? PPS_OK : PPS_ERR_CONVERGENCE;
}

/* ---- memory ---- */

size_t pps_order_scratch(const pps_discrete *discrete, size_t padded) {
    size_t n = (size_t)discrete->n;
    return (10 * n + (size_t)discrete->n_moments) * padded;
}

pps_status pps_order_reserve(pps_order *order, size_t padded) {
    if (padded <= order->capacity) {
        return PPS_OK;
    }
    size_t block = (size_t)order->n * padded;
    free(order->beam_memory);
    free(order->solution.special);
    order->capacity = 0;
    order->beam_memory = calloc(12 * block, sizeof *order->beam_memory);
    order->solution.special = malloc(block * sizeof *order->solution.special);
    if (!order->beam_memory || !order->solution.special) {
        return PPS_ERR_MEMORY;
    }
    pps_solution *s = &order->solution;
    double **parts[] = {&order->alpha,   &order->beta,    &s->p,
                        &s->r,           &s->c1,          &s->c2,
                        &s->edge_psi[0], &s->edge_psi[1], &s->edge_phi[0],
                        &s->edge_phi[1], &s->source_a,    &s->source_b};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        *parts[i] = order->beam_memory + i * block;
    }
    order->capacity = padded;
    return PPS_OK;
}

/* ---- the particular solutions ---- */

static inline bool is_thin(double w, double q) { return w * q < 2; }

/* So near, p e^(-q tau) and the exponentials cancel by more than a digit. */
static inline bool is_resonant(double k, double q) { return fabs(k - q) < q / 16; }

/* What each kind of core/mode.h becomes here: thin and small modes are series or special,
 * resonant ones special, normal ones exponentials. */
static pps_mode mode_of_beam(const pps_order *order, int j, double w,
                             const pps_beams *beams, size_t b) {
    size_t at = (size_t)j * beams->padded + b;
    double k = order->k[j], q = beams->q[b];
    pps_mode_kind kind =
        j < order->n_small ? (is_thin(w, q) ? PPS_MODE_THIN : PPS_MODE_SMALL)
                           : (is_resonant(k, q) ? PPS_MODE_RESONANT : PPS_MODE_NORMAL);
    pps_mode mode;
    pps_mode_beam_of_kind(&mode, kind, k, w, q, order->alpha[at], order->beta[at]);
    return mode;
}

void pps_order_light(pps_order *order, const pps_discrete *discrete,
                     const pps_beams *beams, double *scratch) {
    size_t all = (size_t)order->n * beams->padded;
    if (beams->sky) {
        memset(order->alpha, 0, all * sizeof *order->alpha);
        memset(order->beta, 0, all * sizeof *order->beta);
        return;
    }
    /* alpha = X^T a and beta = Z^T b are the projections at mu0. */
    pps_order_project(order, discrete, beams->padded, beams->mu0, order->alpha,
                      order->beta, scratch);
    double factor = (order->m == 0 ? 1 : 2) / 3.14159265358979323846;
    for (size_t i = 0; i < all; i++) {
        order->alpha[i] *= factor;
        order->beta[i] *= factor;
    }
}

/* What the particular solutions are at the edges: rows as of right-hand sides. */
typedef struct {
    double *psi, *phi;
} edge_values;

/* psi = p e^(-q tau), phi = r e^(-q tau), for all beams of a mode. */
PPS_CLONES static void exponential_parts(double k, const pps_beams *beams,
                                         const double *restrict alpha,
                                         const double *restrict beta,
                                         double *restrict p, double *restrict r,
                                         double *restrict psi, double *restrict phi) {
    size_t n = beams->n;
    const double *restrict q = beams->q, *restrict decay = beams->decay;
    for (size_t b = 0; b < n; b++) {
        double below = (q[b] - k) * (q[b] + k);
        p[b] = -(alpha[b] + q[b] * beta[b]) / below;
        r[b] = -(q[b] * alpha[b] + k * k * beta[b]) / below;
        psi[b] = p[b];
        phi[b] = r[b];
        psi[n + b] = p[b] * decay[b];
        phi[n + b] = r[b] * decay[b];
    }
}

/* Near resonance: psi = p Theta, phi = k p Theta + r e^(-q tau); the mode becomes a
 * special one, but for r, c1 and c2. */
static void resonant_part(pps_order *order, int j, const pps_beams *beams, size_t b,
                          double w, edge_values *edge) {
    pps_solution *s = &order->solution;
    size_t at = (size_t)j * beams->padded + b;
    pps_mode mode = mode_of_beam(order, j, w, beams, b);
    double theta = pps_exp1_known(w, mode.k, mode.q, order->decay[j], beams->decay[b]);
    s->p[at] = 0;
    s->r[at] = mode.r;
    edge->psi[b] = 0;
    edge->phi[b] = mode.r;
    edge->psi[beams->n + b] = mode.p * theta;
    edge->phi[beams->n + b] = mode.r * beams->decay[b] + mode.k * mode.p * theta;
    s->special[s->n_special++] = (pps_special){.j = j, .beam = b, .mode = mode};
}

/* Thin beams: the whole solution is a series, the particular one vanishing at the top. */
static void thin_parts(pps_order *order, int j, const pps_beams *beams, double w,
                       edge_values *edge) {
    pps_solution *s = &order->solution;
    size_t row = (size_t)j * beams->padded;
    double zero[PPS_LANES] = {0}, one[PPS_LANES];
    double a[PPS_SERIES_TERMS * PPS_LANES], b[PPS_SERIES_TERMS * PPS_LANES];
    double psi[PPS_LANES], phi[PPS_LANES];
    for (int l = 0; l < PPS_LANES; l++) {
        one[l] = 1;
    }
    for (size_t first = 0; first < beams->n; first += PPS_LANES) {
        size_t left = beams->n - first;
        pps_series series = {.n = left < PPS_LANES ? left : PPS_LANES,
                             .q = beams->q + first,
                             .beam = one,
                             .alpha = order->alpha + row + first,
                             .beta = order->beta + row + first,
                             .psi = zero,
                             .phi = zero};
        pps_series_expand(&series, w, order->k[j], a, b);
        pps_series_value(series.n, a, b, 1, psi, phi);
        for (size_t i = first; i < first + series.n; i++) {
            if (is_thin(w, beams->q[i])) {
                s->p[row + i] = s->r[row + i] = 0;
                edge->psi[i] = edge->phi[i] = 0;
                edge->psi[beams->n + i] = psi[i - first];
                edge->phi[beams->n + i] = phi[i - first];
            }
        }
    }
}

static bool any_thin(const pps_beams *beams, double w) {
    for (size_t b = 0; b < beams->n; b++) {
        if (is_thin(w, beams->q[b])) {
            return true;
        }
    }
    return false;
}

static void particular_parts(pps_order *order, const pps_beams *beams, double w,
                             size_t columns, double *psi, double *phi) {
    pps_solution *s = &order->solution;
    bool thin = any_thin(beams, w);
    s->n_special = 0;
    for (int j = 0; j < order->n; j++) {
        size_t row = (size_t)j * beams->padded;
        edge_values edge = {psi + (size_t)j * columns, phi + (size_t)j * columns};
        exponential_parts(order->k[j], beams, order->alpha + row, order->beta + row,
                          s->p + row, s->r + row, edge.psi, edge.phi);
        if (j < order->n_series && thin) {
            thin_parts(order, j, beams, w, &edge);
        }
        for (size_t b = 0; b < beams->n && j >= order->n_small; b++) {
            if (is_resonant(order->k[j], beams->q[b])) {
                resonant_part(order, j, beams, b, w, &edge);
            }
        }
    }
}

/* ---- the homogeneous parts ---- */

/* R0 and Rw from the values at the edges. */
static void edge_residuals(const pps_order *order, const pps_beams *beams,
                           size_t columns, const double *psi, const double *phi,
                           double *edge) {
    size_t n = (size_t)order->n;
    pps_rows_multiply(n, n, order->gram, n, columns, psi, columns, edge);
    for (size_t j = 0; j < n; j++) {
        double *row = edge + j * columns;
        const double *phi_row = phi + j * columns;
        for (size_t b = 0; b < beams->n; b++) {
            row[b] = -(row[b] + phi_row[b]);
        }
        for (size_t b = beams->n; b < 2 * beams->n; b++) {
            row[b] = -(row[b] - phi_row[b]);
        }
    }
}

/* Ae^-1, Ao^-1 and Ae^-1 Dd Ao^-1 of R0 and Rw, a row of each. */
typedef struct {
    const double *even, *odd, *cross;
} edge_solution;

/* psi_h at the top and at the bottom. */
static inline double edge_top(const edge_solution *e, size_t n, size_t b) {
    return (e->even[b] + e->odd[b] + e->cross[n + b]) / 2;
}
static inline double edge_bottom(const edge_solution *e, size_t n, size_t b) {
    return (e->even[n + b] + e->odd[n + b] + e->cross[b]) / 2;
}

/* [bottom sinh(k tau) + top sinh(k x)] / sinh(k w), by exponentials. */
PPS_CLONES static void close_exponentials(size_t n, double decay, double sum_over,
                                          const edge_solution *e, double *restrict c1,
                                          double *restrict c2) {
    for (size_t b = 0; b < n; b++) {
        double top = edge_top(e, n, b), bottom = edge_bottom(e, n, b);
        c1[b] = (top - bottom * decay) * sum_over;
        c2[b] = (bottom - top * decay) * sum_over;
    }
}

/* The edge values of a series: of the whole mode where the beam is thin, of what the
 * exponential of the beam leaves elsewhere. */
static void close_series(pps_order *order, int j, const pps_beams *beams, double w,
                         const edge_solution *e, const double *psi, const double *phi) {
    pps_solution *s = &order->solution;
    size_t n = beams->n, row = (size_t)j * beams->padded;
    double k = order->k[j], z = k * w;
    double ch = cosh(z), sh = z > 1e-4 ? sinh(z) / k : w * (1 + z * z / 6);
    double coth = pps_k_coth(k, w), csch = order->csch[j] / 2;
    for (size_t b = 0; b < n; b++) {
        size_t at = row + b;
        bool thin = is_thin(w, beams->q[b]);
        double top = edge_top(e, n, b), bottom = edge_bottom(e, n, b);
        double psi0 = top, phi0 = top * coth - bottom * csch;
        double psiw = bottom, phiw = top * csch - bottom * coth;
        if (thin) {
            double even = (e->even[b] + e->even[n + b]) / 2;
            double odd = (e->odd[n + b] - e->odd[b]) / 2;
            psi0 = even - odd;
            phi0 = even * order->tanh[j] - odd * order->coth[j];
            psiw = ch * psi0 - sh * phi0 + psi[n + b];
            phiw = ch * phi0 - k * k * sh * psi0 + phi[n + b];
        }
        s->c1[at] = s->c2[at] = 0;
        s->source_a[at] = thin ? order->alpha[at] : 0;
        s->source_b[at] = thin ? order->beta[at] : 0;
        s->edge_psi[0][at] = psi0;
        s->edge_phi[0][at] = phi0;
        s->edge_psi[1][at] = psiw;
        s->edge_phi[1][at] = phiw;
    }
}

/* A small k in a thick slab: the hyperbolic form from both edges. */
static void close_special(pps_order *order, int j, const pps_beams *beams, double w,
                          const edge_solution *e) {
    pps_solution *s = &order->solution;
    for (size_t b = 0; b < beams->n; b++) {
        size_t at = (size_t)j * beams->padded + b;
        pps_special *special = &s->special[s->n_special++];
        *special = (pps_special){j, b, mode_of_beam(order, j, w, beams, b)};
        special->mode.c1 = edge_bottom(e, beams->n, b);
        special->mode.c2 = edge_top(e, beams->n, b);
        s->p[at] = s->r[at] = s->c1[at] = s->c2[at] = 0;
        s->source_a[at] = s->source_b[at] = 0;
        for (int side = 0; side < 2; side++) {
            s->edge_psi[side][at] = s->edge_phi[side][at] = 0;
        }
    }
}

/* From the residuals R0, Rw in `a` to the modes; psi, phi: particular, at the edges. */
static void close_modes(pps_order *order, const pps_beams *beams, double w,
                        size_t columns, double *a, double *b, double *cross,
                        const double *psi, const double *phi) {
    size_t n = (size_t)order->n;
    pps_solution *s = &order->solution;
    memcpy(b, a, n * columns * sizeof *a);
    pps_rows_solve(n, order->even, columns, a);
    pps_rows_solve(n, order->odd, columns, b);
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < columns; i++) {
            cross[j * columns + i] = order->csch[j] * b[j * columns + i];
        }
    }
    pps_rows_solve(n, order->even, columns, cross);
    for (int j = 0; j < order->n; j++) {
        size_t row = (size_t)j * beams->padded, edge = (size_t)j * columns;
        edge_solution e = {a + edge, b + edge, cross + edge};
        if (j >= order->n_small) {
            close_exponentials(beams->n, order->decay[j], order->sum_over[j], &e,
                               s->c1 + row, s->c2 + row);
        } else if (order->n_series > 0) {
            close_series(order, j, beams, w, &e, psi + edge, phi + edge);
        } else {
            close_special(order, j, beams, w, &e);
        }
    }
    for (size_t i = 0; i < s->n_special; i++) {
        pps_special *special = &s->special[i];
        if (special->mode.kind == PPS_MODE_RESONANT) {
            size_t at = (size_t)special->j * beams->padded + special->beam;
            special->mode.c1 = s->c1[at];
            special->mode.c2 = s->c2[at];
        }
    }
}

void pps_order_solve(pps_order *order, double w, const pps_beams *beams,
                     double *scratch) {
    size_t n = (size_t)order->n, columns = pps_padded(2 * beams->n);
    size_t block = n * columns;
    double *a = scratch, *b = a + block, *cross = b + block;
    double *psi = cross + block, *phi = psi + block;
    memset(psi, 0, 2 * block * sizeof *psi);
    if (beams->sky) {
        /* s + d = 2 sqrt(w mu) at the top: G psi + phi = 2 X^T sqrt(w mu). */
        memset(a, 0, block * sizeof *a);
        for (size_t j = 0; j < n; j++) {
            a[j * columns] = 2 * order->flux_s[j];
        }
        order->solution.n_special = 0;
        memset(order->solution.p, 0, n * beams->padded * sizeof *order->solution.p);
        memset(order->solution.r, 0, n * beams->padded * sizeof *order->solution.r);
    } else {
        particular_parts(order, beams, w, columns, psi, phi);
        edge_residuals(order, beams, columns, psi, phi, a);
    }
    close_modes(order, beams, w, columns, a, b, cross, psi, phi);
}

/* ---- one mode by itself ---- */

pps_mode pps_order_mode(const pps_order *order, int j, double w, const pps_beams *beams,
                        size_t b) {
    const pps_solution *s = &order->solution;
    size_t at = (size_t)j * beams->padded + b;
    for (size_t i = 0; i < s->n_special; i++) {
        if (s->special[i].j == j && s->special[i].beam == b) {
            return s->special[i].mode;
        }
    }
    pps_mode mode = mode_of_beam(order, j, w, beams, b);
    mode.c1 = s->c1[at];
    mode.c2 = s->c2[at];
    if (mode.kind == PPS_MODE_THIN) {
        mode.c1 = s->edge_psi[0][at];
        mode.c2 = s->edge_phi[0][at];
    } else if (mode.kind == PPS_MODE_SMALL) {
        mode.c1 = s->edge_psi[1][at];
        mode.c2 = s->edge_psi[0][at];
    }
    return mode;
}
