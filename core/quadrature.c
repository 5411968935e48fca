/* Nodes and weights of a hemisphere.
 *
 * Gauss-Legendre by Newton's method in theta, x = cos theta, with the recurrence in
 * differences and u = 1 - x, so that the nodes next to the edges keep full relative
 * accuracy. (GSL's table computes sizes that it has not stored to 1e-10 only, which shows
 * in the answers at 88 streams and not at 64.)
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/quadrature.h"

#include <math.h>

#include "core/vector.h"

enum { MOST = PPS_STREAMS_MAX / 4 }; /* nodes on one side of the middle */

/* P_n(cos theta) and sin(theta) times its derivative in theta, for many u = 1 - cos theta
 * at once. */
PPS_CLONES static void legendre_theta(int n, size_t n_nodes, const double *restrict u,
                                      double *restrict p, double *restrict slope) {
    double difference[MOST];
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

void pps_gauss_unit(int n, double *node, double *weight) {
    const double pi = 3.14159265358979323846;
    size_t half = (size_t)(n + 1) / 2;
    double theta[MOST], u[MOST], sine[MOST], p[MOST], slope[MOST];
    for (size_t i = 0; i < half; i++) {
        theta[i] = pi * ((double)i + 0.75) / (n + 0.5);
    }
    for (int step = 0;; step++) { /* quadratic from 1e-2 / n^2 on */
        for (size_t i = 0; i < half; i++) {
            double s = sin(theta[i] / 2), c = cos(theta[i] / 2);
            node[i] = s * s; /* (1 - x)/2 */
            node[(size_t)n - 1 - i] = (size_t)n - 1 - i == i ? 0.5 : c * c;
            sine[i] = 2 * s * c;
            u[i] = 2 * node[i];
        }
        legendre_theta(n, half, u, p, slope);
        if (step == 4) {
            break;
        }
        for (size_t i = 0; i < half; i++) {
            theta[i] -= p[i] * sine[i] / slope[i];
        }
    }
    for (size_t i = 0; i < half; i++) {
        double dp = slope[i] / sine[i];
        weight[i] = weight[(size_t)n - 1 - i] = 1 / (dp * dp);
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
