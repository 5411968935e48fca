/* Nodes and weights of a hemisphere.
 *
 * Gauss-Legendre by Newton's method in theta, x = cos theta, made cubic by Legendre's
 * equation, with the recurrence in differences and u = 1 - x, so that the nodes next to the
 * edges keep full relative accuracy. (GSL's table computes sizes that it has not stored to
 * 1e-10 only, which shows in the answers at 88 streams and not at 64.)
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/quadrature.h"

#include <math.h>

#include "core/vector.h"

enum { BLOCK = 64 }; /* nodes handled together */

/* P_n(cos theta) and sin(theta) times its derivative in theta, for many u = 1 - cos theta
 * at once. */
PPS_CLONES static void legendre_theta(int n, size_t n_nodes, const double *restrict u,
                                      double *restrict p, double *restrict slope) {
    double difference[BLOCK];
    for (size_t i = 0; i < n_nodes; i++) {
        p[i] = 1;
        difference[i] = 0;
    }
    for (int l = 0; l < n; l++) {
        /* (l + 1) (P_(l+1) - P_l) = l (P_l - P_(l-1)) - (2l + 1) u P_l */
        double back = (double)l / (l + 1), here = (double)(2 * l + 1) / (l + 1);
        for (size_t i = 0; i < n_nodes; i++) {
            difference[i] = back * difference[i] - here * u[i] * p[i];
            p[i] += difference[i];
        }
    }
    for (size_t i = 0; i < n_nodes; i++) {
        slope[i] = n * (difference[i] - u[i] * p[i]);
    }
}

/* Nodes and weights `first` to first + count - 1 of those below 1/2, and their mirrors. */
static void gauss_block(int n, size_t first, size_t count, double *node,
                        double *weight) {
    const double pi = 3.14159265358979323846;
    double theta[BLOCK], u[BLOCK], sine[BLOCK], p[BLOCK], slope[BLOCK];
    size_t last = (size_t)n - 1;
    for (size_t i = 0; i < count; i++) {
        double psi = pi * ((double)(first + i) + 0.75) / (n + 0.5);
        theta[i] = psi + 1 / (8 * (n + 0.5) * (n + 0.5) * tan(psi)); /* to n^-4 */
    }
    for (int step = 0;; step++) { /* relative error 2e-3, 6e-9, rounding */
        for (size_t i = 0; i < count; i++) {
            double s = sin(theta[i] / 2), c = cos(theta[i] / 2);
            size_t low = first + i, high = last - low;
            node[low] = s * s; /* (1 - x)/2 */
            node[high] = high == low ? 0.5 : c * c;
            sine[i] = 2 * s * c;
            u[i] = 2 * s * s;
        }
        legendre_theta(n, count, u, p, slope);
        if (step == 2) {
            break;
        }
        for (size_t i = 0; i < count; i++) {
            /* P'' = -cot theta P' - n (n + 1) P gives the second order of the step */
            double h = -p[i] * sine[i] / slope[i], cosine = 1 - u[i];
            theta[i] += h * (1 + h / 2 * (cosine / sine[i] - n * (n + 1.0) * h));
        }
    }
    for (size_t i = 0; i < count; i++) {
        double dp = slope[i] / sine[i];
        weight[first + i] = weight[last - (first + i)] = 1 / (dp * dp);
    }
}

void pps_gauss_unit(int n, double *node, double *weight) {
    size_t half = (size_t)(n + 1) / 2;
    for (size_t first = 0; first < half; first += BLOCK) {
        size_t left = half - first;
        gauss_block(n, first, left < BLOCK ? left : BLOCK, node, weight);
    }
}

void pps_hemisphere_nodes(pps_nodes kind, int n, double *mu, double *weight) {
    pps_gauss_unit(n, mu, weight);
    double sum = 0;
    int squarings = kind == PPS_NODES_GRADED ? 2 : kind == PPS_NODES_MAPPED ? 1 : 0;
    for (int step = 0; step < squarings; step++) {
        for (int i = 0; i < n; i++) {
            weight[i] *= 2 * mu[i];
            mu[i] *= mu[i];
        }
    }
    for (int i = 0; i < n; i++) {
        sum += weight[i];
    }
    for (int i = 0; i < n; i++) {
        weight[i] /= sum; /* 1 but for rounding, and for one graded node */
    }
}
