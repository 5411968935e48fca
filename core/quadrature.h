/* Nodes and weights of a hemisphere.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_QUADRATURE_H
#define PPS_CORE_QUADRATURE_H

#include <ppscat/dom.h>

/* Gauss-Legendre nodes (ascending) and weights on (0, 1), n >= 1, to full relative
 * accuracy each. */
void pps_gauss_unit(int n, double *node, double *weight);

/* n nodes (ascending) and weights on (0, 1), weights summing to 1. Of Gauss-Legendre x:
 * GAUSS: mu = x; MAPPED: mu = x^2, weights 2 x w_x, which resolves the mu log mu behaviour
 * at grazing angles; GRADED: mu = x^4, which resolves mu ~ thickness in thin slabs. */
void pps_hemisphere_nodes(pps_nodes kind, int n, double *mu, double *weight);

#endif
