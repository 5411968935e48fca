/* Associated Legendre functions by upward recurrence in l, which is stable on [-1, 1].
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/legendre.h"

#include <math.h>

#include "core/vector.h"

void pps_legendre(int m, int n_moments, double mu, double *p) {
    pps_legendre_array(m, n_moments, 1, &mu, 1, p);
}

/* P_m^m = sqrt((2m-1)!! / (2m)!!) (1 - mu^2)^(m/2) */
static inline void first_row(int m, size_t n, const double *restrict mu,
                             double *restrict p) {
    for (size_t i = 0; i < n; i++) {
        p[i] = 1;
    }
    for (int j = 1; j <= m; j++) {
        for (size_t i = 0; i < n; i++) {
            double sine2 = (1 - mu[i]) * (1 + mu[i]);
            p[i] *= sqrt(sine2 * (2 * j - 1) / (2 * j));
        }
    }
}

PPS_CLONES void pps_legendre_array(int m, int n_moments, size_t n, const double *mu,
                                   size_t stride, double *p) {
    first_row(m, n, mu, p);
    double norm = 0; /* sqrt(l^2 - m^2) at l */
    for (int l = m; l + 1 < n_moments; l++) {
        double next_norm = sqrt((double)(l + 1 - m) * (l + 1 + m));
        double two = (2 * l + 1) / next_norm, back = norm / next_norm;
        const double *restrict here = p + (size_t)(l - m) * stride;
        const double *restrict before = l > m ? here - stride : here; /* back = 0 */
        double *restrict next = p + (size_t)(l - m + 1) * stride;
        for (size_t i = 0; i < n; i++) {
            next[i] = two * mu[i] * here[i] - back * before[i];
        }
        norm = next_norm;
    }
}

double pps_legendre_product(int n_moments, const double *coefficient, double x,
                            double y) {
    double sum = 0, px[2] = {0, 1}, py[2] = {0, 1}; /* P_(l-1), P_l */
    for (int l = 0; l < n_moments; l++) {
        sum += coefficient[l] * px[1] * py[1];
        double next_x = ((2 * l + 1) * x * px[1] - l * px[0]) / (l + 1);
        double next_y = ((2 * l + 1) * y * py[1] - l * py[0]) / (l + 1);
        px[0] = px[1];
        px[1] = next_x;
        py[0] = py[1];
        py[1] = next_y;
    }
    return sum;
}
