/* The light models in closed form: each cell lit as a place in a slab, or by marching the
 * slab's light along the crown's real paths.
 *
 *   ss              direct light alone
 *   spp, ...        the slab's scattered light, times the G-factor where asked for
 *   march-g         phi = e^-d + albedo mean_j int_0^h_j [e^-z + G phi_d(z)] e^-s ds
 *   self-consistent phi = e^-d + m_d + r m_s, m_d and m_s the marched direct and slab's
 *                   scattered light, with the r that makes r phi_d of it again:
 *                   r = m_d / (phi_d - m_s). A quotient of differences: bounded, and each
 *                   of its two parts a mean over 3^3 cells.
 *
 * The last two go by what is seen, so wood, which is black, takes its share of the albedo.
 * The sky is 22 suns. Ground: black. Reference: docs/theory.md section 9.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/gfactor.h"
#include "tree/grid.h"
#include "tree/light_model.h"
#include "tree/ray_march.h"
#include "tree/vec.h"
#include "tree/wood.h"

enum { DIRECTIONS_MAX = 64 };
static const double RATIO_MAX = 3, SLIGHT = 1e-6;

/* A cell as a place in a slab, for one distant light and albedo. */
typedef struct {
    pps_slab_closure closure;
    double d, w, g, albedo;
    int n;
    const double (*to)[3]; /* the directions, and this light's own */
    const double *light_to;
    double mu[DIRECTIONS_MAX], h[DIRECTIONS_MAX];
} place;

/* Scattered fluence phi and net flux, for unit irradiance. Self-consistent: to phi and flux
 * come more_phi and more_flux, times the ratio over/under. */
typedef struct {
    double phi, flux[3], over, under, more_phi, more_flux[3];
} scattered;

typedef scattered (*closed_form)(const place *at);

static scattered in_slab(const place *at) {
    pps_slab_light light;
    pps_slab_light_init(&light, at->closure, at->albedo, at->w);
    scattered s = {.phi = at->g * pps_slab_light_sum(&light, at->d)};
    double net = at->g * pps_slab_light_net(&light, at->d) / 2;
    vec_along(s.flux, net, at->light_to, s.flux);
    return s;
}

/* Sums over directions of the marched light, [0] direct and [1] scattered. */
static void march(const place *at, const pps_slab_light *light, double phi[2],
                  double flux[2][3]) {
    memset(phi, 0, 2 * sizeof *phi);
    memset(flux, 0, 2 * sizeof *flux);
    for (int j = 0; j < at->n; j++) {
        pps_marched m = pps_ray_march(light, at->d, at->mu[j], at->h[j]);
        double share[2] = {at->albedo * m.direct / at->n,
                           at->albedo * m.scattered / at->n};
        for (int k = 0; k < 2; k++) {
            phi[k] += share[k];
            vec_along(flux[k], share[k], at->to[j], flux[k]);
        }
    }
}

static scattered marched(const place *at) {
    pps_slab_light light;
    double phi[2], flux[2][3];
    pps_slab_light_init(&light, at->closure, at->albedo, at->w);
    march(at, &light, phi, flux);
    scattered s = {.phi = phi[0] + at->g * phi[1]};
    vec_along(flux[0], at->g, flux[1], s.flux);
    return s;
}

static scattered consistent(const place *at) {
    pps_slab_light light;
    double phi[2], flux[2][3];
    pps_slab_light_init(&light, at->closure, at->albedo, at->w);
    march(at, &light, phi, flux);
    double slab = pps_slab_light_sum(&light, at->d);
    scattered s = {
        .phi = phi[0], .over = phi[0], .under = slab - phi[1], .more_phi = phi[1]};
    memcpy(s.flux, flux[0], sizeof s.flux);
    memcpy(s.more_flux, flux[1], sizeof s.more_flux);
    return s;
}

/* ---- over cells, bands and lights ---- */

/* Visibilities, and so the depths along the paths, are those of leaves and wood; wood is
 * black. So what a path meets scatters as leaves do only in their share of the extinction
 * thereabouts, the mean over 3^3 cells. */
static pps_status take_wood(const pps_cells *cells, size_t bands, float *albedo) {
    size_t n = cells->n_cells;
    double *leaf = calloc(4 * n + 1, sizeof *leaf);
    if (!leaf) {
        return PPS_ERR_MEMORY;
    }
    double *all = leaf + n, *mean_leaf = all + n, *mean_all = mean_leaf + n;
    for (size_t c = 0; c < n; c++) {
        leaf[c] = cells->area[c] / (2 * cells->size * cells->size);
        all[c] = leaf[c] + pps_wood_depth(cells, c);
    }
    pps_grid_smooth(cells, leaf, mean_leaf);
    pps_grid_smooth(cells, all, mean_all);
    for (size_t i = 0; i < n * bands; i++) {
        size_t c = i / bands;
        albedo[i] *= mean_all[c] > 0 ? (float)(mean_leaf[c] / mean_all[c]) : 1;
    }
    free(leaf);
    return PPS_OK;
}

typedef struct {
    closed_form form;
    pps_slab_closure closure;
    bool counts, paths, g, smooth; /* paths: h is needed */
} closed_model;

static void set_place(place *at, const pps_lit_scene *lit, const closed_model *model,
                      const pps_distant *light, size_t c) {
    const pps_cells *cells = lit->cells;
    double behind;
    pps_cell_depths(cells, model->counts, c, light->direction, &at->d, &behind);
    at->w = at->d + behind;
    for (int j = 0; model->paths && j < at->n; j++) {
        at->h[j] = pps_cell_path(cells, model->counts, c, j);
    }
    pps_compensation form = model->g ? lit->options.compensate : PPS_COMPENSATE_NONE;
    at->g = pps_g_factor(form, at->d, at->w, at->n, at->mu, at->h);
}

static void light_cells(const pps_lit_scene *lit, const closed_model *model,
                        const pps_distant *light, const float *albedo, scattered *out,
                        float *g_factor) {
    const pps_cells *cells = lit->cells;
    size_t bands = (size_t)lit->scene->n_bands;
    place base = {.closure = model->closure,
                  .n = cells->directions.n,
                  .to = cells->directions.to,
                  .light_to = light->to};
    for (int j = 0; j < base.n; j++) {
        base.mu[j] = vec_dot(base.to[j], light->to);
    }
#pragma omp parallel for schedule(static) firstprivate(base)                           \
    num_threads(pps_thread_count(lit->options.threads))
    for (size_t c = 0; c < cells->n_cells; c++) {
        if (!(cells->area[c] > 0)) {
            continue;
        }
        set_place(&base, lit, model, light, c);
        if (g_factor) {
            g_factor[c] = (float)base.g;
        }
        for (size_t b = 0; b < bands; b++) {
            base.albedo = (double)albedo[c * bands + b];
            bool same = b > 0 && albedo[c * bands + b] == albedo[c * bands + b - 1];
            out[c * bands + b] = same ? out[c * bands + b - 1] : model->form(&base);
        }
    }
}

static double ratio_of(double over, double under) {
    double least = fmax(under, SLIGHT * over);
    return least > 0 ? fmin(over / least, RATIO_MAX) : 0;
}

/* With the smoothed ratio, what `consistent` left apart comes to phi and flux. */
static pps_status apply_ratio(const pps_cells *cells, size_t bands, scattered *s) {
    size_t n = cells->n_cells;
    double *over = malloc((4 * n + 1) * sizeof *over);
    if (!over) {
        return PPS_ERR_MEMORY;
    }
    double *under = over + n, *mean_over = under + n, *mean_under = mean_over + n;
    for (size_t b = 0; b < bands; b++) {
        for (size_t c = 0; c < n; c++) {
            over[c] = s[c * bands + b].over;
            under[c] = s[c * bands + b].under;
        }
        pps_grid_smooth(cells, over, mean_over);
        pps_grid_smooth(cells, under, mean_under);
        for (size_t c = 0; c < n; c++) {
            scattered *at = &s[c * bands + b];
            double ratio = ratio_of(mean_over[c], mean_under[c]);
            at->phi += ratio * at->more_phi;
            vec_along(at->flux, ratio, at->more_flux, at->flux);
        }
    }
    free(over);
    return PPS_OK;
}

static void add_light(pps_light_field *field, const pps_cells *cells,
                      const pps_distant *light, const scattered *s) {
    size_t bands = (size_t)field->n_bands;
    for (size_t i = 0; i < cells->n_cells * bands; i++) {
        if (cells->area[i / bands] > 0) {
            double e = light->irradiance[i % bands];
            field->diffuse[i] += (float)(e * s[i].phi);
            for (int k = 0; k < 3; k++) {
                field->flux[3 * i + (size_t)k] += (float)(e * s[i].flux[k]);
            }
        }
    }
}

static pps_status solve(const pps_lit_scene *lit, pps_light_field *field,
                        closed_form form, pps_slab_closure closure) {
    const pps_cells *cells = lit->cells;
    size_t bands = (size_t)field->n_bands, n = cells->n_cells * bands;
    closed_model model = {.form = form,
                          .closure = closure,
                          .counts = field->model->ops->counts,
                          .g = field->model->compensates,
                          .smooth = form == consistent};
    model.paths = form != in_slab || lit->options.compensate;
    if (cells->directions.n > DIRECTIONS_MAX) {
        return PPS_ERR_ARGUMENT;
    }
    memset(field->diffuse, 0, n * sizeof *field->diffuse);
    memset(field->flux, 0, 3 * n * sizeof *field->flux);
    pps_distant lights[DIRECTIONS_MAX + 1];
    int n_lights = pps_distant_lights(lit, lights);
    float *albedo = NULL;
    scattered *s = calloc(n + 1, sizeof *s);
    pps_status status =
        s ? pps_cell_albedos(lit->scene, cells, &albedo) : PPS_ERR_MEMORY;
    if (!status && !model.counts) {
        status = take_wood(cells, bands, albedo);
    }
    for (int i = 0; !status && i < n_lights; i++) {
        bool sun = lights[i].direction < 0;
        light_cells(lit, &model, &lights[i], albedo, s, sun ? field->g_factor : NULL);
        status = model.smooth ? apply_ratio(cells, bands, s) : PPS_OK;
        if (!status) {
            add_light(field, cells, &lights[i], s);
        }
    }
    free(albedo);
    free(s);
    return status;
}

/* ---- rows of the table ---- */

static pps_status solve_ss(const pps_lit_scene *lit, pps_light_field *field) {
    return solve(lit, field, in_slab, PPS_SLAB_DARK);
}
static pps_status solve_spp(const pps_lit_scene *lit, pps_light_field *field) {
    return solve(lit, field, in_slab, PPS_SLAB_SPP);
}
static pps_status solve_printed(const pps_lit_scene *lit, pps_light_field *field) {
    return solve(lit, field, in_slab, PPS_SLAB_SPP_PRINTED);
}
static pps_status solve_hemispheric(const pps_lit_scene *lit, pps_light_field *field) {
    return solve(lit, field, in_slab, PPS_SLAB_HEMISPHERIC);
}
static pps_status solve_march_g(const pps_lit_scene *given, pps_light_field *field) {
    pps_lit_scene lit = *given;
    if (!lit.options.compensate) {
        lit.options.compensate = PPS_COMPENSATE_DERIVED;
    }
    return solve(&lit, field, marched, PPS_SLAB_HEMISPHERIC);
}
static pps_status solve_consistent(const pps_lit_scene *lit, pps_light_field *field) {
    return solve(lit, field, consistent, PPS_SLAB_HEMISPHERIC);
}

#define PAPER "SPP (2013)"
#define OURS "docs/theory.md section 9"
#define ROW(id, text, says, from, counted, closure, g, function)                       \
    static const struct pps_light_model_ops ops_##id = {                               \
        .counts = (counted), .slab = (closure), .solve = function};                    \
    const pps_light_model pps_light_##id = {.name = text,                              \
                                            .summary = says,                           \
                                            .source = from,                            \
                                            .sources = PPS_ALL_LIGHT,                  \
                                            .compensates = (g),                        \
                                            .ops = &ops_##id};
ROW(ss, "ss", "direct light alone", PAPER, true, PPS_SLAB_DARK, true, solve_ss)
ROW(spp, "spp", "simplified plane-parallel model, kappa = 1", PAPER, true, PPS_SLAB_SPP,
    true, solve_spp)
ROW(spp_printed, "spp-printed", "the same with Eq. 20 as printed, kappa = 1/T", PAPER,
    true, PPS_SLAB_SPP_PRINTED, true, solve_printed)
ROW(hemispheric, "hemispheric", "SPP's hemispheres with mean cosine 1/2", OURS, true,
    PPS_SLAB_HEMISPHERIC, true, solve_hemispheric)
ROW(march_g, "march-g", "the slab's light times G, marched along real paths", OURS,
    false, PPS_SLAB_DARK, true, solve_march_g)
ROW(self_consistent, "self-consistent",
    "the slab's light scaled so that marching gives it back", OURS, false,
    PPS_SLAB_DARK, false, solve_consistent)
