/* Light by cells: the direct part, common to all models, and from cells to leaves.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/field.h>

#include "tree/grid.h"
#include "tree/light_model.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

/* ---- what models read of cells and scene ---- */

/* Depth that a mean visibility stands for, no deeper than its samples can tell. */
static double visible_depth(const pps_cells *cells, size_t c, double visibility) {
    return -log(fmin(fmax(visibility, 0.25 / cells->n_points[c]), 1));
}

double pps_cell_path(const pps_cells *cells, bool counts, size_t c, int j) {
    size_t at = c * (size_t)cells->directions.n + (size_t)j;
    return counts ? (double)cells->depth[at]
                  : visible_depth(cells, c, (double)cells->visibility[at]);
}

void pps_cell_depths(const pps_cells *cells, bool counts, size_t c, int direction,
                     double *depth, double *behind) {
    if (direction >= 0) {
        *depth = pps_cell_path(cells, counts, c, direction);
        *behind = pps_cell_path(cells, counts, c, direction ^ 1);
    } else if (counts) {
        *depth = cells->sun_depth[c];
        *behind = cells->sun_behind[c];
    } else {
        *depth = visible_depth(cells, c, cells->sun_visibility[c]);
        *behind = visible_depth(cells, c, cells->sun_clear[c]);
    }
}

double pps_sky_part(const pps_scene *scene, const pps_cells *cells, int j, int band) {
    double z = cells->directions.to[j][2];
    return z < 0 && scene->ground.present ? 0 : pps_sky_radiance(&scene->sky, band, z);
}

int pps_distant_lights(const pps_lit_scene *lit, pps_distant *lights) {
    const pps_scene *scene = lit->scene;
    const pps_directions *directions = &lit->cells->directions;
    int n = 0;
    if (lit->options.sources & PPS_SUN_INDIRECT) {
        lights[n] = (pps_distant){.direction = -1};
        memcpy(lights[n].to, scene->sun.to, sizeof lights[n].to);
        memcpy(lights[n].irradiance, scene->sun.irradiance,
               sizeof lights[n].irradiance);
        n++;
    }
    for (int j = 0; (lit->options.sources & PPS_SKY_INDIRECT) && j < directions->n;
         j++) {
        double most = 0;
        lights[n] = (pps_distant){.direction = j};
        memcpy(lights[n].to, directions->to[j], sizeof lights[n].to);
        for (int b = 0; b < scene->n_bands; b++) {
            lights[n].irradiance[b] =
                4 * PI / directions->n * pps_sky_part(scene, lit->cells, j, b);
            most = fmax(most, lights[n].irradiance[b]);
        }
        n += most > 0;
    }
    return n;
}

/* Sums of area and of area times albedo; the last row is the whole scene's. */
static void sum_albedos(const pps_scene *scene, const pps_cells *cells, size_t width,
                        double *sum) {
    double *whole = sum + cells->n_cells * width;
    for (size_t k = 0, i = 0; k < scene->n_instances; k++) {
        const pps_prototype *p = &scene->prototype[scene->instance[k].prototype];
        double share[PPS_BANDS_MAX], square = pow(scene->instance[k].scale, 2);
        for (size_t b = 0; b < width - 1; b++) {
            share[b] = pps_leaf_albedo(&p->optics, (int)b);
        }
        for (size_t l = 0; l < p->mesh->n_leaves; l++, i++) {
            double area = p->mesh->leaf[l].area * square,
                   *at = sum + cells->cell_of[i] * width;
            for (size_t b = 0; b < width - 1; b++) {
                at[b] += area * share[b];
                whole[b] += area * share[b];
            }
            at[width - 1] += area;
            whole[width - 1] += area;
        }
    }
}

pps_status pps_cell_albedos(const pps_scene *scene, const pps_cells *cells,
                            float **albedo) {
    size_t n_bands = (size_t)scene->n_bands, n = cells->n_cells;
    double *sum = calloc((n + 1) * (n_bands + 1), sizeof *sum);
    *albedo = malloc((n * n_bands + 1) * sizeof **albedo);
    if (!sum || !*albedo) {
        free(sum);
        free(*albedo);
        *albedo = NULL;
        return PPS_ERR_MEMORY;
    }
    sum_albedos(scene, cells, n_bands + 1, sum);
    for (size_t c = 0; c < n; c++) {
        /* A cell with parts of leaves that count in others takes the scene's mean. */
        const double *at =
            sum + (sum[c * (n_bands + 1) + n_bands] > 0 ? c : n) * (n_bands + 1);
        for (size_t b = 0; b < n_bands; b++) {
            (*albedo)[c * n_bands + b] =
                (float)(at[n_bands] > 0 ? at[b] / at[n_bands] : 0);
        }
    }
    free(sum);
    return PPS_OK;
}

/* ---- the field ---- */

void pps_light_field_free(pps_light_field *field) {
    if (field) {
        if (field->state && field->model->ops->free_state) {
            field->model->ops->free_state(field->state);
        }
        free(field->diffuse);
        free(field);
    }
}

void pps_light_field_forget(pps_light_field *field) {
    if (field && field->state && field->model->ops->forget) {
        field->model->ops->forget(field->state);
    }
}

static pps_light_field *create(const pps_light_model *model, const pps_scene *scene,
                               const pps_cells *cells) {
    size_t n = cells->n_cells, bands = (size_t)scene->n_bands,
           directions = (size_t)cells->directions.n;
    pps_light_field *field = calloc(1, sizeof *field);
    float *values = calloc(n * (4 * bands + 4 + directions), sizeof *values);
    if (!field || !values) {
        free(field);
        free(values);
        return NULL;
    }
    *field = (pps_light_field){.model = model,
                               .n_cells = n,
                               .n_bands = scene->n_bands,
                               .n_directions = cells->directions.n,
                               .diffuse = values,
                               .flux = values + n * bands,
                               .sun = values + n * 4 * bands,
                               .depth = values + n * (4 * bands + 1),
                               .thickness = values + n * (4 * bands + 2),
                               .g_factor = values + n * (4 * bands + 3),
                               .sky = values + n * (4 * bands + 4)};
    return field;
}

/* Depths and the visibility of sun and sky, as the model takes them. */
static void set_direct(pps_light_field *field, const pps_cells *cells) {
    bool counts = field->model->ops->counts;
    for (size_t c = 0; c < cells->n_cells; c++) {
        if (!(cells->area[c] > 0)) {
            continue;
        }
        double depth, behind;
        pps_cell_depths(cells, counts, c, -1, &depth, &behind);
        field->depth[c] = (float)depth;
        field->thickness[c] = (float)(depth + behind);
        field->sun[c] = (float)(counts ? exp(-depth) : cells->sun_visibility[c]);
        field->g_factor[c] = 1;
        for (int j = 0; j < field->n_directions; j++) {
            size_t at = c * (size_t)field->n_directions + (size_t)j;
            field->sky[at] = counts ? expf(-cells->depth[at]) : cells->visibility[at];
        }
    }
}

static bool fits(const pps_light_field *field, const pps_light_model *model,
                 const pps_scene *scene, const pps_cells *cells) {
    return field->model == model && field->n_cells == cells->n_cells &&
           field->n_bands == scene->n_bands &&
           field->n_directions == cells->directions.n;
}

pps_status pps_light_field_solve(const pps_light_model *model, const pps_scene *scene,
                                 const pps_cells *cells,
                                 const pps_light_options *options,
                                 pps_light_field **field) {
    if (!model || !scene || !cells || (*field && !fits(*field, model, scene, cells))) {
        return PPS_ERR_ARGUMENT;
    }
    pps_lit_scene lit = {.scene = scene, .cells = cells};
    pps_status status = pps_light_options_check(model, options, &lit.options);
    if (status || !model->ops->solve) {
        return status ? status : PPS_ERR_UNSUPPORTED;
    }
    pps_light_field *at = *field ? *field : create(model, scene, cells);
    if (!at) {
        return PPS_ERR_MEMORY;
    }
    set_direct(at, cells);
    status = model->ops->solve(&lit, at);
    if (status && !*field) {
        pps_light_field_free(at);
        return status;
    }
    *field = at;
    return status;
}

/* ---- leaves ---- */

/* From the sun: [face][band], from the sky parts that the face looks at. */
typedef struct {
    unsigned sources;
    int n_bands, n_directions;
    double radiance[64][PPS_BANDS_MAX]; /* 4 pi/N times that of each direction */
} direct_light;

/* The sun's light on the leaf's own points: of models that go by what is seen. */
static const float (*own_sun(const pps_light_field *field, const pps_cells *cells))[2] {
    return field->leaf_sun             ? field->leaf_sun
           : field->model->ops->counts ? NULL
                                       : (const float(*)[2])cells->leaf_sun;
}

/* The part of a leaf's light, `share` of the whole, that cell c gives it. */
static void add_cell(const pps_light_field *field, const pps_scene *scene,
                     const pps_cells *cells, const direct_light *direct,
                     const double normal[3], size_t c, double share, double *front,
                     double *back) {
    size_t bands = (size_t)field->n_bands;
    bool lit = direct->sources & (PPS_SUN_INDIRECT | PPS_SKY_INDIRECT) &&
               !field->leaf_scattered;
    double sun = direct->sources & PPS_SUN && !own_sun(field, cells)
                     ? vec_dot(normal, scene->sun.to) * (double)field->sun[c]
                     : 0;
    for (size_t b = 0; b < bands; b++) {
        const float *j = &field->flux[3 * (c * bands + b)];
        double even = (double)field->diffuse[c * bands + b] / 4;
        double odd = (normal[0] * (double)j[0] + normal[1] * (double)j[1] +
                      normal[2] * (double)j[2]) /
                     2;
        double e = scene->sun.irradiance[b];
        front[b] += share * (e * fmax(sun, 0) + lit * fmax(even + odd, 0));
        back[b] += share * (e * fmax(-sun, 0) + lit * fmax(even - odd, 0));
    }
    for (int d = 0; d < direct->n_directions; d++) {
        double through =
            share * vec_dot(normal, cells->directions.to[d]) *
            (double)field->sky[c * (size_t)field->n_directions + (size_t)d];
        for (size_t b = 0; b < bands; b++) {
            front[b] += fmax(through, 0) * direct->radiance[d][b];
            back[b] += fmax(-through, 0) * direct->radiance[d][b];
        }
    }
}

/* What is known of the leaf itself. */
static void add_own(const pps_light_field *field, const pps_scene *scene,
                    const pps_cells *cells, const direct_light *direct, size_t i,
                    double *front, double *back) {
    size_t bands = (size_t)field->n_bands;
    const float(*sun)[2] = direct->sources & PPS_SUN ? own_sun(field, cells) : NULL;
    for (size_t b = 0; sun && b < bands; b++) {
        front[b] += scene->sun.irradiance[b] * (double)sun[i][PPS_FRONT];
        back[b] += scene->sun.irradiance[b] * (double)sun[i][PPS_BACK];
    }
    const float *own[2] = {direct->sources & (PPS_SUN_INDIRECT | PPS_SKY_INDIRECT)
                               ? field->leaf_scattered
                               : NULL,
                           direct->sources & PPS_SKY ? field->leaf_sky : NULL};
    for (size_t k = 0; k < 2 * bands; k++) {
        if (own[k / bands]) {
            const float *at = own[k / bands] + 2 * (i * bands + k % bands);
            front[k % bands] += (double)at[PPS_FRONT];
            back[k % bands] += (double)at[PPS_BACK];
        }
    }
}

/* A leaf may reach through several cells: each of its triangles is lit in four places, the
 * centres of its quarters. Small leaves have all of them in one cell. */
static void light_leaf(const pps_light_field *field, const pps_scene *scene,
                       const pps_cells *cells, const direct_light *direct, size_t i,
                       double *front, double *back) {
    static const double quarter[4][2] = {
        {1 / 6.0, 1 / 6.0}, {4 / 6.0, 1 / 6.0}, {1 / 6.0, 4 / 6.0}, {2 / 6.0, 2 / 6.0}};
    pps_scene_leaf at;
    pps_scene_leaf_at(scene, i, &at);
    const pps_instance *instance = &scene->instance[at.instance];
    const pps_mesh *mesh = scene->prototype[instance->prototype].mesh;
    const pps_leaf *leaf = &mesh->leaf[at.leaf];
    add_own(field, scene, cells, direct, i, front, back);
    for (size_t t = leaf->first; t < leaf->first + leaf->n_triangles; t++) {
        double corner[3][3], a[3], b[3];
        for (int k = 0; k < 3; k++) {
            pps_instance_point(instance, mesh->position[mesh->triangle[t][k]],
                               corner[k]);
        }
        vec_sub(corner[1], corner[0], a);
        vec_sub(corner[2], corner[0], b);
        for (int k = 0; k < 4; k++) {
            double point[3];
            vec_along(corner[0], quarter[k][0], a, point);
            vec_along(point, quarter[k][1], b, point);
            long c = pps_grid_cell(cells, point);
            size_t cell = c >= 0 && cells->area[c] > 0 ? (size_t)c : cells->cell_of[i];
            add_cell(field, scene, cells, direct, at.normal, cell,
                     0.25 / leaf->n_triangles, front, back);
        }
    }
}

pps_status pps_light_field_leaves(const pps_light_field *field, const pps_scene *scene,
                                  const pps_cells *cells, unsigned sources,
                                  pps_irradiance **out) {
    *out = NULL;
    if (!field || !fits(field, field->model, scene, cells) ||
        field->n_directions > 64) {
        return PPS_ERR_ARGUMENT;
    }
    pps_status status = pps_irradiance_create(scene, false, out);
    if (status) {
        return status;
    }
    direct_light direct = {.sources = sources ? sources : PPS_ALL_LIGHT,
                           .n_bands = field->n_bands};
    direct.n_directions =
        direct.sources & PPS_SKY && !field->leaf_sky ? field->n_directions : 0;
    for (int j = 0; j < direct.n_directions; j++) {
        for (int b = 0; b < field->n_bands; b++) {
            direct.radiance[j][b] =
                4 * PI / field->n_directions * pps_sky_part(scene, cells, j, b);
        }
    }
    for (size_t i = 0; i < scene->n_leaves; i++) {
        size_t at = i * (size_t)field->n_bands;
        light_leaf(field, scene, cells, &direct, i, (*out)->front + at,
                   (*out)->back + at);
    }
    return PPS_OK;
}
