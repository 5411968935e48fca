/* cdisort on the cases of ppscat-bench.
 *
 * Everything is set as its manual has it for a beam on one layer. Its correction of single
 * scattering is Nakajima and Tanaka's, here as accurate as its default one and faster.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_cdisort.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#ifdef PPS_CDISORT
#include <cdisort.h>

struct bench_cdisort {
    disort_state state;
    disort_output out;
};

/* Moments that its correction takes: 0.5^l down to 1e-10. */
enum { MOMENTS = 34 };

static void set_flags(disort_flag *flag, bool radiances, bool at_nodes) {
    flag->ibcnd = GENERAL_BC;
    flag->usrtau = flag->lamber = flag->quiet = TRUE;
    flag->onlyfl = !radiances;
    flag->usrang = radiances && !at_nodes;
    flag->intensity_correction = flag->old_intensity_correction = flag->usrang;
    flag->brdf_type = BRDF_NONE;
}

bench_cdisort *bench_cdisort_create(int streams, const pps_grid *at) {
    bench_cdisort *c = calloc(1, sizeof *c);
    if (!c) {
        return NULL;
    }
    disort_state *ds = &c->state;
    bool radiances = at->n_mu > 0, at_nodes = !at->mu;
    set_flags(&ds->flag, radiances, at_nodes);
    ds->nstr = ds->nphase = streams;
    ds->nlyr = 1;
    ds->nmom = ds->flag.usrang && streams < MOMENTS ? MOMENTS : streams;
    ds->ntau = (int)at->n_tau;
    ds->numu = radiances ? (int)at->n_mu : 0;
    ds->nphi = radiances ? (int)at->n_phi : 0;
    ds->bc.fbeam = 1;
    c_disort_state_alloc(ds);
    c_disort_out_alloc(ds, &c->out);
    for (int j = 0; ds->flag.usrang && j < ds->numu; j++) { /* its mu > 0 goes up */
        ds->umu[j] = -at->mu[ds->numu - 1 - j];
    }
    if (radiances) {
        memcpy(ds->phi, at->phi, at->n_phi * sizeof *ds->phi);
    }
    return c;
}

void bench_cdisort_set(bench_cdisort *c, const pps_slab *slab, double mu0,
                       const double *tau) {
    disort_state *ds = &c->state;
    ds->dtauc[0] = slab->thickness;
    ds->ssalb[0] = slab->albedo;
    ds->bc.umu0 = mu0;
    double power = 1;
    for (int l = 0; l <= ds->nmom_nstr; l++) {
        ds->pmom[l] = power;
        power *= slab->g;
    }
    memcpy(ds->utau, tau, (size_t)ds->ntau * sizeof *tau);
}

void bench_cdisort_solve(void *c) {
    bench_cdisort *cdisort = c;
    c_disort(&cdisort->state, &cdisort->out);
}

double bench_cdisort_flux_up(const bench_cdisort *c) { return c->out.rad[0].flup; }

void bench_cdisort_free(bench_cdisort *c) {
    if (!c) {
        return;
    }
    c_disort_out_free(&c->state, &c->out);
    c_disort_state_free(&c->state);
    free(c);
}

#else /* the build was not given it */

bench_cdisort *bench_cdisort_create(int streams, const pps_grid *at) {
    (void)streams, (void)at;
    return NULL;
}
void bench_cdisort_set(bench_cdisort *c, const pps_slab *slab, double mu0,
                       const double *tau) {
    (void)c, (void)slab, (void)mu0, (void)tau;
}
void bench_cdisort_solve(void *c) { (void)c; }
double bench_cdisort_flux_up(const bench_cdisort *c) {
    (void)c;
    return 0;
}
void bench_cdisort_free(bench_cdisort *c) { (void)c; }
#endif
