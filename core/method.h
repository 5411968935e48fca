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
    pps_status (*solve)(void *state, double thickness, double mu0);
    pps_status (*radiance)(void *state, const pps_grid *at, double *radiance);
    pps_status (*flux)(void *state, size_t n, const double *tau, pps_flux *flux);
    void (*query)(const void *state, pps_info *info); /* NULL: nothing to say */
    void (*clear)(void *state);                       /* NULL: no memory of its own */
};

#endif
