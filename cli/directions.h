/* Angles in degrees, and the default directions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_DIRECTIONS_H
#define PPSCAT_CLI_DIRECTIONS_H

#include <stddef.h>

/* cos of an angle of 0 to 180 degrees; exact at 0, 60, 90, 120 and 180. */
double cos_degrees(double angle);

/* The n Gauss-Legendre nodes of each hemisphere as cosines, 2n in ascending order, and
 * their weights, which sum to 1 (weight may be NULL). */
void gauss_sphere(size_t n, double *mu, double *weight);

/* n even azimuths 0..180 degrees, n > 1, and their weights, which sum to 1: by the
 * symmetry about the beam's plane the mean over the whole circle. */
void even_azimuths(size_t n, double *phi, double *weight);

#endif
