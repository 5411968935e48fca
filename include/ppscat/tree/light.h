/* Leaf irradiance: what every light model and Monte Carlo answer.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_LIGHT_H
#define PPSCAT_TREE_LIGHT_H

#include <ppscat/tree/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Where the light of a leaf comes from; bits, to be added. */
typedef enum {
    PPS_SUN = 1,          /* straight from the sun */
    PPS_SUN_INDIRECT = 2, /* from the sun by way of leaves or ground */
    PPS_SKY = 4,          /* straight from the sky */
    PPS_SKY_INDIRECT = 8,
    PPS_ALL_LIGHT = 15
} pps_light_source;

/* Components of light by the names that the programs use: X(name, pps_light_source, added). */
#define PPS_LIGHT_COMPONENT_LIST(X)                                                    \
    X("all", PPS_ALL_LIGHT)                                                            \
    X("sun", PPS_SUN)                                                                  \
    X("indirect", PPS_SUN_INDIRECT)                                                    \
    X("sky", PPS_SKY)                                                                  \
    X("sky-indirect", PPS_SKY_INDIRECT)

/* Irradiance of both faces of every leaf, averaged over the leaf.
 * front[leaf * n_bands + band]; the arrays are the result's own. */
typedef struct pps_irradiance {
    size_t n_leaves;
    int n_bands;
    double *front, *back;
    double *front_error, *back_error; /* standard errors; NULL where there are none */
} pps_irradiance;

PPS_API pps_status pps_irradiance_create(const pps_scene *scene, bool errors,
                                         pps_irradiance **out);
PPS_API void pps_irradiance_free(pps_irradiance *irradiance); /* NULL is fine */

/* ---- the Monte Carlo reference ---- */

typedef struct pps_trace_options {
    uint64_t rays, seed; /* 0 rays: 1000000 */
    int bounces;         /* the most scatterings, by leaves or ground, before a ray is
                            absorbed where it arrives; 0: as many as it lives */
    int threads;         /* 0: all cores; never changes the answer */
    unsigned sources;    /* pps_light_source, added; 0: all. Without an indirect one
                            nothing is scattered */
    /* Called now and then, from the calling thread, with done and total; stops the work
     * by returning false. */
    bool (*progress)(void *user, uint64_t done, uint64_t total);
    void *user;
} pps_trace_options;

/* Where the launched power went, a band each. Power is irradiance times m^2:
 *     launched + chance = leaves + wood + ground + escaped   (to rounding, 1e-12)
 * `chance` is what roulette, and the choice of a way where bands differ, has added (or
 * taken, < 0): 0 in the mean. In an open scene light is launched at the ball about all that
 * is in it; over a ground also what comes from the ground around. */
typedef struct pps_energy {
    double launched[PPS_BANDS_MAX], leaves[PPS_BANDS_MAX], wood[PPS_BANDS_MAX],
        ground[PPS_BANDS_MAX], escaped[PPS_BANDS_MAX], chance[PPS_BANDS_MAX];
} pps_energy;

/* Light tracing with all bounces. Wood is black. A face that no ray has met has irradiance
 * 0, and as its standard error what one ray would bring. energy may be NULL. ARGUMENT: more
 * than 2^40 rays, an unknown source; CANCELLED when stopped. */
PPS_API pps_status pps_trace_light(const pps_scene *scene,
                                   const pps_trace_options *options,
                                   pps_irradiance **out, pps_energy *energy);

/* The second reference: from every leaf in `leaf` (numbers in the scene, n of them; NULL:
 * all) `samples` >= 1 paths a face go backwards. Options as above; `rays` does not count,
 * and progress is in leaves. Leaves that were not asked for are NaN; the errors of one
 * sample are infinite. */
PPS_API pps_status pps_gather_light(const pps_scene *scene, size_t n,
                                    const size_t *leaf, int samples,
                                    const pps_trace_options *options,
                                    pps_irradiance **out);

#ifdef __cplusplus
}
#endif
#endif
