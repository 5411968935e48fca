/* The result of every light model: memory only.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include <ppscat/tree/light.h>

pps_status pps_irradiance_create(const pps_scene *scene, bool errors,
                                 pps_irradiance **out) {
    size_t n = scene->n_leaves * (size_t)scene->n_bands;
    pps_irradiance *result = calloc(1, sizeof *result);
    double *values = calloc((errors ? 4 : 2) * n + 1, sizeof *values);
    *out = NULL;
    if (!result || !values) {
        free(result);
        free(values);
        return PPS_ERR_MEMORY;
    }
    *result = (pps_irradiance){.n_leaves = scene->n_leaves,
                               .n_bands = scene->n_bands,
                               .front = values,
                               .back = values + n,
                               .front_error = errors ? values + 2 * n : NULL,
                               .back_error = errors ? values + 3 * n : NULL};
    *out = result;
    return PPS_OK;
}

void pps_irradiance_free(pps_irradiance *irradiance) {
    if (irradiance) {
        free(irradiance->front);
        free(irradiance);
    }
}
