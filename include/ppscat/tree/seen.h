/* How far two answers differ to someone who looks at the plants.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_SEEN_H
#define PPSCAT_TREE_SEEN_H

#include <ppscat/tree/light.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of the leaf radiances that a far viewer sees, pixel by pixel, over all bands. */
typedef struct pps_seen_difference {
    double over_top; /* mean |difference| over the 99.9th percentile of the truth: what
                         B calls the average error (its Figure 7) */
    double relative; /* mean |difference| over the mean of the truth */
    double ratio;    /* mean over mean of the truth */
    size_t n_pixels; /* that show a leaf */
} pps_seen_difference;

/* The viewer stands in the unit direction `to`, infinitely far; pixels x pixels lines over
 * the whole scene (of one cell, if it repeats). A face sends out (R E + T' E')/pi. MEMORY;
 * ARGUMENT: results of another scene; UNSUPPORTED: no leaf is seen, or all are dark. */
PPS_API pps_status pps_seen_compare(const pps_scene *scene, const pps_irradiance *truth,
                                    const pps_irradiance *light, const double to[3],
                                    int pixels, pps_seen_difference *out);

/* The radiance that a face sends out (0 front, 1 back), by its own and the other's
 * irradiance. */
PPS_API double pps_leaf_radiance(const pps_scene *scene, const pps_irradiance *light,
                                 size_t leaf, int face, int band);

#ifdef __cplusplus
}
#endif
#endif
