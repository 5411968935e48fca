/* GSL behind one file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/gsl.h"

#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_ellint.h>

double pps_carlson_f(double y) {
    gsl_sf_result r;
    return gsl_sf_ellint_RF_e(0, 1, y, GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}

double pps_carlson_j(double y, double p) {
    gsl_sf_result r;
    return gsl_sf_ellint_RJ_e(0, 1, y, p, GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}
