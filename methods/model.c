/* A model: a method at work on one (albedo, g). Checks arguments, then hands over.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/method.h"
#include "methods/light.h"

struct pps_model {
    const pps_method *method;
    pps_light light;
    bool composed; /* sky or ground: outputs are sums over solutions, see light.c */
    double thickness;
    size_t n_beams;  /* 0 until solved */
    size_t capacity; /* beams that there is memory for */
    double *mu0;
    pps_info *info; /* of each beam, where they are solved one at a time */
    bool at_once;   /* the method has all beams solved */
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

static pps_status reserve(pps_model *model, size_t n) {
    if (n <= model->capacity) {
        return PPS_OK;
    }
    double *mu0 = malloc(n * sizeof *mu0);
    pps_info *info = malloc(n * sizeof *info);
    if (!mu0 || !info) {
        free(mu0);
        free(info);
        return PPS_ERR_MEMORY;
    }
    free(model->mu0);
    free(model->info);
    model->mu0 = mu0;
    model->info = info;
    model->capacity = n;
    return PPS_OK;
}

/* Hand the beams over: all at once where the method can, else to see that it takes each. */
static pps_status solve_beams(pps_model *model, size_t n) {
    const pps_method_ops *ops = model->method->ops;
    pps_status status = PPS_ERR_UNSUPPORTED;
    if (n > 1 && ops->solve_beams && !model->composed) {
        status = ops->solve_beams(model->state, model->thickness, n, model->mu0);
        model->at_once = status == PPS_OK;
    }
    for (size_t b = 0; b < n && !model->at_once; b++) {
        status = ops->solve(model->state, model->thickness, model->mu0[b]);
        if (status) {
            return status;
        }
    }
    return status;
}

pps_status pps_model_solve_beams(pps_model *model, double thickness, size_t n,
                                 const double *mu0) {
    model->n_beams = 0;
    model->at_once = false;
    bool valid = thickness > 0 && n > 0 && mu0;
    for (size_t b = 0; valid && b < n; b++) {
        valid = pps_mu0_check(mu0[b]) == PPS_OK;
    }
    if (!valid) {
        return PPS_ERR_ARGUMENT;
    }
    if (isinf(thickness) && !model->method->half_space) {
        return PPS_ERR_UNSUPPORTED;
    }
    pps_status status = reserve(model, n);
    if (status) {
        return status;
    }
    model->thickness = thickness;
    memcpy(model->mu0, mu0, n * sizeof *mu0);
    for (size_t b = 0; b < n; b++) {
        model->info[b] = (pps_info){.error_estimate = (double)NAN};
    }
    status = solve_beams(model, n);
    model->n_beams = status ? 0 : n;
    return status;
}

pps_status pps_model_solve(pps_model *model, double thickness, double mu0) {
    return pps_model_solve_beams(model, thickness, 1, &mu0);
}

/* What is asked for: radiances at the directions of a grid, or fluxes at depths. */
typedef struct {
    const pps_grid *at; /* NULL for fluxes */
    double *radiance;
    size_t n_tau;
    const double *tau;
    pps_flux *flux;
} output;

/* Beam b of the model, which is solved for it. */
static pps_status output_of_beam(pps_model *model, size_t b, const output *out) {
    const pps_method_ops *ops = model->method->ops;
    if (model->composed) {
        pps_lit lit = {.ops = ops,
                       .state = model->state,
                       .light = model->light,
                       .thickness = model->thickness,
                       .mu0 = model->mu0[b]};
        return out->at ? pps_lit_radiance(&lit, out->at, out->radiance)
                       : pps_lit_flux(&lit, out->n_tau, out->tau, out->flux);
    }
    return out->at ? ops->radiance(model->state, out->at, out->radiance)
                   : ops->flux(model->state, out->n_tau, out->tau, out->flux);
}

static pps_status output_of_beams(pps_model *model, output *out) {
    const pps_method_ops *ops = model->method->ops;
    if (model->n_beams == 1 || model->at_once) {
        return output_of_beam(model, 0, out);
    }
    for (size_t b = 0; b < model->n_beams; b++) {
        pps_status status = ops->solve(model->state, model->thickness, model->mu0[b]);
        status = status ? status : output_of_beam(model, b, out);
        if (status) {
            return status;
        }
        if (ops->query) {
            ops->query(model->state, &model->info[b]);
        }
        if (out->at) {
            out->radiance += out->at->n_tau * out->at->n_mu * out->at->n_phi;
        } else {
            out->flux += out->n_tau;
        }
    }
    return PPS_OK;
}

pps_status pps_model_radiance(pps_model *model, const pps_grid *at, double *radiance) {
    if (model->n_beams == 0 || !radiance || pps_grid_check(at, model->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    if (!model->method->fields) {
        return PPS_ERR_UNSUPPORTED;
    }
    return output_of_beams(model, &(output){.at = at, .radiance = radiance});
}

pps_status pps_model_flux(pps_model *model, size_t n, const double *tau,
                          pps_flux *flux) {
    if (model->n_beams == 0 || !flux || pps_tau_check(n, tau, model->thickness)) {
        return PPS_ERR_ARGUMENT;
    }
    if (!model->method->fluxes) {
        return PPS_ERR_UNSUPPORTED;
    }
    return output_of_beams(model, &(output){.n_tau = n, .tau = tau, .flux = flux});
}

void pps_model_query_beam(const pps_model *model, size_t b, pps_info *info) {
    const pps_method_ops *ops = model->method->ops;
    *info = (pps_info){.error_estimate = (double)NAN};
    if (model->at_once && ops->query_beam) {
        ops->query_beam(model->state, b, info);
    } else if (model->n_beams > 1) {
        *info = b < model->n_beams ? model->info[b] : *info;
    } else if (ops->query) {
        ops->query(model->state, info);
    }
}

void pps_model_query(const pps_model *model, pps_info *info) {
    pps_model_query_beam(model, 0, info);
}

void pps_model_free(pps_model *model) {
    if (!model) {
        return;
    }
    if (model->method->ops->clear) {
        model->method->ops->clear(model->state);
    }
    free(model->state);
    free(model->mu0);
    free(model->info);
    free(model);
}
