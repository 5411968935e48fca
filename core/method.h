/* What stands behind a row of the table of methods.
 *
 * A method is one file: it defines `const pps_method pps_method_NAME` with these
 * functions, and methods/methods.def lists it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_METHOD_H
#define PPS_CORE_METHOD_H

#include <ppscat/method.h>

/* Arguments are checked before these are called: slab, options, thickness, mu0, depths
 * and directions are in range, and `solve` precedes `radiance` and `flux`. */
struct pps_method_ops {
    size_t state_size; /* zeroed memory handed to init */
    pps_status (*init)(void *state, const pps_slab *slab, const pps_options *opts);
    /* Light the slab with a beam of 1 along mu0, black below. */
    pps_status (*solve)(void *state, double thickness, double mu0);
    /* The same for n beams at once, which outputs then have one after the other; mu0 stays
     * valid. NULL, or UNSUPPORTED: one at a time, by `solve`. */
    pps_status (*solve_beams)(void *state, double thickness, size_t n,
                              const double *mu0);
    void (*query_beam)(const void *state, size_t b, pps_info *info); /* then, of one */
    /* Light it with an isotropic radiance of 1 from above instead, black below. The
     * outputs then include the uncollided sky light; flux.direct is 0 and flux.mean is
     * flux.mean_diffuse. NULL: the method has no sky, and so no ground either (which
     * methods/model.c adds by superposition of these two). */
    pps_status (*solve_sky)(void *state, double thickness);
    /* The method takes beam, sky and ground from the options itself: solve means all of
     * them, solve_sky is NULL. */
    bool own_light;
    pps_status (*radiance)(void *state, const pps_grid *at, double *radiance);
    pps_status (*flux)(void *state, size_t n, const double *tau, pps_flux *flux);
    void (*query)(const void *state, pps_info *info); /* NULL: nothing to say */
    void (*clear)(void *state);                       /* NULL: no memory of its own */
};

#endif
