/* Associated Legendre functions by upward recurrence in l, which is stable on [-1, 1].
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/legendre.h"

#include <math.h>

void pps_legendre(int m, int n_moments, double mu, double *p) {
    /* P_m^m = sqrt((2m-1)!! / (2m)!!) (1 - mu^2)^(m/2) */
    double sine2 = (1 - mu) * (1 + mu), top = 1;
    for (int i = 1; i <= m; i++) {
        top *= sqrt(sine2 * (2 * i - 1) / (2 * i));
    }
    p[0] = top;
    double before = 0, here = top, norm = 0; /* norm = sqrt(l^2 - m^2) at l */
    for (int l = m; l + 1 < n_moments; l++) {
        double next_norm = sqrt((double)(l + 1 - m) * (l + 1 + m));
        double next = ((2 * l + 1) * mu * here - norm * before) / next_norm;
        before = here;
        here = next;
        norm = next_norm;
        p[l + 1 - m] = here;
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
