/* The eigen solution of one azimuthal order, symmetric and split by parity.
 *
 * With S = I(+mu) + I(-mu), D = I(+mu) - I(-mu), s = sqrt(w mu) S, d = sqrt(w mu) D:
 *     d' = -E s + ...,  s' = -F d + ...,  E = M (1 - Ce) M,  F = M (1 - Co) M.
 *   1 - Co = L1 L1^T, so F = L L^T with L = M L1
 *   1 - Ce = R^T R
 *   B = R M L = U K Y^T; X = L Y, Z = L^-T Y; X^T Z = 1
 * Neither matrix is ever squared on graded nodes: B keeps the digits of the small k.
 *
 * Both factorisations must succeed. That they do not is the honest sign that the
 * truncated phase function is indefinite on these nodes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/lanes.h"
#include "core/legendre.h"
#include "core/vector.h"
#include "solver/lapack.h"
#include "solver/order.h"

/* Scratch of one eigenproblem. */
typedef struct {
    double *p;      /* p_l of the nodes: p[i + (l - m) * n] */
    double *lower;  /* L1 */
    double *root;   /* R; for m = 0 first the Cholesky factor of N */
    double *b, *y;  /* B and Y; b is scratch afterwards */
    double *work;   /* of LAPACK */
    double *vector; /* 3 n: sqrt(w), Householder vector, iteration vector */
    double *memory;
} eigen_scratch;

static pps_status scratch_alloc(eigen_scratch *s, int n, int n_columns) {
    size_t nn = (size_t)n * (size_t)n, np = (size_t)n * (size_t)n_columns;
    s->memory =
        malloc((np + 4 * nn + pps_lapack_work(n) + 3 * (size_t)n) * sizeof *s->memory);
    if (!s->memory) {
        return PPS_ERR_MEMORY;
    }
    s->p = s->memory;
    s->lower = s->p + np;
    s->root = s->lower + nn;
    s->b = s->root + nn;
    s->y = s->b + nn;
    s->work = s->y + nn;
    s->vector = s->work + pps_lapack_work(n);
    return PPS_OK;
}

void pps_discrete_legendre(const pps_discrete *discrete, int m, size_t n,
                           const double *mu, double *p) {
    pps_legendre_array(m, discrete->n_moments, n, mu, n, p);
    for (int l = 2; m == 0 && l < discrete->n_moments; l += 2) {
        for (size_t i = 0; i < n; i++) {
            p[(size_t)l * n + i] -= discrete->bias[l];
        }
    }
}

double pps_discrete_single(const pps_discrete *discrete, double mu, double mu0) {
    double at[PPS_STREAMS_MAX], at0[PPS_STREAMS_MAX], sum = 0;
    pps_discrete_legendre(discrete, 0, 1, &mu, at);
    pps_discrete_legendre(discrete, 0, 1, &mu0, at0);
    for (int l = 0; l < discrete->n_moments; l++) {
        sum += discrete->strength[l] * at[l] * at0[l];
    }
    return discrete->albedo / (4 * 3.14159265358979323846) * sum;
}

/* p_l(mu_i) = sqrt(w_i) P_l(mu_i), one column an l. */
static void node_functions(const pps_discrete *d, int m, double *p) {
    pps_discrete_legendre(d, m, (size_t)d->n, d->mu, p);
    for (int c = 0; c < d->n_moments - m; c++) {
        for (int i = 0; i < d->n; i++) {
            p[i + c * d->n] *= d->root_weight[i];
        }
    }
}

/* y -= factor x */
static inline void subtract(int n, double factor, const double *restrict x,
                            double *restrict y) {
    for (int i = 0; i < n; i++) {
        y[i] -= factor * x[i];
    }
}

enum { MOST_FOURS = 4 };

/* `fours` FOURs of rows from i on, of column j of 1 - sum of factor_r p_r p_r^T; p_r is
 * column 2 r of p. Rows past the end are worked out from what lies there, and dropped. */
PPS_LANE void scattering_rows(size_t fours, size_t n, size_t n_terms,
                              const double *factor, const double *p, size_t i, size_t j,
                              double *a) {
    four sum[MOST_FOURS] = {{0}};
    double rows[MOST_FOURS * FOUR];
    for (size_t r = 0; r < n_terms; r++) {
        for (size_t f = 0; f < fours; f++) {
            sum[f] += factor[r] * four_at(p + 2 * r * n + i + f * FOUR);
        }
    }
    for (size_t f = 0; f < fours; f++) {
        four_to(rows + f * FOUR, -sum[f]);
    }
    size_t left = n - i < fours * FOUR ? n - i : fours * FOUR;
    memcpy(a + i + j * n, rows, left * sizeof *a);
}

/* A <- 1 - albedo sum over l = first, first + 2, .. of strength_l p_l p_l^T, lower
 * triangle (and a little more), from row and column `skip` on. p is followed by FOUR
 * numbers that may be read. */
PPS_CLONES static void one_minus_scattering(const pps_discrete *d, int m, int first,
                                            int skip, const double *p, double *a) {
    size_t n = (size_t)d->n;
    const double *pl = p + (size_t)(first - m) * n;
    double factor[PPS_STREAMS_MAX / 2];
    for (size_t j = (size_t)skip; j < n; j++) {
        size_t n_terms = 0, i = j / FOUR * FOUR;
        for (int l = first; l < d->n_moments; l += 2, n_terms++) {
            factor[n_terms] = d->albedo * d->strength[l] * pl[2 * n_terms * n + j];
        }
        for (; i + 4 * FOUR <= n; i += 4 * FOUR) {
            scattering_rows(4, n, n_terms, factor, pl, i, j, a);
        }
        for (; i + FOUR < n; i += 2 * FOUR) {
            scattering_rows(2, n, n_terms, factor, pl, i, j, a);
        }
        if (i < n) {
            scattering_rows(1, n, n_terms, factor, pl, i, j, a);
        }
        a[j + j * n] += 1;
    }
}

/* v <- H v, H = 1 - 2 h h^T with |h| = 1. */
static void reflect(int n, const double *h, double *v) {
    double dot = 0;
    for (int i = 0; i < n; i++) {
        dot += h[i] * v[i];
    }
    for (int i = 0; i < n; i++) {
        v[i] -= 2 * dot * h[i];
    }
}

/* m = 0: sqrt(w) is an eigenvector of Ce with eigenvalue `albedo` exactly, as the even
 * P_l are orthogonal to 1 on a hemisphere (the Gauss nodes; others are made so by bias). H, which takes sqrt(w) to -e1, turns 1 - Ce
 * into diag(1 - albedo, N); both are set so, and the small eigenvalue keeps its digits up
 * to albedo 1. N = C C^T is left in root, rows and columns 1.. .*/
static bool factor_even_isotropic(const pps_discrete *d, eigen_scratch *s) {
    int n = d->n;
    double *h = s->vector + n, norm = 0;
    for (int i = 0; i < n; i++) {
        h[i] = d->root_weight[i] + (i == 0);
        norm += h[i] * h[i];
    }
    for (int i = 0; i < n; i++) {
        h[i] /= sqrt(norm);
    }
    for (int l = 2; l < d->n_moments; l += 2) {
        reflect(n, h, s->p + (size_t)l * (size_t)n);
    }
    memset(s->root, 0, (size_t)n * (size_t)n * sizeof *s->root);
    one_minus_scattering(d, 0, 2, 1, s->p, s->root);
    /* Close the block up to (n-1) x (n-1) for the factorisation, and open it again. */
    int r = n - 1;
    for (int j = 0; j < r; j++) {
        memmove(s->b + j * r, s->root + 1 + (j + 1) * n, (size_t)r * sizeof *s->b);
    }
    if (r > 0 && !pps_cholesky(r, s->b)) {
        return false;
    }
    for (int j = 0; j < r; j++) {
        memcpy(s->root + 1 + (j + 1) * n, s->b + j * r, (size_t)r * sizeof *s->b);
    }
    return true;
}

/* B = R diag(1/mu) L1. For m = 0, R = diag(sqrt(1 - albedo), C^T) H, made triangular by
 * an orthogonal factor from the left, which leaves K and Y alone, where the nodes are
 * graded: so that B is graded from large to small like them. */
PPS_CLONES static void build_b(const pps_discrete *d, int m, eigen_scratch *s) {
    int n = d->n;
    double *r = s->b;
    memset(r, 0, (size_t)n * (size_t)n * sizeof *r);
    for (int j = 0; j < n; j++) { /* R = root^T */
        for (int i = j; i < n; i++) {
            r[j + i * n] = s->root[i + j * n];
        }
    }
    if (m == 0) {
        const double *h = s->vector + n;
        r[0] = sqrt(d->co_albedo);
        double *rh = s->vector + 2 * n;
        memset(rh, 0, (size_t)n * sizeof *rh);
        for (int j = 0; j < n; j++) { /* R <- R H */
            subtract(n, -h[j], r + j * n, rh);
        }
        for (int j = 0; j < n; j++) {
            subtract(n, 2 * h[j], rh, r + j * n);
        }
        if (!d->squared) {
            pps_qr_r(n, r, s->work);
        }
    }
    for (int j = 0; j < n; j++) {
        double over = 1 / d->mu[j];
        for (int i = 0; i < n; i++) {
            r[i + j * n] *= over;
        }
    }
    pps_multiply(false, n, n, n, r, n, s->lower, n, s->y, n);
    memcpy(s->b, s->y, (size_t)n * (size_t)n * sizeof *s->b);
}

/* y <- (1 - albedo) (B^T B)^-1 y = L1^-1 mu H diag(1, (1 - albedo) N^-1) H mu L1^-T y,
 * finite at albedo 1, where k = 0. */
static void inverse_step(const pps_discrete *d, const eigen_scratch *s, double *y) {
    int n = d->n;
    const double *h = s->vector + n;
    pps_lower_solve(n, s->lower, true, y);
    for (int i = 0; i < n; i++) {
        y[i] *= d->mu[i];
    }
    reflect(n, h, y);
    /* root holds C in rows and columns 1..; a unit entry at (0, 0) leaves y[0] alone. */
    pps_lower_solve(n, s->root, false, y);
    pps_lower_solve(n, s->root, true, y);
    for (int i = 1; i < n; i++) {
        y[i] *= d->co_albedo;
    }
    reflect(n, h, y);
    for (int i = 0; i < n; i++) {
        y[i] *= d->mu[i];
    }
    pps_lower_solve(n, s->lower, false, y);
}

/* The smallest k of m = 0 to full relative accuracy: one inverse iteration, and the
 * Rayleigh quotient of the vector before it, whose error is the square of the vector's. */
static void refine_smallest(const pps_discrete *d, eigen_scratch *s, double *k) {
    int n = d->n;
    double *y = s->y, *image = s->vector + 2 * n;
    double before = 0, after = 0, product = 0;
    s->root[0] = 1;
    memcpy(image, y, (size_t)n * sizeof *y);
    inverse_step(d, s, image);
    for (int i = 0; i < n; i++) {
        before += y[i] * y[i];
        product += y[i] * image[i];
        after += image[i] * image[i];
    }
    k[0] = sqrt(d->co_albedo * before / product);
    for (int i = 0; i < n; i++) {
        y[i] = image[i] / sqrt(after);
    }
}

/* X = M L1 Y, Z = M^-1 L1^-T Y, and from them what the solver keeps: G, V, W. */
static void finish(pps_order *order, const pps_discrete *d, eigen_scratch *s) {
    int n = d->n, m = order->m;
    double *ly = s->b, *z = s->y; /* L1 Y; L1^-T Y, which takes the place of Y */
    memcpy(ly, s->y, (size_t)n * (size_t)n * sizeof *ly);
    pps_lower_times(n, s->lower, n, ly);
    pps_lower_solve_transposed(n, s->lower, n, z);
    for (int j = 0; j < n; j++) {
        double sum = 0;
        for (int i = 0; i < n; i++) {
            sum += d->root_weight[i] * ly[i + j * n]; /* sqrt(w mu) M = sqrt(w) */
        }
        order->flux_s[j] = sum;
    }
    /* V = (p_l / mu)^T L1 Y for l + m even; W = p_l^T L1^-T Y for odd. */
    double *row = s->work;
    if (m == 0) { /* H was applied to them */
        node_functions(d, m, s->p);
    }
    int stride = 2 * n;
    pps_multiply(true, order->n_odd, n, n, s->p + n, stride, z, n, order->w,
                 order->n_odd > 0 ? order->n_odd : 1);
    for (int i = 0; i < n; i++) {
        row[i] = 1 / d->mu[i];
    }
    for (int r = 0; r < order->n_even; r++) {
        for (int i = 0; i < n; i++) {
            s->p[i + r * stride] *= row[i];
        }
    }
    pps_multiply(true, order->n_even, n, n, s->p, stride, ly, n, order->v,
                 order->n_even);
    for (int i = 0; i < n; i++) {
        row[i] = 1 / sqrt(d->mu[i]);
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            ly[i + j * n] *= row[i]; /* X */
        }
    }
    pps_multiply(true, n, n, n, ly, n, ly, n, order->gram, n);
}

static pps_status order_alloc(pps_order *order, const pps_discrete *d, int m) {
    int rest = d->n_moments - m;
    *order =
        (pps_order){.m = m, .n = d->n, .n_even = (rest + 1) / 2, .n_odd = rest / 2};
    size_t n = (size_t)d->n, even = (size_t)order->n_even, odd = (size_t)order->n_odd;
    order->memory = malloc((n * (7 + even + odd) + 3 * n * n) * sizeof *order->memory);
    if (!order->memory) {
        return PPS_ERR_MEMORY;
    }
    double **vectors[] = {&order->k,    &order->flux_s, &order->tanh,    &order->coth,
                          &order->csch, &order->decay,  &order->sum_over};
    double *next = order->memory;
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++, next += n) {
        *vectors[i] = next;
    }
    order->gram = next;
    order->even = order->gram + n * n;
    order->odd = order->even + n * n;
    order->v = order->odd + n * n;
    order->w = order->v + even * n;
    return PPS_OK;
}

void pps_order_free(pps_order *order) {
    free(order->memory);
    free(order->beam_memory);
    free(order->solution.special);
    *order = (pps_order){0};
}

static pps_status solve_eigenproblem(pps_order *order, const pps_discrete *d,
                                     eigen_scratch *s) {
    int m = order->m, n = d->n;
    node_functions(d, m, s->p);
    one_minus_scattering(d, m, m + 1, 0, s->p, s->lower);
    if (!pps_cholesky(n, s->lower)) {
        return PPS_ERR_INDEFINITE;
    }
    if (m == 0) {
        if (!factor_even_isotropic(d, s)) {
            return PPS_ERR_INDEFINITE;
        }
    } else {
        one_minus_scattering(d, m, m, 0, s->p, s->root);
        if (!pps_cholesky(n, s->root)) {
            return PPS_ERR_INDEFINITE;
        }
    }
    build_b(d, m, s);
    pps_status status =
        pps_right_singular(n, d->squared, s->b, order->k, s->y, s->work);
    if (status) {
        return status;
    }
    if (m == 0) {
        refine_smallest(d, s, order->k);
    }
    finish(order, d, s);
    return PPS_OK;
}

pps_status pps_order_create(pps_order *order, const pps_discrete *discrete, int m) {
    pps_status status = order_alloc(order, discrete, m);
    if (status) {
        return status;
    }
    eigen_scratch scratch;
    status = scratch_alloc(&scratch, discrete->n, discrete->n_moments - m);
    if (!status) {
        status = solve_eigenproblem(order, discrete, &scratch);
        free(scratch.memory);
    }
    if (status) {
        pps_order_free(order);
    }
    return status;
}

void pps_order_project(const pps_order *order, const pps_discrete *discrete,
                       size_t padded, const double *mu, double *ge, double *go,
                       double *legendre) {
    int m = order->m;
    size_t n = (size_t)order->n;
    size_t n_even = (size_t)order->n_even, n_odd = (size_t)order->n_odd;
    pps_discrete_legendre(discrete, m, padded, mu, legendre);
    for (int l = m; l < discrete->n_moments; l++) {
        double factor = discrete->albedo / 2 * discrete->strength[l];
        double *row = legendre + (size_t)(l - m) * padded;
        for (size_t i = 0; i < padded; i++) {
            row[i] *= factor;
        }
    }
    pps_rows_multiply(n, n_even, order->v, n_even, padded, legendre, 2 * padded, ge);
    pps_rows_multiply(n, n_odd, order->w, n_odd, padded, legendre + padded, 2 * padded,
                      go);
}
