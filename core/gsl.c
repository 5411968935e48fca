/* GSL behind one file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/gsl.h"

#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_sf_ellint.h>

double pps_elliptic_e(double complement) {
    if (complement < 1e-10) { /* next term: complement^2; GSL refuses m = 1 */
        return complement > 0 ? 1 + complement / 2 * (log(4 / sqrt(complement)) - 0.5)
                              : 1;
    }
    gsl_sf_result r;
    return gsl_sf_ellint_Ecomp_e(sqrt(1 - complement), GSL_PREC_DOUBLE, &r)
               ? (double)NAN
               : r.val;
}

double pps_carlson_f(double y) {
    gsl_sf_result r;
    return gsl_sf_ellint_RF_e(0, 1, y, GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}

double pps_carlson_j(double y, double p) {
    gsl_sf_result r;
    return gsl_sf_ellint_RJ_e(0, 1, y, p, GSL_PREC_DOUBLE, &r) ? (double)NAN : r.val;
}
