/* The per-leaf model: light on a leaf from eight numbers of its own.
 *
 * Around every leaf the sphere is cut into octants; att[j] is how much light comes through
 * the other leaves of octant j, whose middle is omega_j = (+-1, +-1, +-1)/sqrt(3): bit 0
 * of j is the sign of x (set: positive), bit 1 of y, bit 2 of z, so omega_(7-j) is
 * -omega_j. Everything else is a closed form of these: sun and sky may move, and leaves
 * turn, without touching them.
 *
 * Reference: Boulanger, Bouatouch & Pattanaik 2008 (B). Their tau, s_max, rho and A are
 * not needed: they meet only as tau s_max = -ln att and A rho = 2 tau, and tau cancels.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_LEAF_LIGHT_H
#define PPSCAT_TREE_LEAF_LIGHT_H

#include <ppscat/tree/light.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PPS_OCTANTS = 8 };

/* omega_j */
PPS_API void pps_octant_direction(int j, double out[3]);

typedef struct pps_attenuation_options {
    /* A group of leaves counts as one where its radius is less than this share of its
     * distance; 0: 0.6. Negative: every leaf by itself. */
    double opening;
    int threads; /* 0: all cores; never changes the answer */
    bool apart;  /* plants do not shade one another (as in B section 7): what each would
                    have alone, found once for all of a prototype and yaw */
} pps_attenuation_options;

/* att[8 * leaf + j] of every leaf of the scene, by the product of what each other leaf
 * lets through (B section 6): 1 - min(A |n.w|/(r^2 pi/2), 0.98) for a leaf of area A at
 * distance r along w; an octant is pi/2 of the sphere. Wood does not count. The work
 * grows as n log n. Against every leaf by itself the default is within .005 (rms).
 * NULL options: defaults. */
PPS_API pps_status pps_leaf_attenuation(const pps_scene *scene,
                                        const pps_attenuation_options *options,
                                        float *att);

/* The same in an array of its own, att[PPS_OCTANTS * n_leaves], which is the caller's: to
 * be given to free(). Where it fails *out is NULL: ARGUMENT (no leaves, a negative number
 * of threads, an opening of 1 or more), MEMORY. */
PPS_API pps_status pps_leaf_attenuation_create(const pps_scene *scene,
                                               const pps_attenuation_options *options,
                                               float **out);

/* The same by rays, for comparison: the share of each octant that `samples` lines (0: 64)
 * from random points of the leaf find free of leaves and wood. */
PPS_API pps_status pps_leaf_visibility(const pps_scene *scene, int samples,
                                       uint64_t seed, int threads, float *att);

/* How the sun's attenuation is put together from the octants it shines through. */
typedef enum {
    PPS_SUN_PRINTED, /* B-Eq. 7: the mean of the depths, in an exponential: low, for the
                        mean of exponentials is more than the exponential of the mean */
    PPS_SUN_UNBIASED /* the attenuations interpolated to the sun's direction: their mean */
} pps_sun_mean;

/* Irradiance of both faces of every leaf from its own attenuations: the sky (B-Eq. 6,
 * averaged over each octant), the sun (B-Eqs. 7, 8), and the sun by way of one leaf
 * (B-Eqs. 11, 23-25). sources: PPS_SUN, PPS_SUN_INDIRECT, PPS_SKY, added. With a ground
 * the lower octants see it lit by the open sky. Leaf normals are those of the scene. */
PPS_API pps_status pps_leaf_light(const pps_scene *scene, const float *att,
                                  pps_sun_mean mean, unsigned sources,
                                  pps_irradiance *out);

#ifdef __cplusplus
}
#endif
#endif
