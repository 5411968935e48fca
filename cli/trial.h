/* One method at work on one case, and the processor time it takes.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TRIAL_H
#define PPSCAT_CLI_TRIAL_H

#include "grid.h"
#include "sweep.h"

/* A method's answer: all radiances where it has them, else the fluxes at all depths. */
typedef struct {
    const pps_method *method;
    const pps_options *options;
    const case_grid *grid; /* whose directions are asked for */
    const sweep_case *at;
    pps_model *model;
    double *radiance; /* [(k * n_mu + j) * n_phi + i] */
    pps_flux *flux;   /* one a depth */
} trial;

/* Seconds that need no second look, nor a look without the set-up. */
extern const double trial_long;

/* Make a model in place of the one before and get its answer. */
pps_status trial_begin(trial *t);

/* The answer under another beam. */
pps_status trial_evaluate(const trial *t, double mu0);

/* Diffuse flux up at depth 0 of the last answer; NAN where the method gives none. */
pps_status trial_reflected(const trial *t, double *up);

/* The least time of trial_begin, of a few where it is short. */
pps_status trial_time_begin(trial *t, double *seconds);

/* The least time of one trial_evaluate over batches long enough for the clock, under two
 * beams in turn; *n evaluations in all. */
pps_status trial_time_evaluate(const trial *t, double *seconds, size_t *n);

#endif
