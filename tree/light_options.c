/* Options of light models: what was given, held against what the model can do.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/light_model.h"

pps_status pps_light_options_check(const pps_light_model *model,
                                   const pps_light_options *given,
                                   pps_light_options *options) {
    *options = given ? *given : (pps_light_options){0};
    if (!options->sources) {
        options->sources = model->sources;
    }
    if (options->kappa < 0 || options->threads < 0 ||
        options->sources > PPS_ALL_LIGHT || options->compensate < PPS_COMPENSATE_NONE ||
        options->compensate > PPS_COMPENSATE_PRINTED) {
        return PPS_ERR_ARGUMENT;
    }
    bool refused = (options->sources & ~model->sources) ||
                   (options->compensate && !model->compensates);
    return refused ? PPS_ERR_UNSUPPORTED : PPS_OK;
}
