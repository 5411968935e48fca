/* Light models against Monte Carlo, category by category.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <ppscat/tree/experiment.h>

#include "tree/light_model.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double DEFAULT_BIN = 0.5;
enum { DEFAULT_RAYS = 2000000, N_TIMED = 5 };
static const double LEVEL[PPS_SCORE_LEVELS] = {20, 100}; /* triangles a category */

/* ---- categories ---- */

/* A leaf, as the averages see it. */
typedef struct {
    long category;    /* depth and thickness in bins, packed */
    double area;      /* its weight in averages */
    double triangles; /* what it counts */
    bool turned;      /* its back is the face towards the light */
    size_t leaf;
} member;

static int by_category(const void *a, const void *b) {
    const member *p = a, *q = b;
    if (p->category != q->category) {
        return p->category < q->category ? -1 : 1;
    }
    return (p->leaf > q->leaf) - (p->leaf < q->leaf);
}

static void fill_member(const pps_scene *scene, const pps_cells *cells, double bin,
                        const double axis[3], size_t i, member *m) {
    pps_scene_leaf at;
    pps_scene_leaf_at(scene, i, &at);
    const pps_mesh *mesh =
        scene->prototype[scene->instance[at.instance].prototype].mesh;
    size_t c = cells->cell_of[i];
    double d = cells->sun_depth[c], w = d + cells->sun_behind[c];
    *m = (member){.category = (long)floor(d / bin) * 100000 + (long)floor(w / bin),
                  .area = at.area,
                  .triangles = mesh->leaf[at.leaf].n_triangles,
                  .turned = vec_dot(at.normal, axis) < 0,
                  .leaf = i};
}

/* Leaves in the order of their categories. The light's axis is the sun's, or the zenith
 * where there is no sun. */
static member *sort_leaves(const pps_scene *scene, const pps_cells *cells, double bin) {
    member *members = malloc((scene->n_leaves + 1) * sizeof *members);
    double sun = 0, zenith[3] = {0, 0, 1};
    for (int b = 0; b < scene->n_bands; b++) {
        sun = fmax(sun, scene->sun.irradiance[b]);
    }
    for (size_t i = 0; members && i < scene->n_leaves; i++) {
        fill_member(scene, cells, bin, sun > 0 ? scene->sun.to : zenith, i,
                    &members[i]);
    }
    if (members) {
        qsort(members, scene->n_leaves, sizeof *members, by_category);
    }
    return members;
}

/* Sums over a category: of model and reference, [0] towards the light, [1] away. */
typedef struct {
    double triangles, area, model[2], truth[2];
} category;

static void add_leaf(category *sum, const member *m, const pps_irradiance *model,
                     const pps_irradiance *truth, size_t at) {
    const pps_irradiance *both[2] = {model, truth};
    for (int k = 0; k < 2; k++) {
        double *out = k == 0 ? sum->model : sum->truth;
        double front = both[k]->front[at], back = both[k]->back[at];
        out[0] += m->area * (m->turned ? back : front);
        out[1] += m->area * (m->turned ? front : back);
    }
    sum->triangles += m->triangles;
    sum->area += m->area;
}

/* Squared errors and squares of the reference, so far. */
typedef struct {
    double category[2], by_count[2], faces[2];
    int n;
} squares;

static void add_category(squares *s, const category *c) {
    double n = c->triangles, model[2], truth[2];
    for (int f = 0; f < 2; f++) {
        model[f] = c->area > 0 ? c->model[f] / c->area : 0;
        truth[f] = c->area > 0 ? c->truth[f] / c->area : 0;
        s->faces[0] += n * pow(model[f] - truth[f], 2);
        s->faces[1] += n * pow(truth[f], 2);
    }
    double error = pow(model[0] + model[1] - truth[0] - truth[1], 2);
    double size = pow(truth[0] + truth[1], 2);
    s->category[0] += error;
    s->category[1] += size;
    s->by_count[0] += n * error;
    s->by_count[1] += n * size;
    s->n++;
}

/* ---- leaf by leaf ---- */

static double both_faces(const pps_irradiance *light, size_t at) {
    return light->front[at] + light->back[at];
}

/* What chance adds to a leaf of the reference, squared. Of a face that no ray has met
 * nothing is known: its error says what one ray would have brought. */
static double variance(const pps_irradiance *truth, size_t at) {
    return (truth->front[at] > 0 ? pow(truth->front_error[at], 2) : 0) +
           (truth->back[at] > 0 ? pow(truth->back_error[at], 2) : 0);
}

static double leaf_error(const pps_scene *scene, const member *members,
                         const pps_irradiance *model, const pps_irradiance *truth,
                         int band) {
    double error = 0, size = 0;
    for (size_t i = 0; i < scene->n_leaves; i++) {
        size_t at = members[i].leaf * (size_t)scene->n_bands + (size_t)band;
        double want = both_faces(truth, at), chance = variance(truth, at);
        error += members[i].area * (pow(both_faces(model, at) - want, 2) - chance);
        size += members[i].area * (pow(want, 2) - chance);
    }
    return size > 0 ? sqrt(fmax(error, 0) / size) : 0;
}

static double root_ratio(const double s[2]) { return s[1] > 0 ? sqrt(s[0] / s[1]) : 0; }

static void score_band(const pps_scene *scene, const member *members,
                       const pps_irradiance *model, const pps_irradiance *truth,
                       int band, pps_score *score) {
    squares level[PPS_SCORE_LEVELS] = {0};
    double sum[2] = {0, 0};
    for (size_t i = 0, first = 0; i < scene->n_leaves; first = i) {
        category c = {0};
        for (; i < scene->n_leaves && members[i].category == members[first].category;
             i++) {
            size_t at = members[i].leaf * (size_t)scene->n_bands + (size_t)band;
            add_leaf(&c, &members[i], model, truth, at);
        }
        sum[0] += c.model[0] + c.model[1];
        sum[1] += c.truth[0] + c.truth[1];
        for (int k = 0; k < PPS_SCORE_LEVELS; k++) {
            if (c.triangles >= LEVEL[k]) {
                add_category(&level[k], &c);
            }
        }
    }
    score->brightness = sum[0] / sum[1];
    score->leaves = leaf_error(scene, members, model, truth, band);
    for (int k = 0; k < PPS_SCORE_LEVELS; k++) {
        score->category[k] = root_ratio(level[k].category);
        score->by_count[k] = root_ratio(level[k].by_count);
        score->faces[k] = root_ratio(level[k].faces);
        score->categories[k] = level[k].n;
    }
}

/* ---- contenders ---- */

/* Processor time, whatever else runs; contenders run on one thread. */
static double now(void) { return (double)clock() / CLOCKS_PER_SEC; }

/* What a contender is run with, and what it took. */
typedef struct {
    const pps_scene *scene;
    const pps_cells *cells;
    const float *att; /* of pps_leaf_attenuation */
    uint64_t seed;
    double cells_seconds, leaves_seconds; /* the least of some times, for other programs
                                             only add to it */
} trial;

/* On one core, whose time means the same whatever else runs. */
static pps_light_options alone(const trial *t, const pps_contender *c) {
    pps_light_options options = c->options;
    options.threads = options.threads ? options.threads : 1;
    options.att = t->att;
    return options;
}

/* Cells from no answer, with what is made once a scene at hand; then leaves. */
static pps_status run_field(trial *t, const pps_contender *c,
                            const pps_light_options *options, pps_light_field *field,
                            pps_irradiance **out) {
    double start = now();
    pps_light_field_forget(field);
    pps_status status =
        pps_light_field_solve(c->model, t->scene, t->cells, options, &field);
    double solved = now();
    if (!status) {
        status =
            pps_light_field_leaves(field, t->scene, t->cells, options->sources, out);
    }
    t->cells_seconds = fmin(t->cells_seconds, solved - start);
    t->leaves_seconds = fmin(t->leaves_seconds, now() - solved);
    return status;
}

/* A model without cells. */
static pps_status run_leaves(trial *t, const pps_contender *c,
                             const pps_light_options *options, pps_irradiance **out) {
    double start = now();
    pps_status status = pps_light_model_run(c->model, t->scene, t->cells, options, out);
    t->leaves_seconds = fmin(t->leaves_seconds, now() - start);
    return status;
}

static pps_status run_model(trial *t, const pps_contender *c, pps_irradiance **out) {
    pps_light_options options = alone(t, c);
    pps_light_field *field = NULL;
    bool has_field = c->model->ops->solve;
    pps_status status = PPS_OK;
    if (has_field) { /* what is made once a scene */
        status = pps_light_field_solve(c->model, t->scene, t->cells, &options, &field);
    }
    for (int i = 0; i < N_TIMED && !status; i++) {
        pps_irradiance_free(*out);
        *out = NULL;
        status = has_field ? run_field(t, c, &options, field, out)
                           : run_leaves(t, c, &options, out);
    }
    pps_light_field_free(field);
    return status;
}

static pps_status run_paths(trial *t, const pps_contender *c, pps_irradiance **out) {
    pps_trace_options options = {.rays = c->rays, .seed = t->seed, .threads = 1};
    double start = now();
    pps_status status = pps_trace_light(t->scene, &options, out, NULL);
    t->leaves_seconds = now() - start;
    return status;
}

/* Light the leaves, and time it. */
static pps_status run_contender(trial *t, const pps_contender *c,
                                pps_irradiance **out) {
    t->cells_seconds = t->leaves_seconds = INFINITY;
    *out = NULL;
    return c->model ? run_model(t, c, out) : run_paths(t, c, out);
}

static double cells_with_leaves(const pps_cells *cells) {
    double n = 0;
    for (size_t c = 0; c < cells->n_cells; c++) {
        n += cells->area[c] > 0;
    }
    return n;
}

/* Where one time is not there, the other is all there is. */
static void note_times(const trial *t, pps_score *score) {
    double seconds = t->leaves_seconds, cells = t->leaves_seconds;
    if (isfinite(t->cells_seconds)) {
        seconds += t->cells_seconds;
        cells = t->cells_seconds;
    }
    score->seconds_per_cell = cells / cells_with_leaves(t->cells);
    score->seconds_per_leaf = seconds / (double)t->scene->n_leaves;
}

static pps_status score_one(trial *t, const pps_contender *c, const member *members,
                            const pps_irradiance *reference, pps_score *score) {
    pps_irradiance *light = NULL;
    pps_status status = run_contender(t, c, &light);
    for (int b = 0; b < t->scene->n_bands && !status; b++) {
        score_band(t->scene, members, light, reference, b, &score[b]);
        note_times(t, &score[b]);
    }
    pps_irradiance_free(light);
    return status;
}

/* Attenuations, where a contender takes them. */
static pps_status need_attenuations(const pps_scene *scene, size_t n,
                                    const pps_contender *contender, float **att) {
    bool needed = false;
    for (size_t i = 0; i < n; i++) {
        needed |= contender[i].model && contender[i].model->takes_attenuations;
    }
    return needed ? pps_leaf_attenuation_create(scene, NULL, att) : PPS_OK;
}

pps_status pps_score_models(const pps_scene *scene, const pps_cells *cells,
                            const pps_irradiance *reference, double bin, size_t n,
                            const pps_contender *contender, uint64_t seed,
                            pps_score *score) {
    if (!scene || !cells || !reference || reference->n_leaves != scene->n_leaves ||
        reference->n_bands != scene->n_bands || !reference->front_error ||
        !(bin >= 0)) {
        return PPS_ERR_ARGUMENT;
    }
    float *att = NULL;
    member *members = sort_leaves(scene, cells, bin > 0 ? bin : DEFAULT_BIN);
    pps_status status =
        members ? need_attenuations(scene, n, contender, &att) : PPS_ERR_MEMORY;
    trial t = {.scene = scene, .cells = cells, .att = att, .seed = seed};
    for (size_t i = 0; i < n && !status; i++) {
        status = score_one(&t, &contender[i], members, reference,
                           &score[i * (size_t)scene->n_bands]);
    }
    free(att);
    free(members);
    return status;
}

#define ROW(label, id, ...)                                                            \
    { label, &pps_light_##id, {__VA_ARGS__}, 0 }
#define MODEL(name) extern const pps_light_model pps_light_##name;
#include "tree/models.def"
#undef MODEL

static const pps_contender contenders[] = {
    ROW("SPPG", spp_printed, .compensate = PPS_COMPENSATE_DERIVED),
    ROW("SPP", spp_printed, .compensate = PPS_COMPENSATE_NONE),
    ROW("SS", ss, .compensate = PPS_COMPENSATE_NONE),
    ROW("SPPG (printed G)", spp_printed, .compensate = PPS_COMPENSATE_PRINTED),
    ROW("SPPG (kappa 1)", spp, .compensate = PPS_COMPENSATE_DERIVED),
    ROW("SPP (kappa 1)", spp, .compensate = PPS_COMPENSATE_NONE),
    ROW("hemispheric with G", hemispheric, .compensate = PPS_COMPENSATE_DERIVED),
    ROW("hemispheric", hemispheric, .compensate = PPS_COMPENSATE_NONE),
    ROW("march-g", march_g, .compensate = PPS_COMPENSATE_DERIVED),
    ROW("self-consistent", self_consistent, .compensate = PPS_COMPENSATE_NONE),
    ROW("lattice", lattice, .compensate = PPS_COMPENSATE_NONE),
    ROW("leaf", leaf, .sun_mean = PPS_SUN_PRINTED),
    ROW("leaf unbiased", leaf, .sun_mean = PPS_SUN_UNBIASED),
    ROW("leaf-lattice", leaf_lattice, .sun_mean = PPS_SUN_PRINTED),
    ROW("leaf-lattice unbiased", leaf_lattice, .sun_mean = PPS_SUN_UNBIASED),
    ROW("radiosity", radiosity, .compensate = PPS_COMPENSATE_NONE),
};

/* The paper traced 184K rays. */
static const pps_contender paths[] = {
    {.label = "mc 18K rays", .rays = 18400},
    {.label = "mc 184K rays", .rays = 184000},
    {.label = "mc 1.8M rays", .rays = 1840000},
};

const pps_contender *pps_contender_table(size_t *n) {
    *n = sizeof contenders / sizeof *contenders;
    return contenders;
}

const pps_contender *pps_contender_paths(size_t *n) {
    *n = sizeof paths / sizeof *paths;
    return paths;
}

/* ---- crowns ---- */

static pps_status grow_scene(const pps_experiment *e, pps_scene **out) {
    pps_mesh *mesh;
    *out = NULL;
    if (e->n_bands < 1 || e->n_bands > PPS_BANDS_MAX || !(e->period >= 0) ||
        !(e->zenith >= 0 && e->zenith < 90)) {
        return PPS_ERR_ARGUMENT;
    }
    pps_status status = pps_crown_grow(&e->crown, &mesh);
    pps_mesh_size size;
    if (!status) {
        pps_mesh_measure(mesh, &size);
        status = pps_scene_single(mesh, e->albedo[0], out);
    }
    if (status) {
        return status;
    }
    pps_scene *scene = *out;
    scene->n_bands = e->n_bands;
    scene->sun.to[0] = sin(e->zenith * PI / 180);
    scene->sun.to[2] = cos(e->zenith * PI / 180);
    scene->period[0] = scene->period[1] = e->period * size.radius;
    for (int b = 0; b < e->n_bands; b++) {
        scene->sun.irradiance[b] = e->sky ? 0 : 1;
        scene->sky.zenith[b] = e->sky ? 1 : 0;
        scene->sky.horizon[b] = e->sky ? 0.5 : 0;
        for (int face = 0; face < 2; face++) {
            scene->prototype[0].optics.reflectance[face][b] = e->albedo[b] / 2;
            scene->prototype[0].optics.transmittance[face][b] = e->albedo[b] / 2;
        }
    }
    status = pps_scene_index(scene);
    if (status) {
        pps_scene_free(scene);
        *out = NULL;
    }
    return status;
}

pps_status pps_experiment_run(const pps_experiment *e, size_t n,
                              const pps_contender *contender, pps_score *score) {
    pps_scene *scene = NULL;
    pps_cells *cells = NULL;
    pps_irradiance *truth = NULL;
    pps_cells_options options = {.across = e->across,
                                 .samples = e->samples,
                                 .seed = e->seed,
                                 .threads = e->threads};
    pps_trace_options trace = {.rays = e->rays ? e->rays : DEFAULT_RAYS,
                               .seed = e->seed,
                               .threads = e->threads};
    pps_status status = grow_scene(e, &scene);
    if (!status) {
        status = pps_cells_create(scene, &options, &cells);
    }
    if (!status) {
        status = pps_cells_set_sun(cells, scene, &options);
    }
    if (!status) {
        status = pps_trace_light(scene, &trace, &truth, NULL);
    }
    if (!status) {
        status = pps_score_models(scene, cells, truth, e->bin, n, contender, ~e->seed,
                                  score);
    }
    pps_irradiance_free(truth);
    pps_cells_free(cells);
    pps_scene_free(scene);
    return status;
}
