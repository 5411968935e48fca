/* The method "single": single scattering, exactly.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/method.h"
#include "spp/march.h"

static pps_status single_init(void *state, const pps_slab *slab,
                              const pps_options *opts) {
    (void)opts;
    ((pps_march *)state)->slab = *slab;
    return PPS_OK;
}

static pps_status single_solve(void *state, double thickness, double mu0) {
    pps_march *march = state;
    march->slab.thickness = thickness;
    march->mu0 = mu0;
    return PPS_OK;
}

static pps_status single_radiance(void *state, const pps_grid *at, double *radiance) {
    pps_march_radiance(state, at, radiance);
    return PPS_OK;
}

static pps_status single_flux(void *state, size_t n, const double *tau,
                              pps_flux *flux) {
    pps_march_flux(state, n, tau, flux);
    return PPS_OK;
}

static const pps_method_ops ops = {.state_size = sizeof(pps_march),
                                   .init = single_init,
                                   .solve = single_solve,
                                   .radiance = single_radiance,
                                   .flux = single_flux};

const pps_method pps_method_single = {
    .name = "single",
    .cost = "two exponentials a direction; fluxes by quadrature",
    .summary = "single scattering of the beam, exact phase function",
    .limits =
        "right to first order in albedo; dark wherever light scatters twice, so that "
        "all of the reflectance may be missing",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &ops,
};
