/* GSL behind one file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/gsl.h"

#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_ellint.h>

pps_status pps_gauss_unit(int n, double *node, double *weight) {
    gsl_integration_glfixed_table *table =
        gsl_integration_glfixed_table_alloc((size_t)n);
    if (!table) {
        return PPS_ERR_MEMORY;
    }
    for (int i = 0; i < n; i++) {
        gsl_integration_glfixed_point(0, 1, (size_t)i, &node[i], &weight[i], table);
    }
    gsl_integration_glfixed_table_free(table);
    return PPS_OK;
}

double pps_elliptic_e(double m) {
    gsl_sf_result r;
    return gsl_sf_ellint_Ecomp_e(sqrt(m), GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}

double pps_carlson_f(double y) {
    gsl_sf_result r;
    return gsl_sf_ellint_RF_e(0, 1, y, GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}

double pps_carlson_j(double y, double p) {
    gsl_sf_result r;
    return gsl_sf_ellint_RJ_e(0, 1, y, p, GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}
