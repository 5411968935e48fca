/* The table of light models, and running one of them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "tree/light_model.h"

#define MODEL(name) extern const pps_light_model pps_light_##name;
#include "tree/models.def"
#undef MODEL

static const pps_light_model *const table[] = {
#define MODEL(name) &pps_light_##name,
#include "tree/models.def"
#undef MODEL
};
enum { N_MODELS = sizeof table / sizeof *table };

size_t pps_light_model_count(void) { return N_MODELS; }

const pps_light_model *pps_light_model_at(size_t i) {
    return i < N_MODELS ? table[i] : NULL;
}

const pps_light_model *pps_light_model_find(const char *name) {
    for (size_t i = 0; i < N_MODELS; i++) {
        if (strcmp(table[i]->name, name) == 0) {
            return table[i];
        }
    }
    return NULL;
}

/* A model without cells writes leaves itself. */
static pps_status run_leaves(const pps_lit_scene *lit, const pps_light_model *model,
                             pps_irradiance **out) {
    pps_status status = pps_irradiance_create(lit->scene, false, out);
    if (!status) {
        status = model->ops->leaves(lit, *out);
    }
    if (status) {
        pps_irradiance_free(*out);
        *out = NULL;
    }
    return status;
}

pps_status pps_light_model_run(const pps_light_model *model, const pps_scene *scene,
                               const pps_cells *cells, const pps_light_options *options,
                               pps_irradiance **out) {
    *out = NULL;
    if (!model || !scene) {
        return PPS_ERR_ARGUMENT;
    }
    pps_lit_scene lit = {.scene = scene, .cells = cells};
    pps_status status = pps_light_options_check(model, options, &lit.options);
    if (status) {
        return status;
    }
    if (model->ops->leaves) {
        return run_leaves(&lit, model, out);
    }
    pps_light_field *field = NULL;
    status = pps_light_field_solve(model, scene, cells, options, &field);
    if (!status) {
        status = pps_light_field_leaves(field, scene, cells, lit.options.sources, out);
    }
    pps_light_field_free(field);
    return status;
}
