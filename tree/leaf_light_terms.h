/* The closed forms of the per-leaf model, one by one.
 *
 * alpha is the angle between omega_j and the direction to the sun; att and ln att as in
 * leaf_light.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_LEAF_LIGHT_TERMS_H
#define PPS_TREE_LEAF_LIGHT_TERMS_H

#include <ppscat/tree/leaf_light.h>

/* Means over all leaf normals N of max(0, N.a) max(0, N.b) with a, b at the angle alpha:
 * light that goes through (B-Eq. 31), and of light that is thrown back (B-Eq. 32). */
double pps_leaf_through_mean(double alpha);
double pps_leaf_back_mean(double alpha);

/* What depends on the sun's direction alone. */
typedef struct pps_leaf_sun {
    double weight[PPS_OCTANTS]; /* M(omega_l.omega_j) over their sum: B-Eq. 7 */
    double turn[PPS_OCTANTS];   /* sum_j' weight_j' (omega_j.omega_j'): 1 - G3/tau */
    double alpha[PPS_OCTANTS];
    double mean[PPS_OCTANTS]; /* of the unbiased mean; sum 1, some negative */
} pps_leaf_sun;
void pps_leaf_sun_init(pps_leaf_sun *sun, const double to[3]);

/* The octants of one leaf; `depth` is tau s_max, finite even where nothing comes through. */
typedef struct pps_leaf_octants {
    double att[PPS_OCTANTS], depth[PPS_OCTANTS];
} pps_leaf_octants;
void pps_leaf_octants_init(pps_leaf_octants *octants, const float *att);

/* The sun's light that reaches the leaf: e^(-tau s_max(omega_l)), or the unbiased mean
 * sum_j mean_j att_j, held between 0 and 1. */
double pps_leaf_sun_through(const pps_leaf_sun *sun, const pps_leaf_octants *octants,
                            pps_sun_mean mean);

/* tau times the integral of B-Eq. 20 with E_sun = 1, of every octant: sunlight on its
 * leaves, seen through those in front. */
void pps_leaf_sun_depths(const pps_leaf_sun *sun, const pps_leaf_octants *octants,
                         pps_sun_mean mean, double out[PPS_OCTANTS]);

/* A G1(j)/tau (B-Eq. 18): what leaves of these optics send on; A rho = 2 tau. */
double pps_leaf_turned(const pps_leaf_optics *optics, int band, double alpha);

#endif
