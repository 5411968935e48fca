/* What `stability` compares: the numbers taken from an answer, and trusted ones.
 *
 * No method is held against itself or its relatives: `adding`, which shares with `exact`
 * and the closed forms the phase function only, judges all of them, and discrete ordinates
 * with many streams judge `adding`. The Runge-Kutta methods promise the solution on their
 * own nodes, which discrete ordinates give as well, by eigenvectors.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_STABILITY_TRUTH_H
#define PPSCAT_CLI_STABILITY_TRUTH_H

#include <ppscat/ppscat.h>

enum { SAMPLE_DEPTHS = 3, SAMPLE_MUS = 6, SAMPLE_PHIS = 2 };
enum { SAMPLE_RADIANCES = SAMPLE_DEPTHS * SAMPLE_MUS * SAMPLE_PHIS };
enum { SAMPLE_NUMBERS = 3 + SAMPLE_RADIANCES };

/* What is compared: at the top, in the middle, at the bottom; 0, 1 and 5 deep in a
 * half-space. */
typedef struct {
    bool has_flux, has_radiance;
    double up, down, mean; /* diffuse: flux up at the top and down at the bottom, mean
                              intensity in the middle */
    double radiance[SAMPLE_RADIANCES];
    double accuracy;         /* relative, of a trusted sample */
    const double *deviation; /* of the numbers in that order, standard; NULL: none */
} sample;

/* Solve and sample a model; fluxes and radiances where the method has them. */
pps_status sample_model(pps_model *model, const pps_method *method, double thickness,
                        double mu0, sample *out);

/* Sample by Monte Carlo with standard deviations, which go into `deviation`; INFINITY
 * where they are unknown. */
pps_status sample_mc(const pps_slab *slab, double mu0, const pps_options *options,
                     double deviation[SAMPLE_NUMBERS], sample *out);

typedef enum {
    BY_ADDING,    /* as sharp as it can; many streams where it refuses (|g| >= 0.99) */
    BY_STREAMS,   /* discrete ordinates, 192 to 384 streams */
    ON_OWN_NODES, /* discrete ordinates on the plain Gauss nodes of `rk` */
    N_TRUTHS
} truth_kind;

/* The trusted solutions of one (albedo, g); solvers are made when needed. */
typedef struct truths truths;

/* `options` are those of the judged: streams and tolerance. They and the methods must
 * outlive it. NULL without memory. */
truths *truths_new(const pps_slab *slab, const pps_options *options);

/* The trusted sample of a case; without radiances unless asked for. */
pps_status truths_sample(truths *t, truth_kind kind, double thickness, double mu0,
                         bool radiance, sample *out);

void truths_free(truths *t);

#endif
