/* Beam, sky and ground together, by superposition of black-ground solutions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_METHODS_LIGHT_H
#define PPS_METHODS_LIGHT_H

#include "core/method.h"

/* A method's state and the light on its slab. */
typedef struct pps_lit {
    const pps_method_ops *ops;
    void *state;
    pps_light light;
    double thickness, mu0;
} pps_lit;

/* As the outputs of a model. They leave the state solved for one of its parts. */
pps_status pps_lit_radiance(const pps_lit *lit, const pps_grid *at, double *radiance);
pps_status pps_lit_flux(const pps_lit *lit, size_t n, const double *tau,
                        pps_flux *flux);

#endif
