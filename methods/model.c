/* A model: a method at work on one (albedo, g). Checks arguments, then hands over.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include "core/method.h"
#include "methods/light.h"

struct pps_model {
    const pps_method *method;
    pps_light light;
    bool composed; /* sky or ground: outputs are sums over solutions, see light.c */
    double thickness, mu0;
    bool solved;
    void *state;
};

static bool light_valid(const pps_light *light) {
    return light->beam >= 0 && isfinite(light->beam) && light->sky >= 0 &&
           isfinite(light->sky) && light->ground >= 0 && light->ground <= 1;
}

static bool options_valid(const pps_options *o) {
    bool streams = o->streams == 0 || (o->streams >= 2 && o->streams % 2 == 0 &&
                                       o->streams <= PPS_STREAMS_MAX);
    bool clash = o->delta_m == PPS_DELTA_M_OFF && o->nodes > PPS_NODES_GAUSS;
    return streams && !clash && o->nodes >= PPS_NODES_AUTO &&
           o->nodes <= PPS_NODES_GRADED && o->delta_m >= PPS_DELTA_M_AUTO &&
           o->delta_m <= PPS_DELTA_M_OFF && o->tolerance >= 0 && o->tolerance < 1 &&
           o->tolerance_of >= PPS_TOLERANCE_OF_FIELD &&
           o->tolerance_of <= PPS_TOLERANCE_OF_TRANSMITTANCE && light_valid(&o->light);
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
    if (o.light.beam == 0 && o.light.sky == 0) {
        o.light.beam = 1;
    }
    bool plain = o.light.sky == 0 && o.light.ground == 0 && o.light.beam == 1;
    if (!plain && !method->ops->own_light && !method->ops->solve_sky) {
        return PPS_ERR_UNSUPPORTED;
    }
    pps_model *model = calloc(1, sizeof *model);
    void *state = calloc(1, method->ops->state_size);
    if (!model || !state) {
        free(model);
        free(state);
        return PPS_ERR_MEMORY;
    }
    *model = (pps_model){.method = method,
                         .state = state,
                         .light = o.light,
                         .composed = !plain && !method->ops->own_light};
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
    model->thickness = thickness;
    model->mu0 = mu0;
    pps_status status = model->method->ops->solve(model->state, thickness, mu0);
    model->solved = status == PPS_OK;
    return status;
}

/* The model's method and slab, lit as its options say. */
static pps_lit lit(const pps_model *model) {
    return (pps_lit){.ops = model->method->ops,
                     .state = model->state,
                     .light = model->light,
                     .thickness = model->thickness,
                     .mu0 = model->mu0};
}

pps_status pps_model_radiance(pps_model *model, const pps_grid *at, double *radiance) {
    if (!model->solved || !radiance || pps_grid_check(at, model->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    if (!model->method->fields) {
        return PPS_ERR_UNSUPPORTED;
    }
    if (model->composed) {
        pps_lit composed = lit(model);
        return pps_lit_radiance(&composed, at, radiance);
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
    if (model->composed) {
        pps_lit composed = lit(model);
        return pps_lit_flux(&composed, n, tau, flux);
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
