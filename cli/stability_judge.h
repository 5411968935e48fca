/* Is an answer right? Methods against a solution on other nodes with more streams.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_STABILITY_JUDGE_H
#define PPSCAT_CLI_STABILITY_JUDGE_H

#include <ppscat/ppscat.h>

typedef enum { OK, INACCURATE, NOT_FINITE, NEGATIVE, REFUSED, TOO_SLOW } verdict;

/* "ok", "inaccurate", ...; static storage. */
const char *verdict_text(verdict v);

enum { SAMPLE_DEPTHS = 3, SAMPLE_MUS = 6, SAMPLE_PHIS = 2 };
enum { SAMPLE_RADIANCES = SAMPLE_DEPTHS * SAMPLE_MUS * SAMPLE_PHIS };

/* What is compared: at the top, in the middle, at the bottom; 0, 1 and 5 deep in a
 * half-space. */
typedef struct {
    bool has_flux, has_radiance;
    double up, down,
        mean; /* fluxes up at the top, down at the bottom; mean intensity of
                              diffuse light in the middle */
    double radiance[SAMPLE_RADIANCES];
    const double *deviation; /* of the numbers in that order, standard; NULL: none */
} sample;

enum { SAMPLE_NUMBERS = 3 + SAMPLE_RADIANCES };

/* Solve and sample a model. */
pps_status sample_model(pps_model *model, const pps_method *method, double thickness,
                        double mu0, sample *out);

/* Sample by Monte Carlo with standard deviations, which go into `deviation`. */
pps_status sample_mc(const pps_slab *slab, double mu0, const pps_options *options,
                     double deviation[SAMPLE_NUMBERS], sample *out);

/* The trusted solutions of one (albedo, g); solvers are made when needed. All zero but
 * the slab to begin with. */
typedef struct {
    pps_dom *dom;
    double thickness; /* that it is made for; 0 before */
} trusted_solver;

typedef struct {
    pps_slab slab;
    trusted_solver flux[PPS_NODES_GRADED + 1], radiance[PPS_NODES_GRADED + 1];
} trusted;

/* The trusted sample of a case; without radiances unless asked for. */
pps_status trusted_sample(trusted *t, double thickness, double mu0, bool radiance,
                          sample *out);

void trusted_free(trusted *t);

/* What an answer is worth, and its error: the largest relative difference of what is
 * compared; NAN where there is no number to compare. Limits are of the method, with the
 * tolerance asked for. */
verdict judge_sample(const pps_method *method, double tolerance, const sample *got,
                     const sample *want, double *error);

/* Whether all of its numbers, or only the reflectance, are held against the trusted. */
bool judged_in_full(const pps_method *method);

#endif
