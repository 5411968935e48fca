/* GSL's integrators behind one file.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/ode.h"

#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

static int slope_for_gsl(double x, const double *y, double *slope, void *context) {
    const pps_ode *ode = context;
    ode->slope(ode->context, x, y, slope);
    for (size_t i = 0; i < ode->n; i++) {
        if (!isfinite(slope[i])) {
            return GSL_EBADFUNC; /* ends the run */
        }
    }
    return GSL_SUCCESS;
}

pps_status pps_ode_run(const pps_ode *ode, double from, double to, double *y) {
    pps_ode copy = *ode; /* GSL wants its parameters writable */
    gsl_odeiv2_system system = {slope_for_gsl, NULL, ode->n, &copy};
    gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, ode->n);
    gsl_odeiv2_control *control =
        gsl_odeiv2_control_y_new(ode->absolute, ode->relative);
    gsl_odeiv2_evolve *evolve = gsl_odeiv2_evolve_alloc(ode->n);
    double x = from, h = fmin(ode->first_step, to - from);
    int rc = step && control && evolve ? GSL_SUCCESS : GSL_ENOMEM;
    pps_status status = rc ? PPS_ERR_MEMORY : PPS_OK;
    for (size_t taken = 0; !status && x < to; taken++) {
        rc = gsl_odeiv2_evolve_apply(evolve, control, step, &system, &x, to, &h, y);
        status = rc || taken >= ode->most_steps ? PPS_ERR_UNSUPPORTED : PPS_OK;
    }
    if (evolve) {
        gsl_odeiv2_evolve_free(evolve);
    }
    if (control) {
        gsl_odeiv2_control_free(control);
    }
    if (step) {
        gsl_odeiv2_step_free(step);
    }
    return status;
}
