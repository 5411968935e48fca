/* The boundary conditions of one azimuthal order: two small positive definite systems.
 *
 * Nothing diffuse falls in: G psi + phi = 0 at the top, G psi - phi = 0 at the bottom,
 * G = X^T X. Even and odd about the mid-plane that is
 *     Ae even = (R0 + Rw)/2,  Ao odd = (Rw - R0)/2,
 *     Ae = G + diag(k tanh k h),  Ao = G + diag(k coth k h),  h = w/2,
 * with R0 = -(G psi_p + phi_p)(0), Rw = -(G psi_p - phi_p)(w). In thick slabs even + odd
 * cancels to nothing; there the values at the edges come from
 *     bottom = [Ae^-1 Rw + Ao^-1 Rw + Ae^-1 Dd Ao^-1 R0]/2,  Dd = diag(2k / sinh k w),
 * and the top with R0 and Rw exchanged.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "solver/lapack.h"
#include "solver/order.h"

pps_status pps_order_set_thickness(pps_order *order, double thickness) {
    int n = order->n;
    size_t nn = (size_t)n * (size_t)n;
    memcpy(order->even, order->gram, nn * sizeof *order->even);
    memcpy(order->odd, order->gram, nn * sizeof *order->odd);
    for (int j = 0; j < n; j++) {
        double k = order->k[j];
        order->even[j + j * n] += isinf(thickness) ? k : pps_k_tanh(k, thickness / 2);
        order->odd[j + j * n] += isinf(thickness) ? k : pps_k_coth(k, thickness / 2);
    }
    bool definite = pps_cholesky(n, order->even) && pps_cholesky(n, order->odd);
    return definite ? PPS_OK : PPS_ERR_CONVERGENCE;
}

size_t pps_order_scratch(const pps_discrete *discrete) {
    return 12 * (size_t)discrete->n + (size_t)discrete->n_moments;
}

/* R0 and Rw side by side: edge[0..n) and edge[n..2n). values is 4 n of scratch. */
static void edge_residuals(const pps_order *order, double *edge, double *values) {
    int n = order->n;
    double *psi = values, *phi = values + 2 * n;
    for (int j = 0; j < n; j++) {
        double at_psi[2], at_phi[2];
        pps_mode_particular(&order->mode[j], at_psi, at_phi);
        for (int side = 0; side < 2; side++) {
            psi[j + side * n] = at_psi[side];
            phi[j + side * n] = at_phi[side];
        }
    }
    pps_multiply(false, n, 2, n, order->gram, n, psi, n, edge, n);
    for (int j = 0; j < n; j++) {
        edge[j] = -(edge[j] + phi[j]);
        edge[j + n] = -(edge[j + n] - phi[j + n]);
    }
}

/* From the residuals R0, Rw in a[0..n), a[n..2n) to the modes. */
static void close_modes(pps_order *order, double thickness, double *a, double *b,
                        double *cross) {
    int n = order->n;
    memcpy(b, a, 2 * (size_t)n * sizeof *a);
    pps_cholesky_solve(n, order->even, 2, a); /* Ae^-1 (R0, Rw) */
    pps_cholesky_solve(n, order->odd, 2, b);  /* Ao^-1 (R0, Rw) */
    for (int j = 0; j < n; j++) {
        double dd = pps_2k_csch(order->k[j], thickness);
        cross[j] = dd * b[j];
        cross[j + n] = dd * b[j + n];
    }
    pps_cholesky_solve(n, order->even, 2, cross); /* Ae^-1 Dd Ao^-1 (R0, Rw) */
    for (int j = 0; j < n; j++) {
        pps_mode_edges edges = {
            .even = (a[j] + a[j + n]) / 2,
            .odd = (b[j + n] - b[j]) / 2,
            .bottom = (a[j + n] + b[j + n] + cross[j]) / 2,
            .top = (a[j] + b[j] + cross[j + n]) / 2,
        };
        pps_mode_close(&order->mode[j], &edges);
    }
}

void pps_order_solve(pps_order *order, const pps_discrete *discrete, double thickness,
                     double mu0, double *scratch) {
    int n = order->n;
    double *a = scratch, *b = a + 2 * n, *cross = b + 2 * n, *values = cross + 2 * n;
    /* Beam: alpha = X^T a and beta = Z^T b are the projections at mu0. */
    double *ge = a, *go = a + n;
    pps_order_project(order, discrete, mu0, ge, go, values);
    double factor = (order->m == 0 ? 1 : 2) / 3.14159265358979323846;
    for (int j = 0; j < n; j++) {
        pps_mode_beam(&order->mode[j], order->k[j], thickness, 1 / mu0, factor * ge[j],
                      factor * go[j]);
    }
    edge_residuals(order, a, values);
    close_modes(order, thickness, a, b, cross);
}

void pps_order_solve_sky(pps_order *order, double thickness, double *scratch) {
    int n = order->n;
    double *a = scratch, *b = a + 2 * n, *cross = b + 2 * n;
    for (int j = 0; j < n; j++) {
        pps_mode_dark(&order->mode[j], order->k[j], thickness);
        /* s + d = 2 sqrt(w mu) at the top: G psi + phi = 2 X^T sqrt(w mu). */
        a[j] = 2 * order->flux_s[j];
        a[j + n] = 0;
    }
    close_modes(order, thickness, a, b, cross);
}
