/* Modes with k w < 1 as power series in depth.
 *
 * Such modes are entire in tau and vary by a factor e at most over the slab, while their
 * exponentials coincide as k -> 0. From their values at an edge,
 *     psi' = -phi + beta e^(-q tau),    phi' = -k^2 psi + alpha e^(-q tau)
 * gives the coefficients of psi = sum over d of a_d u^d, phi likewise with b_d, where u is
 * the distance from that edge over w, one after the other. PPS_SERIES_TERMS of them are
 * good to rounding for k w < 1 and, where the beam takes part, w q < 2.
 *
 * Every mode, order and beam shares the ray integrals of u^d.
 *
 * Reference: docs/theory.md section 5.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_SERIES_H
#define PPS_CORE_SERIES_H

#include <stddef.h>

enum { PPS_SERIES_TERMS = 26 };

/* What a series is made from, one number a beam of a block (PPS_LANES of them), of which
 * the first n are wanted. */
typedef struct pps_series {
    size_t n;
    const double *q, *beam; /* beam: e^(-q tau) at the edge */
    const double *alpha, *beta;
    const double *psi, *phi; /* at the edge */
} pps_series;

/* a[d * PPS_LANES + lane] and b likewise, of the n beams. step = w from the top, -w from
 * the bottom. */
void pps_series_expand(const pps_series *series, double step, double k,
                       double *restrict a, double *restrict b);

/* psi = sum over d of a_d u^d and phi likewise, of the first n beams of a block; numbers of
 * no meaning for the others. */
void pps_series_value(size_t n, const double *a, const double *b, double u, double *psi,
                      double *phi);

/* moment[d * padded + i] = c int_0^t (s/w)^d e^(-c (t - s)) ds, d < PPS_SERIES_TERMS, for
 * rays i of rates c[i] and one t; ect = e^(-c t), root = e^(-c t / 2). */
void pps_series_moments(size_t padded, double w, double t, const double *c,
                        const double *ect, const double *root, double *moment);

#endif
