/* Small symmetric eigenproblems: Householder reduction and implicit QL.
 *
 * The solver's matrices have their large elements first. The reduction wants them so; QL
 * wants them last, so the tridiagonal matrix is turned round in between.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "solver/eigen.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/lanes.h"

enum { MOST = PPS_EIGEN_SMALL, MOST_SWEEPS = 40 /* an eigenvalue; two are usual */ };

/* Columns are padded to whole blocks, with zeros that stay zeros. */
typedef struct {
    size_t n, rows;          /* rows: n padded */
    double d[MOST], e[MOST]; /* the tridiagonal matrix: e[i] beside d[i], d[i + 1] */
    double beta[MOST];       /* reflection k is 1 - beta v v^T, v column k of `a` */
    double a[MOST * MOST], q[MOST * MOST];
    double p[MOST];
} work;

PPS_LANE double sum_of(four x) { return (x[0] + x[2]) + (x[1] + x[3]); }

PPS_LANE double dot(size_t rows, const double *x, const double *y) {
    four sum = {0};
    for (size_t i = 0; i < rows; i += FOUR) {
        sum += four_at(x + i) * four_at(y + i);
    }
    return sum_of(sum);
}

/* y += factor x */
PPS_LANE void add(size_t rows, double factor, const double *x, double *y) {
    for (size_t i = 0; i < rows; i += FOUR) {
        four_to(y + i, four_at(y + i) + factor * four_at(x + i));
    }
}

/* The reflection that takes column k below the diagonal to a multiple of e_(k+1); rows up
 * to k of v become 0. */
PPS_LANE void make_reflection(work *w, size_t k) {
    double *v = w->a + k * w->rows;
    w->d[k] = v[k];
    for (size_t i = 0; i <= k; i++) {
        v[i] = 0;
    }
    double first = v[k + 1];
    v[k + 1] = 0;
    double rest = dot(w->rows, v, v), norm2 = first * first + rest;
    if (!(rest > 0)) { /* nothing below the subdiagonal */
        w->e[k] = first;
        w->beta[k] = 0;
        return;
    }
    double alpha = first > 0 ? -sqrt(norm2) : sqrt(norm2); /* no cancellation below */
    v[k + 1] = first - alpha;
    w->e[k] = alpha;
    w->beta[k] = 1 / (norm2 - alpha * first); /* 2 / |v|^2 */
}

/* p = factor times the sum of v_j and column j >= from, rows from `skip` on; four columns at
 * a time, so that p is not waited for so often. */
PPS_LANE void multiply(work *w, size_t from, size_t skip, double factor,
                       const double *v) {
    size_t rows = w->rows, j = from;
    memset(w->p, 0, rows * sizeof *w->p);
    for (; j + 4 <= w->n; j += 4) {
        const double *a = w->a + j * rows;
        double x[4] = {factor * v[j], factor * v[j + 1], factor * v[j + 2],
                       factor * v[j + 3]};
        for (size_t i = skip; i < rows; i += FOUR) {
            four first = x[0] * four_at(a + i) + x[1] * four_at(a + rows + i);
            four second =
                x[2] * four_at(a + 2 * rows + i) + x[3] * four_at(a + 3 * rows + i);
            four_to(w->p + i, four_at(w->p + i) + (first + second));
        }
    }
    for (; j < w->n; j++) {
        add(rows - skip, factor * v[j], w->a + j * rows + skip, w->p + skip);
    }
}

PPS_LANE void reduce(work *w) {
    size_t n = w->n, rows = w->rows;
    for (size_t k = 0; k + 2 < n; k++) {
        make_reflection(w, k);
        const double *v = w->a + k * rows;
        double beta = w->beta[k];
        if (beta == 0) {
            continue;
        }
        size_t skip = (k + 1) / FOUR * FOUR, left = rows - skip;
        multiply(w, k + 1, skip, beta, v); /* p = beta A v */
        double share = beta / 2 * dot(left, v + skip, w->p + skip);
        add(left, -share, v + skip, w->p + skip);
        for (size_t j = k + 1; j < n; j++) { /* A <- A - v p^T - p v^T */
            double *column = w->a + j * rows + skip;
            double pj = w->p[j], vj = v[j];
            for (size_t i = 0; i < left; i += FOUR) {
                four_to(column + i,
                        four_at(column + i) - (pj * four_at(v + skip + i) +
                                               vj * four_at(w->p + skip + i)));
            }
        }
    }
    if (n > 1) {
        w->d[n - 2] = w->a[(n - 2) * rows + n - 2];
        w->e[n - 2] = w->a[(n - 2) * rows + n - 1];
    }
    w->d[n - 1] = w->a[(n - 1) * rows + n - 1];
    w->e[n - 1] = 0;
}

/* Last row and column first: d, e and the columns of Q. */
PPS_LANE void turn_round(work *w) {
    size_t n = w->n;
    for (size_t i = 0; i < n / 2; i++) {
        double d = w->d[i];
        w->d[i] = w->d[n - 1 - i];
        w->d[n - 1 - i] = d;
        for (size_t row = 0; row < w->rows; row += FOUR) {
            double *x = w->q + i * w->rows + row,
                   *y = w->q + (n - 1 - i) * w->rows + row;
            four keep = four_at(x);
            four_to(x, four_at(y));
            four_to(y, keep);
        }
    }
    for (size_t i = 0; i + 1 < n - 1 - i; i++) {
        double e = w->e[i];
        w->e[i] = w->e[n - 2 - i];
        w->e[n - 2 - i] = e;
    }
}

/* Q, the product of the reflections, from the last to the first. */
PPS_LANE void accumulate(work *w) {
    size_t n = w->n, rows = w->rows;
    memset(w->q, 0, n * rows * sizeof *w->q);
    for (size_t j = 0; j < n; j++) {
        w->q[j * rows + j] = 1;
    }
    for (size_t k = n > 2 ? n - 2 : 0; k-- > 0;) {
        size_t skip = (k + 1) / FOUR * FOUR;
        const double *v = w->a + k * rows + skip;
        for (size_t j = k + 1; j < n; j++) {
            double *column = w->q + j * rows + skip;
            add(rows - skip, -w->beta[k] * dot(rows - skip, v, column), v, column);
        }
    }
}

/* Columns i and i + 1 of Q, turned: done at once, while the next rotation waits for its
 * root. */
PPS_LANE void rotate(work *w, size_t i, double c, double s) {
    double *x = w->q + i * w->rows, *y = x + w->rows;
    for (size_t k = 0; k < w->rows; k += FOUR) {
        four here = four_at(x + k), next = four_at(y + k);
        four_to(y + k, s * here + c * next);
        four_to(x + k, c * here - s * next);
    }
}

/* The end of the unreduced block that starts at l. */
PPS_LANE size_t block_end(const work *w, size_t l) {
    size_t m = l;
    while (m + 1 < w->n &&
           fabs(w->e[m]) > DBL_EPSILON * (fabs(w->d[m]) + fabs(w->d[m + 1]))) {
        m++;
    }
    return m;
}

/* One implicit QL sweep over rows l..m, shifted towards the eigenvalue at l. */
PPS_LANE void sweep(work *w, size_t l, size_t m) {
    double *d = w->d, *e = w->e;
    double half = (d[l + 1] - d[l]) / (2 * e[l]), root = sqrt(half * half + 1);
    double g = d[m] - d[l] + e[l] / (half + (half < 0 ? -root : root));
    double s = 1, c = 1, p = 0;
    for (size_t i = m; i-- > l;) {
        double f = s * e[i], b = c * e[i], h = f * f + g * g, r = sqrt(h);
        e[i + 1] = r;
        if (h < DBL_MIN) { /* it fell apart on the way: deflate */
            d[i + 1] -= p;
            e[m] = 0;
            return;
        }
        double over = r * (1 / h); /* 1/r, without waiting for r */
        s = f * over;
        c = g * over;
        g = d[i + 1] - p;
        r = (d[i] - g) * s + c * (b + b);
        p = s * r;
        d[i + 1] = g + p;
        g = c * r - b;
        rotate(w, i, c, s);
    }
    d[l] -= p;
    e[l] = g;
    e[m] = 0;
}

PPS_CLONES static bool diagonalise(work *w) {
    reduce(w);
    accumulate(w);
    turn_round(w);
    for (size_t l = 0; l < w->n; l++) {
        size_t m;
        for (int sweeps = 0; (m = block_end(w, l)) > l; sweeps++) {
            if (sweeps == MOST_SWEEPS) {
                return false;
            }
            sweep(w, l, m);
        }
    }
    return true;
}

bool pps_eigen_small(int order, double *a, double *value, double *y) {
    work w;
    w.n = (size_t)order;
    w.rows = pps_padded(w.n);
    for (size_t j = 0; j < w.n; j++) {
        memcpy(w.a + j * w.rows, a + j * w.n, w.n * sizeof *a);
        memset(w.a + j * w.rows + w.n, 0, (w.rows - w.n) * sizeof *a);
    }
    if (!diagonalise(&w)) {
        return false;
    }
    for (size_t j = 0; j < w.n; j++) { /* the smallest first */
        size_t least = 0;
        for (size_t i = 1; i < w.n; i++) {
            least = w.d[i] < w.d[least] ? i : least;
        }
        value[j] = w.d[least];
        w.d[least] = HUGE_VAL;
        memcpy(y + j * w.n, w.q + least * w.rows, w.n * sizeof *y);
    }
    return true;
}
