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

/* P_n(cos theta) and its derivative in theta. */
static double legendre_theta(int n, double theta, double *derivative) {
    double u = 2 * sin(theta / 2) * sin(theta / 2), p = 1, difference = 0;
    for (int l = 0; l < n; l++) {
        /* (l + 1) (P_(l+1) - P_l) = l (P_l - P_(l-1)) - (2l + 1) u P_l */
        difference = (l * difference - (2 * l + 1) * u * p) / (l + 1);
        p += difference;
    }
    *derivative = n * (difference - u * p) / sin(theta);
    return p;
}

void pps_gauss_unit(int n, double *node, double *weight) {
    const double pi = 3.14159265358979323846;
    for (int i = 0; i < (n + 1) / 2; i++) {
        double theta = pi * (i + 0.75) / (n + 0.5), slope;
        for (int step = 0; step < 5; step++) { /* quadratic from 1e-2 / n^2 on */
            double p = legendre_theta(n, theta, &slope);
            theta -= p / slope;
        }
        legendre_theta(n, theta, &slope);
        int mirror = n - 1 - i;
        node[i] = sin(theta / 2) * sin(theta / 2); /* (1 - x)/2 */
        node[mirror] = mirror == i ? 0.5 : cos(theta / 2) * cos(theta / 2);
        weight[i] = weight[mirror] = 1 / (slope * slope);
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
