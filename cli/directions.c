/* Angles in degrees, and the default directions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "directions.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double cos_degrees(double angle) {
    if (angle > 90)
        return -cos_degrees(180 - angle);
    if (angle == 60)
        return 0.5;
    return angle <= 45 ? cos(angle * pi / 180) : sin((90 - angle) * pi / 180);
}

/* P_n(x) by its recurrence, and its derivative. */
static double legendre(size_t n, double x, double *derivative) {
    double p = 1, before = 0;

    for (size_t l = 0; l < n; l++) {
        double k = (double)l, next = ((2 * k + 1) * x * p - k * before) / (k + 1);
        before = p;
        p = next;
    }
    *derivative = (double)n * (x * p - before) / (x * x - 1);
    return p;
}

/* Node i of n on (0, 1), the largest first, and its weight. */
static double gauss_node(size_t n, size_t i, double *weight) {
    double x = cos(pi * ((double)i + 0.75) / ((double)n + 0.5)), slope = 1;

    for (int step = 0; step < 10; step++) { /* converged in 5: the guess is close */
        double value = legendre(n, x, &slope);
        x -= value / slope;
    }
    legendre(n, x, &slope);
    *weight = 1 / ((1 - x) * (1 + x) * slope * slope); /* half of that on (-1, 1) */
    return (1 + x) / 2;
}

void gauss_sphere(size_t n, double *mu, double *weight) {
    for (size_t i = 0; i < n; i++) {
        double w, x = gauss_node(n, i, &w);
        mu[i] = -x;
        mu[2 * n - 1 - i] = x;
        if (weight)
            weight[i] = weight[2 * n - 1 - i] = w / 2;
    }
}

void even_azimuths(size_t n, double *phi, double *weight) {
    for (size_t i = 0; i < n; i++) {
        phi[i] = 180 * (double)i / (double)(n - 1);
        weight[i] = 1 / (double)(n - 1);
    }
    weight[0] /= 2; /* 0 and 180 have no mirror image */
    weight[n - 1] /= 2;
}
