/* cdisort (C. Emde, T. Dowling and others) behind four functions, to be timed beside
 * ppscat: only where the build was given its source (CMake variable PPSCAT_CDISORT).
 *
 * Slabs of one layer, Henyey-Greenstein, delta-M, every azimuthal order that is not zero.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_BENCH_CDISORT_H
#define PPS_BENCH_CDISORT_H

#include <ppscat/ppscat.h>

typedef struct bench_cdisort bench_cdisort;

/* Memory for cases of this shape; NULL where there is no cdisort. at: how many depths, and the directions; n_mu = 0 means
 * fluxes alone, mu = NULL radiances at cdisort's own nodes, uncorrected (cheaper for it). */
bench_cdisort *bench_cdisort_create(int streams, const pps_grid *at);

/* The case: depths as many as in `at`. */
void bench_cdisort_set(bench_cdisort *c, const pps_slab *slab, double mu0,
                       const double *tau);

/* Solve it, results in cdisort's memory; what goes up at the top. */
void bench_cdisort_solve(void *c);
double bench_cdisort_flux_up(const bench_cdisort *c);

void bench_cdisort_free(bench_cdisort *c);

#endif
