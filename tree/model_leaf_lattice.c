/* The row "leaf-lattice" of the table: the per-leaf model, and from where its one bounce
 * ends the lattice's light.
 *
 * The lattice gives all bounces of the sun, n = 1, 2, .., together; what it scatters once
 * is linear in the leaves' albedo and the rest is not. So a lattice with leaves FAINT times
 * as bright, divided by FAINT, is the first bounce alone, and the difference is what the
 * per-leaf model leaves out. Light of the sky that leaves scatter is the lattice's.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include "tree/light_model.h"

/* The second bounce is this much of the first one's error. */
static const double FAINT = 1e-4;

extern const pps_light_model pps_light_lattice, pps_light_leaf;

/* out += factor * light */
static void add(pps_irradiance *out, double factor, const pps_irradiance *light) {
    size_t n = out->n_leaves * (size_t)out->n_bands;
    for (size_t i = 0; i < n; i++) {
        out->front[i] += factor * light->front[i];
        out->back[i] += factor * light->back[i];
    }
}

static pps_status add_lattice(const pps_lit_scene *lit, const pps_scene *scene,
                              unsigned sources, double factor, pps_irradiance *out) {
    pps_light_options options = lit->options;
    pps_irradiance *light;
    options.sources = sources;
    pps_status status =
        pps_light_model_run(&pps_light_lattice, scene, lit->cells, &options, &light);
    if (!status) {
        add(out, factor, light);
        pps_irradiance_free(light);
    }
    return status;
}

/* The first bounce of the sun, taken away: the same scene with faint leaves and ground. */
static pps_status take_first_bounce(const pps_lit_scene *lit, pps_irradiance *out) {
    pps_scene faint = *lit->scene;
    size_t size = faint.n_prototypes * sizeof *faint.prototype;
    faint.prototype = malloc(size);
    if (!faint.prototype) {
        return PPS_ERR_MEMORY;
    }
    memcpy(faint.prototype, lit->scene->prototype, size);
    for (size_t i = 0; i < 2 * faint.n_prototypes * PPS_BANDS_MAX; i++) {
        pps_leaf_optics *o = &faint.prototype[i / (2 * PPS_BANDS_MAX)].optics;
        size_t face = i / PPS_BANDS_MAX % 2, band = i % PPS_BANDS_MAX;
        o->reflectance[face][band] *= FAINT;
        o->transmittance[face][band] *= FAINT;
    }
    for (int band = 0; band < PPS_BANDS_MAX; band++) {
        faint.ground.reflectance[band] *= FAINT;
    }
    pps_status status = add_lattice(lit, &faint, PPS_SUN_INDIRECT, -1 / FAINT, out);
    free(faint.prototype);
    return status;
}

static void keep_positive(pps_irradiance *out) {
    size_t n = out->n_leaves * (size_t)out->n_bands;
    for (size_t i = 0; i < n; i++) {
        out->front[i] = out->front[i] > 0 ? out->front[i] : 0;
        out->back[i] = out->back[i] > 0 ? out->back[i] : 0;
    }
}

static pps_status leaves(const pps_lit_scene *lit, pps_irradiance *out) {
    unsigned asked = lit->options.sources;
    pps_lit_scene near = *lit;
    near.options.sources = asked & pps_light_leaf.sources;
    pps_status status =
        near.options.sources ? pps_light_leaf.ops->leaves(&near, out) : PPS_OK;
    unsigned far = asked & (PPS_SUN_INDIRECT | PPS_SKY_INDIRECT);
    if (!status && far) {
        status = add_lattice(lit, lit->scene, far, 1, out);
    }
    if (!status && asked & PPS_SUN_INDIRECT) {
        status = take_first_bounce(lit, out);
    }
    keep_positive(out);
    return status;
}

static const struct pps_light_model_ops ops = {.leaves = leaves};

const pps_light_model pps_light_leaf_lattice = {
    .name = "leaf-lattice",
    .summary = "`leaf`, and the light of further bounces from `lattice`",
    .source = "Boulanger et al. 2008; docs/theory.md section 10",
    .sources = PPS_ALL_LIGHT,
    .without_field = true,
    .takes_attenuations = true,
    .ops = &ops,
};
