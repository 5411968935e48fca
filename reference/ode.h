/* Ordinary differential equations by GSL's Runge-Kutta of order 8 (Prince and Dormand).
 *
 * A second door to GSL beside core/gsl.h: nothing but the Runge-Kutta references needs it.
 * GSL's error handler can fire here only when memory runs out inside GSL.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_REFERENCE_ODE_H
#define PPS_REFERENCE_ODE_H

#include <stddef.h>

#include <ppscat/status.h>

/* slope = dy/dx. */
typedef void (*pps_slope)(const void *context, double x, const double *y,
                          double *slope);

typedef struct pps_ode {
    size_t n;
    pps_slope slope;
    const void *context;
    double absolute, relative; /* error allowed a step, each component */
    double first_step;
    size_t most_steps;
} pps_ode;

/* Carry y from x = from to x = to >= from. UNSUPPORTED when that takes more steps than
 * allowed, or y leaves the range of numbers. */
pps_status pps_ode_run(const pps_ode *ode, double from, double to, double *y);

#endif
