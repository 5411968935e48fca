/* ppscat: plane-parallel scattering, exactly and in closed form.
 *
 * Conventions, once for the whole library:
 *   depth      optical depth tau, 0 on the lit side, `thickness` on the far side
 *   mu         cosine of the direction of travel; mu > 0 goes down, away from the lit
 *              side; mu < 0 comes back up
 *   phi        azimuth of travel in degrees, 0 = the beam's own
 *   phase      the phase function integrates to 1 over the sphere; its Legendre moments
 *              chi_l carry no factor 2l+1, so Henyey-Greenstein has chi_l = g^l
 *   beam       unit irradiance through a surface normal to the beam
 *   radiance   diffuse only, per steradian and unit beam; the beam exp(-tau/mu0) is a
 *              quantity of its own
 *
 * The library prints nothing, never exits and keeps no global state. Different handles
 * may be used from different threads at once. OpenBLAS threads are the program's
 * business: call openblas_set_num_threads(1) in main when you run threads yourself.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_PPSCAT_H
#define PPSCAT_PPSCAT_H

#include <ppscat/closed.h>
#include <ppscat/dom.h>
#include <ppscat/expdiff.h>
#include <ppscat/mc.h>
#include <ppscat/method.h>
#include <ppscat/phase.h>
#include <ppscat/slab.h>
#include <ppscat/spp.h>
#include <ppscat/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version, "major.minor.patch"; static storage. */
PPS_API const char *pps_version(void);

#ifdef __cplusplus
}
#endif
#endif
