/* The row "leaf" of the table: attenuations of every leaf's octants, and closed forms.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>

#include "tree/light_model.h"

static pps_status light(const pps_lit_scene *lit, const float *att,
                        pps_irradiance *out) {
    return pps_leaf_light(lit->scene, att, lit->options.sun_mean, lit->options.sources,
                          out);
}

static pps_status leaves(const pps_lit_scene *lit, pps_irradiance *out) {
    if (lit->options.att) {
        return light(lit, lit->options.att, out);
    }
    pps_attenuation_options options = {.threads = lit->options.threads};
    float *att;
    pps_status status = pps_leaf_attenuation_create(lit->scene, &options, &att);
    if (!status) {
        status = light(lit, att, out);
    }
    free(att);
    return status;
}

static const struct pps_light_model_ops ops = {.leaves = leaves};

const pps_light_model pps_light_leaf = {
    .name = "leaf",
    .summary = "eight attenuations a leaf: sky, sun, and the sun by way of one leaf",
    .source = "Boulanger et al. 2008",
    .sources = PPS_SUN | PPS_SUN_INDIRECT | PPS_SKY,
    .without_cells = true,
    .without_field = true,
    .takes_attenuations = true,
    .ops = &ops,
};
