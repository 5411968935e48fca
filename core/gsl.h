/* The one door to GSL: elliptic integrals.
 *
 * GSL's default error handler aborts the process; everything here validates first or
 * uses the calls that return a status without the handler, so it cannot fire.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_GSL_H
#define PPS_CORE_GSL_H

/* Carlson's R_F(0, 1, y) and R_J(0, 1, y, p) for y > 0, p > 0. */
double pps_carlson_f(double y);
double pps_carlson_j(double y, double p);

#endif
