/* A model: a method at work on one (albedo, g). Checks arguments, then hands over.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include "core/method.h"

struct pps_model {
    const pps_method *method;
    double thickness;
    bool solved;
    void *state;
};

static bool options_valid(const pps_options *o) {
    bool streams = o->streams == 0 || (o->streams >= 2 && o->streams % 2 == 0 &&
                                       o->streams <= PPS_STREAMS_MAX);
    bool clash = o->delta_m == PPS_DELTA_M_OFF && o->nodes > PPS_NODES_GAUSS;
    return streams && !clash && o->nodes >= PPS_NODES_AUTO &&
           o->nodes <= PPS_NODES_GRADED && o->delta_m >= PPS_DELTA_M_AUTO &&
           o->delta_m <= PPS_DELTA_M_OFF && o->tolerance >= 0 && o->tolerance < 1;
}

pps_status pps_model_create(const pps_method *method, const pps_slab *slab,
                            const pps_options *opts, pps_model **out) {
    pps_options o = opts ? *opts : (pps_options){0};
    *out = NULL;
    if (!method || pps_slab_check(slab) || !options_valid(&o)) {
        return PPS_ERR_ARGUMENT;
    }
    if (o.tolerance == 0) {
        o.tolerance = 1e-6;
    }
    pps_model *model = calloc(1, sizeof *model);
    void *state = calloc(1, method->ops->state_size);
    if (!model || !state) {
        free(model);
        free(state);
        return PPS_ERR_MEMORY;
    }
    *model = (pps_model){.method = method, .state = state};
    pps_status status = method->ops->init(state, slab, &o);
    if (status) {
        pps_model_free(model);
        return status;
    }
    *out = model;
    return PPS_OK;
}

pps_status pps_model_solve(pps_model *model, double thickness, double mu0) {
    model->solved = false;
    if (!(thickness > 0) || pps_mu0_check(mu0)) {
        return PPS_ERR_ARGUMENT;
    }
    if (isinf(thickness) && !model->method->half_space) {
        return PPS_ERR_UNSUPPORTED;
    }
    pps_status status = model->method->ops->solve(model->state, thickness, mu0);
    model->thickness = thickness;
    model->solved = status == PPS_OK;
    return status;
}

pps_status pps_model_radiance(pps_model *model, const pps_grid *at, double *radiance) {
    if (!model->solved || !radiance || pps_grid_check(at, model->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    if (!model->method->fields) {
        return PPS_ERR_UNSUPPORTED;
    }
    return model->method->ops->radiance(model->state, at, radiance);
}

pps_status pps_model_flux(pps_model *model, size_t n, const double *tau,
                          pps_flux *flux) {
    if (!model->solved || !flux || pps_tau_check(n, tau, model->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    if (!model->method->fluxes) {
        return PPS_ERR_UNSUPPORTED;
    }
    return model->method->ops->flux(model->state, n, tau, flux);
}

void pps_model_query(const pps_model *model, pps_info *info) {
    *info = (pps_info){.error_estimate = (double)NAN};
    if (model->method->ops->query) {
        model->method->ops->query(model->state, info);
    }
}

void pps_model_free(pps_model *model) {
    if (!model) {
        return;
    }
    if (model->method->ops->clear) {
        model->method->ops->clear(model->state);
    }
    free(model->state);
    free(model);
}
