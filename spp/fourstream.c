/* Four streams, the discrete problem: docs/theory.md section 3 with two nodes a
 * hemisphere, where every eigenproblem and every boundary solve is 2 x 2 and closed.
 *
 *   p_l   sqrt(w_i) P_l^m(mu_i)
 *   Ae    1 - albedo sum over l + m even of (2l+1) chi_l p_l p_l^T; Ao over l + m odd
 *   L     Ao = L L^T;  M = diag(mu^-1/2)
 *   S     L^T M^2 Ae M^2 L = Y K^2 Y^T;  X = M L Y, Z = M^-1 L^-T Y, X^T Z = 1
 *
 * At m = 0, sqrt(w) is an eigenvector of Ae with eigenvalue 1 - albedo exactly, so that
 * det S, and with it the small k, keeps all its digits up to albedo 1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "spp/fourstream.h"

#include <math.h>

#include "core/legendre.h"
#include "core/quadrature.h"

static const double PI = 3.14159265358979323846;

enum { MOMENTS = PPS_FOURSTREAM_MOMENTS, ORDERS = PPS_FOURSTREAM_ORDERS };

/* mu_1 = 0.23; the rest follows from exact sums of 1, mu and mu^2. fourstream_field.c
 * says why not Gauss's 0.2113. */
const pps_fourstream_nodes pps_fourstream_default = {
    {0.23, 0.5 + 1 / (12 * (0.5 - 0.23))},
    {1 - 0.27 / (0.27 + 1 / (12 * 0.27)), 0.27 / (0.27 + 1 / (12 * 0.27))}};

/* A symmetric 2 x 2 matrix: the entries 00, 10, 11; or its lower Cholesky factor. */
typedef struct {
    double a, b, c;
} matrix2;

static bool cholesky2(matrix2 *m) {
    if (!(m->a > 0)) {
        return false;
    }
    m->a = sqrt(m->a);
    m->b /= m->a;
    m->c -= m->b * m->b;
    if (!(m->c > 0)) {
        return false;
    }
    m->c = sqrt(m->c);
    return true;
}

/* v <- (L L^T)^-1 v */
static void cholesky2_solve(const matrix2 *l, double v[2]) {
    v[0] /= l->a;
    v[1] = (v[1] - l->b * v[0]) / l->c;
    v[1] /= l->c;
    v[0] = (v[0] - l->b * v[1]) / l->a;
}

/* The eigenvector of the larger eigenvalue, which is returned. */
static double largest_eigen2(const matrix2 *m, double v[2]) {
    double d = (m->a - m->c) / 2, r = hypot(d, m->b);
    v[0] = d >= 0 ? d + r : m->b; /* the form that does not cancel */
    v[1] = d >= 0 ? m->b : r - d;
    double norm = hypot(v[0], v[1]);
    if (norm > 0) {
        v[0] /= norm;
        v[1] /= norm;
    } else { /* a multiple of 1 */
        v[0] = 1;
        v[1] = 0;
    }
    return (m->a + m->c) / 2 + r;
}

/* p[l][i] of order m. */
static void node_functions(const pps_fourstream *four, int m, double p[MOMENTS][2]) {
    for (int i = 0; i < 2; i++) {
        double row[MOMENTS];
        pps_legendre(m, MOMENTS, four->nodes.mu[i], row);
        for (int l = m; l < MOMENTS; l++) {
            p[l][i] = sqrt(four->nodes.weight[i]) * row[l - m];
        }
    }
}

/* Ae (first = m) or Ao (first = m + 1). */
static matrix2 one_minus_scattering(const pps_fourstream *four, int first,
                                    double p[MOMENTS][2]) {
    matrix2 a = {1, 0, 1};
    for (int l = first; l < MOMENTS; l += 2) {
        double factor = four->albedo * four->strength[l];
        a.a -= factor * p[l][0] * p[l][0];
        a.b -= factor * p[l][1] * p[l][0];
        a.c -= factor * p[l][1] * p[l][1];
    }
    return a;
}

/* det Ae; at m = 0 the product of its eigenvalues, 1 - albedo with sqrt(w) and the one
 * of p_2, which is orthogonal to it. */
static double det_even(const pps_fourstream *four, int m, const matrix2 *ae,
                       double p[MOMENTS][2]) {
    if (m > 0) {
        return ae->a * ae->c - ae->b * ae->b;
    }
    double p2 = p[2][0] * p[2][0] + p[2][1] * p[2][1];
    return four->co_albedo * (1 - four->albedo * four->strength[2] * p2);
}

/* L^T M^2 A M^2 L */
static matrix2 congruence(const matrix2 *l, const matrix2 *a, const double mu[2]) {
    double aa = a->a / (mu[0] * mu[0]), ab = a->b / (mu[0] * mu[1]),
           ac = a->c / (mu[1] * mu[1]);
    return (matrix2){l->a * l->a * aa + 2 * l->a * l->b * ab + l->b * l->b * ac,
                     l->c * (l->a * ab + l->b * ac), l->c * l->c * ac};
}

/* What of the modes the boundary and the rays need, from y, a column of Y. */
static void keep_mode(pps_fourstream_order *order, const pps_fourstream *four, int m,
                      int j, const matrix2 *l, const double y[2],
                      double p[MOMENTS][2]) {
    const double *mu = four->nodes.mu, *w = four->nodes.weight;
    double ly[2] = {l->a * y[0], l->b * y[0] + l->c * y[1]}; /* L Y */
    double z[2] = {0, y[1] / l->c};                          /* L^-T Y */
    z[0] = (y[0] - l->b * z[1]) / l->a;
    for (int i = m; i < MOMENTS; i++) {
        order->moment[i][j] = (i - m) % 2
                                  ? p[i][0] * z[0] + p[i][1] * z[1]
                                  : p[i][0] / mu[0] * ly[0] + p[i][1] / mu[1] * ly[1];
    }
    order->sky[j] = sqrt(w[0]) * ly[0] + sqrt(w[1]) * ly[1];
}

/* G = Y^T L^T M^2 L Y */
static void keep_gram(pps_fourstream_order *order, const matrix2 *l, const double mu[2],
                      double y[2][2]) {
    double x[2][2]; /* [mode][node] */
    for (int j = 0; j < 2; j++) {
        x[j][0] = l->a * y[j][0] / sqrt(mu[0]);
        x[j][1] = (l->b * y[j][0] + l->c * y[j][1]) / sqrt(mu[1]);
    }
    order->gram[0] = x[0][0] * x[0][0] + x[0][1] * x[0][1];
    order->gram[1] = x[0][0] * x[1][0] + x[0][1] * x[1][1];
    order->gram[2] = x[1][0] * x[1][0] + x[1][1] * x[1][1];
}

static pps_status find_modes(pps_fourstream *four, int m) {
    pps_fourstream_order *order = &four->order[m];
    const double *mu = four->nodes.mu;
    double p[MOMENTS][2], y[2][2];
    node_functions(four, m, p);
    matrix2 ae = one_minus_scattering(four, m, p);
    matrix2 l = one_minus_scattering(four, m + 1, p);
    double det_ae = det_even(four, m, &ae, p);
    if (!cholesky2(&l) || !(ae.a > 0) || !(det_ae > 0 || (m == 0 && det_ae == 0))) {
        return PPS_ERR_INDEFINITE;
    }
    matrix2 s = congruence(&l, &ae, mu);
    double largest = largest_eigen2(&s, y[1]);
    double root = l.a * l.c / (mu[0] * mu[1]); /* det S = root^2 det Ae */
    y[0][0] = -y[1][1];
    y[0][1] = y[1][0];
    order->k[0] = root * sqrt(det_ae / largest);
    order->k[1] = sqrt(largest);
    for (int j = 0; j < 2; j++) {
        keep_mode(order, four, m, j, &l, y[j], p);
    }
    keep_gram(order, &l, mu, y);
    return PPS_OK;
}

/* Of light scattered n times by D, albedo^n f^n D^n: moments g^(n l) from four on,
 * f^n below. */
static void find_peaks(pps_fourstream *four) {
    double x = four->tail_stretch, g = four->slab.g, gn = 1, fn = 1;
    if (g < 0) {
        four->n_peaks = 2;
    } else if (g > 0) { /* until x^n < 1e-3 */
        double enough = ceil(log(1e-3) / log(x));
        four->n_peaks = (int)fmax(1, fmin(enough, PPS_FOURSTREAM_PEAKS));
    }
    for (int n = 1; n <= four->n_peaks; n++) {
        double gl = 1;
        gn *= g;
        fn *= four->f;
        four->peak[n].g = gn;
        for (int l = 0; l < MOMENTS; l++) {
            four->peak[n].polynomial[l] = (2 * l + 1) / (4 * PI) * (fn - gl);
            gl *= gn;
        }
    }
}

/* (2l+1) (g^l - f)/(1 - f); with f = g^4 both differences hold the factor 1 - g. */
static void scale_moments(pps_fourstream *four) {
    double g = four->slab.g, power = 1;
    for (int l = 0; l < MOMENTS; l++) {
        double share = 1; /* (1 - g^(4 - l))/(1 - g^4) */
        if (g > 0) {
            double sum = 0;
            for (int i = 0; i < MOMENTS - l; i++) {
                sum = 1 + g * sum;
            }
            share = sum / ((1 + g) * (1 + g * g));
        }
        four->strength[l] = (2 * l + 1) * power * share;
        power *= g;
    }
}

pps_status pps_fourstream_init(pps_fourstream *four, const pps_slab *slab,
                               const pps_fourstream_nodes *nodes) {
    double g = slab->g, albedo = slab->albedo;
    double rest = g > 0 ? (1 - g) * (1 + g) * (1 + g * g) : 1; /* 1 - f */
    *four = (pps_fourstream){.slab = *slab, .nodes = *nodes};
    four->f = g > 0 ? g * g * g * g : 0;
    four->tail_stretch = albedo * four->f;
    four->stretch = (1 - albedo) + albedo * rest;
    four->albedo = albedo * rest / four->stretch;
    four->co_albedo = (1 - albedo) / four->stretch;
    four->n_orders = g == 0 ? 1 : ORDERS;
    scale_moments(four);
    for (int m = 0; m < four->n_orders; m++) {
        pps_status status = find_modes(four, m);
        if (status) {
            return status;
        }
    }
    find_peaks(four);
    pps_gauss_unit(PPS_FOURSTREAM_PEAK_POINTS, four->point, four->point_weight);
    return PPS_OK;
}

/* alpha = X^T a and beta = Z^T b of both modes. */
static void light_modes(pps_fourstream *four, int m, double thickness) {
    pps_fourstream_order *order = &four->order[m];
    double legendre[MOMENTS], alpha[2] = {0}, beta[2] = {0};
    pps_legendre(m, MOMENTS, four->mu0, legendre);
    for (int l = m; l < MOMENTS; l++) {
        double source = (m > 0 ? 2 : 1) / (2 * PI) * four->albedo * four->strength[l] *
                        legendre[l - m];
        double *part = (l - m) % 2 ? beta : alpha;
        part[0] += source * order->moment[l][0];
        part[1] += source * order->moment[l][1];
    }
    for (int j = 0; j < 2; j++) {
        pps_mode_beam(&order->mode[j], order->k[j], thickness, 1 / four->mu0, alpha[j],
                      beta[j]);
    }
}

/* Edge values of the homogeneous part from what the boundary conditions
 * G psi + phi = top, G psi - phi = 0 still ask for: the solves of docs/theory.md,
 * section 4. */
static void close_modes(pps_fourstream_order *order, double thickness,
                        const double at_top[2], const double at_bottom[2]) {
    double half = thickness / 2, a[2][2], b[2][2], cross[2][2];
    const double *g = order->gram, *k = order->k;
    matrix2 even = {g[0] + pps_k_tanh(k[0], half), g[1], g[2] + pps_k_tanh(k[1], half)};
    matrix2 odd = {g[0] + pps_k_coth(k[0], half), g[1], g[2] + pps_k_coth(k[1], half)};
    cholesky2(&even); /* G is a Gram matrix, the rest is not negative */
    cholesky2(&odd);
    for (int side = 0; side < 2; side++) {
        for (int j = 0; j < 2; j++) {
            a[side][j] = b[side][j] = side == 0 ? at_top[j] : at_bottom[j];
        }
        cholesky2_solve(&even, a[side]);
        cholesky2_solve(&odd, b[side]);
        for (int j = 0; j < 2; j++) {
            cross[side][j] = pps_2k_csch(k[j], thickness) * b[side][j];
        }
        cholesky2_solve(&even, cross[side]);
    }
    for (int j = 0; j < 2; j++) {
        pps_mode_edges edges = {.even = (a[0][j] + a[1][j]) / 2,
                                .odd = (b[1][j] - b[0][j]) / 2,
                                .bottom = (a[1][j] + b[1][j] + cross[0][j]) / 2,
                                .top = (a[0][j] + b[0][j] + cross[1][j]) / 2};
        pps_mode_close(&order->mode[j], &edges);
    }
}

void pps_fourstream_solve(pps_fourstream *four, double thickness, double mu0) {
    double scaled = thickness * four->stretch;
    four->slab.thickness = thickness;
    four->mu0 = mu0;
    four->sky = false;
    for (int m = 0; m < four->n_orders; m++) {
        pps_fourstream_order *order = &four->order[m];
        double psi[2][2], phi[2][2], top[2], bottom[2]; /* [mode][edge] */
        light_modes(four, m, scaled);
        for (int j = 0; j < 2; j++) {
            pps_mode_particular(&order->mode[j], psi[j], phi[j]);
        }
        for (int j = 0; j < 2; j++) {
            const double *row = &order->gram[j];
            top[j] = -(row[0] * psi[0][0] + row[1] * psi[1][0] + phi[j][0]);
            bottom[j] = -(row[0] * psi[0][1] + row[1] * psi[1][1] - phi[j][1]);
        }
        close_modes(order, scaled, top, bottom);
    }
}

void pps_fourstream_solve_sky(pps_fourstream *four, double thickness) {
    double scaled = thickness * four->stretch, dark[2] = {0, 0};
    pps_fourstream_order *order = &four->order[0];
    four->slab.thickness = thickness;
    four->mu0 = 1;
    four->sky = true;
    for (int j = 0; j < 2; j++) {
        pps_mode_dark(&order->mode[j], order->k[j], scaled);
    }
    /* I = 1 at the nodes going down: s + d = 2 sqrt(w mu), X^T of it. */
    double top[2] = {2 * order->sky[0], 2 * order->sky[1]};
    close_modes(order, scaled, top, dark);
}
