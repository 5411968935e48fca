/* Divided differences of exponentials, without cancellation.
 *
 * Rates close together: Taylor series about the smallest, whose terms alternate but stay
 * below e^2 of the sum. Rates apart: the recurrence, in which the two terms differ by a
 * factor. Reference: SPP Eq. A.1; docs/theory.md section 5.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/expdiff.h>

#include <math.h>
#include <stdbool.h>

/* Below this spread (in units of 1/t) the series is used. */
static const double SERIES_SPREAD = 1.0;
enum { SERIES_TERMS = 20 }; /* 1 / 20! < 1e-18 */

/* (1 - e^(-z)) / z for z >= 0. */
static double decay_mean(double z) { return z > 0 ? -expm1(-z) / z : 1.0; }

double pps_exp1(double t, double a, double b) {
    double low = fmin(a, b);
    if (isinf(t)) {
        return low > 0 ? 0 : 1 / fmax(a, b);
    }
    return t * exp(-low * t) * decay_mean(fabs(b - a) * t);
}

double pps_exp1_known(double t, double k, double c, double ekt, double ect) {
    if (isinf(t)) {
        return pps_exp1(t, k, c);
    }
    double z = (c - k) * t;
    if (fabs(z) > 1) {
        return (ekt - ect) / (c - k); /* the two differ by a factor e at least */
    }
    return z >= 0 ? t * ekt * decay_mean(z) : t * ect * decay_mean(-z);
}

static void sort2(double *a, double *b) {
    if (*b < *a) {
        double swap = *a;
        *a = *b;
        *b = swap;
    }
}

/* t^n sum_m (-1)^m h_m(x) / (n + m)!, h_m the complete homogeneous polynomials of the
 * n scaled distances x_i = (rate_i - rate_0) t, 0 <= x_i <= SERIES_SPREAD. */
static double series(int n, const double x[]) {
    double h[3] = {1, 1, 1}; /* h_m of the first 1, 2, 3 distances */
    double factorial = 1;
    for (int i = 2; i <= n; i++) {
        factorial *= i;
    }
    double sum = 1 / factorial, sign = 1;
    for (int m = 1; m < SERIES_TERMS; m++) {
        h[0] *= x[0];
        for (int i = 1; i < n; i++) {
            h[i] = h[i - 1] + x[i] * h[i];
        }
        factorial *= n + m;
        sign = -sign;
        sum += sign * h[n - 1] / factorial;
    }
    return sum;
}

double pps_exp2(double t, double a, double b, double c) {
    sort2(&a, &b);
    sort2(&b, &c);
    sort2(&a, &b);
    if (isinf(t)) {
        return a > 0 ? 0 : 1 / (b * c);
    }
    double x = (b - a) * t, y = (c - a) * t, scale = t * t * exp(-a * t);
    if (!(scale > 0)) {
        return 0; /* t = 0, or all has decayed */
    }
    if (y < SERIES_SPREAD) {
        return scale * series(2, (double[]){x, y});
    }
    return scale * (decay_mean(x) - exp(-x) * decay_mean(y - x)) / y;
}

double pps_exp3(double t, double a, double b, double c, double d) {
    sort2(&a, &b);
    sort2(&c, &d);
    sort2(&a, &c);
    sort2(&b, &d);
    sort2(&b, &c);
    if (isinf(t)) {
        return a > 0 ? 0 : 1 / (b * c * d);
    }
    double x[3] = {(b - a) * t, (c - a) * t, (d - a) * t};
    if (x[2] < SERIES_SPREAD) {
        return t * t * t * exp(-a * t) * series(3, x);
    }
    return (pps_exp2(t, a, b, c) - pps_exp2(t, b, c, d)) / (d - a);
}
