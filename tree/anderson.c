/* Anderson acceleration: least squares on differences, by their normal equations.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/anderson.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH = PPS_ANDERSON_DEPTH, BLOCK = 512 };
static const double RIDGE = 1e-6; /* of floats' normal equations */

pps_status pps_anderson_init(pps_anderson *a, size_t n, size_t measured) {
    *a = (pps_anderson){.n = n, .measured = measured};
    a->memory =
        aligned_alloc(sizeof(pps_bands), (2 + 2 * DEPTH) * (n + 1) * sizeof(pps_bands));
    if (!a->memory) {
        return PPS_ERR_MEMORY;
    }
    a->f = a->memory;
    a->g = a->f + n;
    for (int i = 0; i < DEPTH; i++) {
        a->df[i] = a->g + n + 2 * (size_t)i * n;
        a->dg[i] = a->df[i] + n;
    }
    return PPS_OK;
}

void pps_anderson_clear(pps_anderson *a) {
    free(a->memory);
    a->memory = NULL;
}

void pps_anderson_restart(pps_anderson *a) {
    a->kept = a->next = 0;
    a->started = false;
}

/* Weighted sums over cells; floats in blocks, doubles over them. */
typedef struct {
    double ff[4], gg[4], fd[DEPTH][4],
        dd[DEPTH][4]; /* d: newest difference, dd: with i */
} sums;

static void add_to(double out[4], pps_bands part) {
    for (int b = 0; b < 4; b++) {
        out[b] += (double)part[b];
    }
}

static void add_block(pps_anderson *a, const float *weight, const pps_bands *x,
                      const pps_bands *g, size_t from, size_t to, int kept, sums *s) {
    pps_bands ff = {0}, gg = {0}, fd[DEPTH] = {0}, dd[DEPTH] = {0};
    pps_bands *newest = a->df[a->next], *image = a->dg[a->next];
    for (size_t i = from; i < to; i++) {
        pps_bands f = g[i] - x[i], wf = weight[i] * f;
        ff += wf * f;
        gg += weight[i] * g[i] * g[i];
        if (a->started) {
            newest[i] = f - a->f[i];
            image[i] = g[i] - a->g[i];
            for (int k = 0; k < kept; k++) {
                fd[k] += wf * a->df[k][i];
                dd[k] += weight[i] * newest[i] * a->df[k][i];
            }
        }
        a->f[i] = f;
        a->g[i] = g[i];
    }
    add_to(s->ff, ff);
    add_to(s->gg, gg);
    for (int k = 0; k < kept; k++) {
        add_to(s->fd[k], fd[k]);
        add_to(s->dd[k], dd[k]);
    }
}

/* Of what is not measured: its newest difference. */
static void note_rest(pps_anderson *a, const pps_bands *g) {
    pps_bands *image = a->dg[a->next];
    for (size_t i = a->measured; i < a->n; i++) {
        image[i] = g[i] - a->g[i];
        a->g[i] = g[i];
    }
}

/* (gram + ridge) gamma = fd by Cholesky, in place; a band without light gets zeros. */
static void solve_band(const pps_anderson *a, int n, int band, const sums *s,
                       double gamma[DEPTH]) {
    double l[DEPTH][DEPTH], trace = 0;
    for (int i = 0; i < n; i++) {
        trace += a->gram[i][i][band];
    }
    for (int i = 0; i < n; i++) {
        gamma[i] = 0;
    }
    if (!(trace > 0)) {
        return;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j <= i; j++) {
            double sum = a->gram[i][j][band] + (i == j ? RIDGE * trace : 0);
            for (int k = 0; k < j; k++) {
                sum -= l[i][k] * l[j][k];
            }
            l[i][j] = i == j ? sqrt(fmax(sum, RIDGE * trace)) : sum / l[j][j];
        }
    }
    for (int i = 0; i < n; i++) {
        gamma[i] = s->fd[i][band];
        for (int k = 0; k < i; k++) {
            gamma[i] -= l[i][k] * gamma[k];
        }
        gamma[i] /= l[i][i];
    }
    for (int i = n; i-- > 0;) {
        for (int k = i + 1; k < n; k++) {
            gamma[i] -= l[k][i] * gamma[k];
        }
        gamma[i] /= l[i][i];
    }
}

static void mix(const pps_anderson *a, int n, const sums *s, pps_bands *x,
                const pps_bands *g) {
    pps_bands gamma[DEPTH] = {0};
    for (int b = 0; b < 4; b++) {
        double one[DEPTH];
        solve_band(a, n, b, s, one);
        for (int k = 0; k < n; k++) {
            gamma[k][b] = (float)one[k];
        }
    }
    for (size_t i = 0; i < a->n; i++) {
        pps_bands next = g[i];
        for (int k = 0; k < n; k++) {
            next -= gamma[k] * a->dg[k][i];
        }
        x[i] = pps_bands_at_least_0(next);
    }
}

double pps_anderson_step(pps_anderson *a, const float *weight, pps_bands *x,
                         const pps_bands *g) {
    sums s = {0};
    int newest = a->next, kept = a->kept;
    if (a->started && kept < DEPTH) {
        kept++;
    }
    for (size_t from = 0; from < a->measured; from += BLOCK) {
        size_t to = from + BLOCK < a->measured ? from + BLOCK : a->measured;
        add_block(a, weight, x, g, from, to, kept, &s);
    }
    note_rest(a, g);
    if (a->started) {
        for (int k = 0; k < kept; k++) {
            memcpy(a->gram[k][newest], s.dd[k], sizeof s.dd[k]);
            memcpy(a->gram[newest][k], s.dd[k], sizeof s.dd[k]);
        }
        a->kept = kept;
        a->next = (newest + 1) % DEPTH;
    }
    a->started = true;
    mix(a, kept, &s, x, g);
    double change = 0;
    for (int b = 0; b < 4; b++) {
        change =
            fmax(change, s.gg[b] > 0 ? sqrt(s.ff[b] / s.gg[b]) : (s.ff[b] > 0 ? 1 : 0));
    }
    return change;
}
