/* Is an answer right? Each method is held to the accuracy that it states.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_STABILITY_JUDGE_H
#define PPSCAT_CLI_STABILITY_JUDGE_H

#include "stability_truth.h"

typedef enum { OK, INACCURATE, NOT_FINITE, NEGATIVE, REFUSED, TOO_SLOW } verdict;

/* "ok", "inaccurate", ...; static storage. */
const char *verdict_text(verdict v);

/* Which trusted solution a method is held against. */
truth_kind truth_for(const pps_method *method);

/* Whether all of its numbers, or only the reflectance, are held against that. */
bool judged_in_full(const pps_method *method);

/* What an answer is worth, and its error: the largest relative difference of what is
 * compared; NAN where there is no number to compare. Limits are of the method, with the
 * tolerance asked for. */
verdict judge_sample(const pps_method *method, double tolerance, const sample *got,
                     const sample *want, double *error);

#endif
