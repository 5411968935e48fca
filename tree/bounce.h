/* One scattering of a path that carries all bands: which way it goes, and whether it lives.
 *
 * A path has a power q a band, relative to what it started with. Choices are made by the
 * sum over bands and paid back in the powers, so every band is right in the mean.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_BOUNCE_H
#define PPS_TREE_BOUNCE_H

#include <ppscat/tree/light.h>

#include "tree/rays.h"

/* Reflected (true) or transmitted, at random by u; q becomes that of the way chosen. The
 * sum of q over bands never grows. */
bool pps_bounce_choose(int n_bands, double *q, const double *reflectance,
                       const double *transmittance, double u);

/* Russian roulette after the given number of bounces: false where the path ends. */
bool pps_bounce_lives(int n_bands, double *q, uint64_t bounces, double u);

/* A direction by Lambert's law about side * normal. */
void pps_bounce_lambert(const double normal[3], double side, double u, double v,
                        double out[3]);

/* End a line at the ground; false if it does not meet it. */
bool pps_bounce_ground(const pps_scene *scene, pps_line *line);

/* How many scatterings the options allow. */
uint64_t pps_bounce_most(const pps_trace_options *options);

#endif
