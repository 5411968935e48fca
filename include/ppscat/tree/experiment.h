/* How well light models light a crown: Experiment 2 of the SPP paper (Table 3), and what
 * goes beyond it.
 *
 * The irradiance of leaves, both faces together, is averaged by area over categories of
 * depth and thickness, floor(d/bin) and floor(w/bin) with the mean counts d = n+,
 * w = n+ + n- of the leaf's cell (SPP Eqs. 29, 30), and compared with the same averages of
 * a Monte Carlo answer. Absolute, nothing fitted.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_EXPERIMENT_H
#define PPSCAT_TREE_EXPERIMENT_H

#include <ppscat/tree/field.h>
#include <ppscat/tree/grow.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A light model with options, under a name: "SPPG" is spp-printed with its G-factor. Or
 * Monte Carlo by `rays` light rays, with model NULL. */
typedef struct pps_contender {
    const char *label;
    const pps_light_model *model;
    pps_light_options options;
    uint64_t rays;
} pps_contender;

/* Every contender of Table 3 and beyond it, in the order shown; *n of them. */
PPS_API const pps_contender *pps_contender_table(size_t *n);

/* Monte Carlo as a contender: 18K rays, the paper's 184K, and 1.8M. */
PPS_API const pps_contender *pps_contender_paths(size_t *n);

/* Errors are fractions of the reference. Level 0 has the categories of at least 20
 * triangles (the paper's meshes), level 1 those of at least 100. */
enum { PPS_SCORE_LEVELS = 2 };
typedef struct pps_score {
    double category[PPS_SCORE_LEVELS]; /* Eq. 30: every category weighs the same */
    double by_count[PPS_SCORE_LEVELS]; /* every triangle weighs the same */
    double faces[PPS_SCORE_LEVELS];    /* by count, the face turned to the light and the
                                          one turned away each for itself */
    int categories[PPS_SCORE_LEVELS];
    double leaves;     /* every leaf for itself, by area: root mean square, both faces
                          together, less what the reference's own noise adds to it */
    double brightness; /* mean irradiance over the reference's */
    /* Processor time, from no answer, without what is made once a scene: for each cell
     * with leaves, of the cells (or of the leaves, by a model without cells); and for each
     * leaf, all that lights it. */
    double seconds_per_cell, seconds_per_leaf;
} pps_score;

/* Score every contender in every band against `reference`, a Monte Carlo answer to the
 * scene, with its standard errors: score[i * n_bands + b]. bin 0: 0.5. `seed` is that of
 * Monte Carlo contenders, and must not be the reference's. ARGUMENT: see
 * pps_light_model_run; a reference of another scene or without standard errors. */
PPS_API pps_status pps_score_models(const pps_scene *scene, const pps_cells *cells,
                                    const pps_irradiance *reference, double bin,
                                    size_t n, const pps_contender *contender,
                                    uint64_t seed, pps_score *score);

/* A crown under a sun or a sky. */
typedef struct pps_experiment {
    pps_crown crown;
    double period; /* crown radii along x and y; 0: it stands alone */
    double zenith; /* of the sun, degrees, towards +x */
    bool sky;      /* lit by a sky, horizon .5 and zenith 1, instead of the sun */
    int n_bands;
    double albedo[PPS_BANDS_MAX];
    int across, samples; /* of the cells; 0: their defaults */
    double bin;          /* 0: 0.5 */
    uint64_t rays;       /* Monte Carlo; 0: 2000000 */
    uint64_t seed;       /* of rays and of points on leaves */
    int threads;
} pps_experiment;

/* Grow, light by Monte Carlo and by every contender, and score: as pps_score_models. */
PPS_API pps_status pps_experiment_run(const pps_experiment *experiment, size_t n,
                                      const pps_contender *contender, pps_score *score);

#ifdef __cplusplus
}
#endif
#endif
