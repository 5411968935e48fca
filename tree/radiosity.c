/* Light from leaf to leaf: elements, their rays, and the rounds that carry light along.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/radiosity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/anderson.h"
#include "tree/bounce.h"
#include "tree/grid.h"
#include "tree/leafpoint.h"
#include "tree/rays.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double GOLDEN = 0.6180339887498949;

/* Points of a leaf, fewer where there are many leaves; elements of a leaf. */
enum { POINTS_MAX = 64, POINTS_MIN = 8, PARTS_MAX = 64, ROUNDS_MAX = 200 };
static const size_t POINTS = 1 << 22, ELEMENTS = 1 << 21;

/* What a ray meets: 2 * element + face, or one of these, with more in the low bits. */
#define NOT_A_LEAF 0x80000000U
#define SKY NOT_A_LEAF      /* and the height it goes to, of HEIGHTS */
#define GROUND 0xC0000000U  /* and the column of cells */
#define NOTHING 0xFFFFFFFFU /* wood, or the dark */
#define LOW_BITS 0x3FFFFFFFU
static const double HEIGHTS = 1 << 24;

struct pps_radiosity {
    const pps_scene *scene;
    pps_rays *rays;
    size_t n_leaves, n_points, n_elements; /* n_points: of a leaf */
    int threads;
    bool fresh;       /* no answer yet */
    double sun_to[3]; /* that `sun` is for; 0: none */
    uint8_t *rows;    /* [leaf]: a triangle is cut into rows^2 elements; 0: none is, and
                         the leaf is one element */
    size_t *first;    /* [leaf]: its first element */
    uint32_t *element;  /* [leaf * n_points + point] */
    uint32_t *meets[2]; /* [face][leaf * n_points + point] */
    float *sun;    /* [leaf * n_points + point]: cosine to the sun where it is seen,
                             < 0: by the back */
    float *share;  /* [element]: its share of the leaf's points */
    float *weight; /* [2 * element + face]: its area */
    float (*leaf_sun)[2], *scattered, *sky;   /* for the field */
    pps_bands *state, *image, *direct, *sent; /* [2 * element + face] */
    pps_anderson anderson;
};

void pps_radiosity_free(pps_radiosity *r) {
    if (r) {
        pps_rays_free(r->rays);
        pps_anderson_clear(&r->anderson);
        free(r->rows);
        free(r->first);
        free(r->element);
        free(r->sun);
        free(r->share);
        free(r->weight);
        free(r->leaf_sun);
        free(r->scattered);
        free(r->state);
        free(r);
    }
}

void pps_radiosity_forget(pps_radiosity *r) { r->fresh = true; }

/* ---- elements ---- */

/* Light varies over the size of the leaves that cast it, and over a mean free path: a
 * triangle longer than that is cut into 16, others into 4. */
static unsigned rows_of(const pps_cells *cells, size_t cell, const pps_leaf *leaf,
                        double area) {
    double path = 2 * pow(cells->size, 3) / fmax(cells->area[cell], 1e-300);
    unsigned rows = sqrt(2 * area / leaf->n_triangles) > path ? 4 : 2;
    while (rows > 0 && rows * rows * leaf->n_triangles > PARTS_MAX) {
        rows /= 2;
    }
    return rows;
}

static size_t parts_of(const pps_leaf *leaf, unsigned rows) {
    return rows > 0 ? (size_t)rows * rows * leaf->n_triangles : 1;
}

/* Cut the leaves; as they are, if that makes too many. */
static void cut_leaves(pps_radiosity *r, const pps_cells *cells) {
    for (bool whole = false;; whole = true) {
        r->n_elements = 0;
        for (size_t i = 0; i < r->n_leaves; i++) {
            pps_scene_leaf at;
            pps_scene_leaf_at(r->scene, i, &at);
            const pps_instance *instance = &r->scene->instance[at.instance];
            const pps_leaf *leaf =
                &r->scene->prototype[instance->prototype].mesh->leaf[at.leaf];
            unsigned rows =
                whole ? 0 : rows_of(cells, cells->cell_of[i], leaf, at.area);
            r->rows[i] = (uint8_t)rows;
            r->first[i] = r->n_elements;
            r->n_elements += parts_of(leaf, rows);
        }
        if (whole || r->n_elements <= ELEMENTS) {
            return;
        }
    }
}

/* The element of a point on a triangle (of the mesh): strips along b - a, in each of which
 * small triangles alternate. */
static uint32_t element_at(const pps_radiosity *r, size_t leaf, size_t instance,
                           uint32_t triangle, double u, double v) {
    int n = r->rows[leaf];
    if (n == 0) {
        return (uint32_t)r->first[leaf];
    }
    const pps_instance *at = &r->scene->instance[instance];
    const pps_mesh *mesh = r->scene->prototype[at->prototype].mesh;
    uint32_t own = mesh->leaf[leaf - r->scene->first_leaf[instance]].first;
    int i = (int)fmin(u * n, n - 1), j = (int)fmin(v * n, n - 1 - i);
    bool upper = u * n - i + v * n - j > 1 && j < n - 1 - i;
    return (uint32_t)(r->first[leaf] + (size_t)(triangle - own) * (size_t)(n * n) +
                      (size_t)(i * (2 * n - i) + 2 * j + upper));
}

/* ---- rays ---- */

static uint32_t column_at(const pps_cells *cells, const double at[3]) {
    long column = 0;
    for (int axis = 1; axis >= 0; axis--) {
        double n = cells->n[axis],
               k = floor((at[axis] - cells->low[axis]) / cells->size);
        if (cells->periodic) {
            k -= n * floor(k / n);
        }
        if (!(k >= 0 && k < n)) {
            return (uint32_t)(cells->n[0] * cells->n[1]); /* beside the grid */
        }
        column = column * cells->n[axis] + (long)k;
    }
    return (uint32_t)column;
}

static uint32_t look(const pps_radiosity *r, const pps_cells *cells,
                     const pps_leaf_point *from, double side, double u, double v) {
    double to[3], at[3];
    pps_hit hit;
    pps_bounce_lambert(from->normal, side, u, v, to);
    pps_line line = pps_rays_leave(r->rays, from->point, from->normal, to);
    bool ground = pps_bounce_ground(r->scene, &line);
    if (pps_rays_nearest(r->rays, &line, &hit)) {
        return hit.leaf == SIZE_MAX ? NOTHING
                                    : 2 * element_at(r, hit.leaf, hit.instance,
                                                     hit.triangle, hit.u, hit.v) +
                                          (hit.front ? PPS_FRONT : PPS_BACK);
    }
    if (ground) {
        vec_along(line.origin, line.far, line.direction, at);
        return GROUND | column_at(cells, at);
    }
    return r->scene->ground.present && to[2] < 0
               ? NOTHING
               : SKY | (uint32_t)((to[2] + 1) / 2 * (HEIGHTS - 1));
}

/* Rays of a leaf: on each face a stratified set of directions, turned at random. */
static void look_around(pps_radiosity *r, const pps_cells *cells, size_t leaf) {
    size_t n = r->n_points;
    pps_uniforms turn = pps_random(0, PPS_RANDOM_RADIOSITY, leaf, 0);
    for (size_t k = 0; k < n; k++) {
        size_t at = leaf * n + k;
        pps_leaf_point p;
        pps_leaf_point_spread(r->scene, leaf, 0, PPS_RANDOM_RADIOSITY, k, &p);
        r->element[at] = element_at(r, leaf, p.instance, p.triangle, p.u, p.v);
        r->share[r->element[at]] += 1 / (float)n;
        for (int face = 0; face < 2; face++) {
            double u = turn.u[2 * face] + ((double)k + 0.5) / (double)n;
            double v = turn.u[2 * face + 1] + (double)k * GOLDEN;
            r->meets[face][at] = look(r, cells, &p, face == PPS_FRONT ? 1 : -1,
                                      u - floor(u), v - floor(v));
        }
    }
}

static void look_at_sun(pps_radiosity *r, size_t leaf, const double to[3]) {
    double face[2] = {0, 0};
    for (size_t k = 0; k < r->n_points; k++) {
        pps_leaf_point p;
        pps_leaf_point_spread(r->scene, leaf, 0, PPS_RANDOM_RADIOSITY, k, &p);
        pps_line line = pps_rays_leave(r->rays, p.point, p.normal, to);
        double cosine = pps_rays_occluded(r->rays, &line) ? 0 : vec_dot(p.normal, to);
        r->sun[leaf * r->n_points + k] = (float)cosine;
        face[cosine < 0] += fabs(cosine) / (double)r->n_points;
    }
    r->leaf_sun[leaf][PPS_FRONT] = (float)face[PPS_FRONT];
    r->leaf_sun[leaf][PPS_BACK] = (float)face[PPS_BACK];
}

static void set_sun(pps_radiosity *r, const double to[3]) {
    if (memcmp(r->sun_to, to, sizeof r->sun_to) == 0) {
        return;
    }
#pragma omp parallel for num_threads(r->threads) schedule(dynamic, 64)
    for (size_t leaf = 0; leaf < r->n_leaves; leaf++) {
        look_at_sun(r, leaf, to);
    }
    memcpy(r->sun_to, to, sizeof r->sun_to);
}

/* ---- the static part ---- */

static pps_status allocate_leaves(pps_radiosity *r) {
    size_t n = r->n_leaves, points = n * r->n_points;
    r->rows = calloc(n + 1, sizeof *r->rows);
    r->first = calloc(n + 1, sizeof *r->first);
    r->element = malloc((3 * points + 1) * sizeof *r->element);
    r->sun = calloc(points + 1, sizeof *r->sun);
    r->leaf_sun = calloc(n + 1, sizeof *r->leaf_sun);
    size_t faces = 2 * n * (size_t)r->scene->n_bands;
    r->scattered = malloc((2 * faces + 1) * sizeof *r->scattered);
    if (!r->rows || !r->first || !r->element || !r->sun || !r->leaf_sun ||
        !r->scattered) {
        return PPS_ERR_MEMORY;
    }
    r->sky = r->scattered + faces;
    r->meets[PPS_FRONT] = r->element + points;
    r->meets[PPS_BACK] = r->element + 2 * points;
    return PPS_OK;
}

static pps_status allocate_elements(pps_radiosity *r) {
    size_t n = 2 * r->n_elements;
    r->share = calloc(r->n_elements + 1, sizeof *r->share);
    r->weight = calloc(n + 1, sizeof *r->weight);
    r->state = aligned_alloc(sizeof(pps_bands), (4 * n + 1) * sizeof *r->state);
    if (!r->share || !r->weight || !r->state) {
        return PPS_ERR_MEMORY;
    }
    memset(r->state, 0, (4 * n + 1) * sizeof *r->state);
    r->image = r->state + n;
    r->direct = r->image + n;
    r->sent = r->direct + n;
    return pps_anderson_init(&r->anderson, n, n);
}

static void set_weights(pps_radiosity *r) {
    for (size_t i = 0; i < r->n_leaves; i++) {
        pps_scene_leaf at;
        pps_scene_leaf_at(r->scene, i, &at);
        for (size_t k = 0; k < r->n_points; k++) {
            size_t e = r->element[i * r->n_points + k];
            r->weight[2 * e] = r->weight[2 * e + 1] = (float)at.area * r->share[e];
        }
    }
}

pps_status pps_radiosity_create(const pps_scene *scene, const pps_cells *cells,
                                int threads, pps_radiosity **out) {
    *out = NULL;
    pps_radiosity *r = calloc(1, sizeof *r);
    if (!r) {
        return PPS_ERR_MEMORY;
    }
    r->scene = scene;
    r->n_leaves = scene->n_leaves;
    r->threads = pps_thread_count(threads);
    r->fresh = true;
    r->n_points = POINTS / (r->n_leaves + 1);
    r->n_points = r->n_points > POINTS_MAX   ? POINTS_MAX
                  : r->n_points < POINTS_MIN ? POINTS_MIN
                                             : r->n_points;
    pps_status status = pps_rays_create(scene, &r->rays);
    status = status ? status : allocate_leaves(r);
    if (!status) {
        cut_leaves(r, cells);
        status = allocate_elements(r);
    }
    if (status) {
        pps_radiosity_free(r);
        return status;
    }
#pragma omp parallel for num_threads(r->threads) schedule(dynamic, 64)
    for (size_t leaf = 0; leaf < r->n_leaves; leaf++) {
        look_around(r, cells, leaf);
    }
    set_weights(r);
    *out = r;
    return PPS_OK;
}

/* ---- light ---- */

/* The optics of a leaf's prototype. */
typedef struct {
    pps_bands reflectance[2], transmittance[2];
} optics;

static optics optics_of(const pps_scene *scene, size_t instance) {
    const pps_leaf_optics *o =
        &scene->prototype[scene->instance[instance].prototype].optics;
    optics out = {0};
    for (int face = 0; face < 2; face++) {
        for (int b = 0; b < scene->n_bands; b++) {
            out.reflectance[face][b] = (float)o->reflectance[face][b];
            out.transmittance[face][b] = (float)o->transmittance[face][b];
        }
    }
    return out;
}

static size_t end_of(const pps_radiosity *r, size_t leaf) {
    return leaf + 1 < r->n_leaves ? r->first[leaf + 1] : r->n_elements;
}

/* Divide an element's sum by its points; one without points has the leaf's mean. */
static void average(const pps_radiosity *r, size_t leaf, pps_bands *sum,
                    const pps_bands mean[2]) {
    for (size_t e = r->first[leaf]; e < end_of(r, leaf); e++) {
        float points = r->share[e] * (float)r->n_points;
        for (int face = 0; face < 2; face++) {
            sum[2 * e + (size_t)face] =
                points > 0.5F ? sum[2 * e + (size_t)face] / points : mean[face];
        }
    }
}

/* What the sky brings along a ray. */
static pps_bands sky_along(const pps_scene *scene, uint32_t met) {
    pps_bands e = {0};
    if (met >= SKY && met < GROUND) {
        double z = 2 * (met & LOW_BITS) / (HEIGHTS - 1) - 1;
        for (int b = 0; b < scene->n_bands; b++) {
            e[b] = (float)(PI * pps_sky_radiance(&scene->sky, b, z));
        }
    }
    return e;
}

/* The light of sun and sky on a leaf, and on its elements what of it is to be scattered. */
static void light_elements(pps_radiosity *r, const pps_lit_scene *lit, size_t leaf) {
    const pps_scene *scene = lit->scene;
    bool sky = lit->options.sources & PPS_SKY_INDIRECT;
    pps_bands mean[2] = {{0}, {0}}, irradiance = {0}, sky_mean[2] = {{0}, {0}};
    size_t bands = (size_t)scene->n_bands;
    for (size_t b = 0; b < bands && lit->options.sources & PPS_SUN_INDIRECT; b++) {
        irradiance[b] = (float)scene->sun.irradiance[b];
    }
    memset(r->direct + 2 * r->first[leaf], 0,
           2 * (end_of(r, leaf) - r->first[leaf]) * sizeof *r->direct);
    for (size_t k = leaf * r->n_points; k < (leaf + 1) * r->n_points; k++) {
        for (size_t face = 0; face < 2; face++) {
            float cosine = fmaxf(face == PPS_FRONT ? r->sun[k] : -r->sun[k], 0);
            pps_bands above = sky_along(scene, r->meets[face][k]);
            pps_bands e = cosine * irradiance + (sky ? above : pps_bands_all(0));
            r->direct[2 * (size_t)r->element[k] + face] += e;
            mean[face] += e / (float)r->n_points;
            sky_mean[face] += above / (float)r->n_points;
        }
    }
    average(r, leaf, r->direct, mean);
    for (size_t b = 0; b < bands; b++) {
        r->sky[2 * (leaf * bands + b) + PPS_FRONT] = sky_mean[PPS_FRONT][b];
        r->sky[2 * (leaf * bands + b) + PPS_BACK] = sky_mean[PPS_BACK][b];
    }
}

/* The first guess: the cells' light. */
static void take_cells(pps_radiosity *r, const pps_cells *cells,
                       const pps_light_field *field, size_t leaf) {
    pps_scene_leaf at;
    pps_scene_leaf_at(r->scene, leaf, &at);
    size_t bands = (size_t)field->n_bands, c = cells->cell_of[leaf];
    for (size_t e = 2 * r->first[leaf]; e < 2 * end_of(r, leaf); e++) {
        double side = e % 2 == PPS_FRONT ? 0.5 : -0.5;
        for (size_t b = 0; b < bands; b++) {
            const float *flux = &field->flux[3 * (c * bands + b)];
            double odd = at.normal[0] * (double)flux[0] +
                         at.normal[1] * (double)flux[1] +
                         at.normal[2] * (double)flux[2];
            double even = (double)field->diffuse[c * bands + b] / 4;
            r->state[e][b] = (float)fmax(even + side * odd, 0);
        }
    }
}

/* What the elements send out, of direct and scattered light. */
static void send(pps_radiosity *r, const pps_scene *scene, size_t leaf) {
    pps_scene_leaf at;
    pps_scene_leaf_at(scene, leaf, &at);
    optics o = optics_of(scene, at.instance);
    for (size_t e = r->first[leaf]; e < end_of(r, leaf); e++) {
        pps_bands front = r->direct[2 * e] + r->state[2 * e];
        pps_bands back = r->direct[2 * e + 1] + r->state[2 * e + 1];
        r->sent[2 * e] = o.reflectance[0] * front + o.transmittance[1] * back;
        r->sent[2 * e + 1] = o.reflectance[1] * back + o.transmittance[0] * front;
    }
}

/* What comes back along a leaf's rays, to its elements; `mean`: to its faces. */
static void receive(pps_radiosity *r, const pps_bands *ground, size_t leaf,
                    pps_bands mean[2]) {
    mean[0] = mean[1] = pps_bands_all(0);
    memset(r->image + 2 * r->first[leaf], 0,
           2 * (end_of(r, leaf) - r->first[leaf]) * sizeof *r->image);
    for (size_t face = 0; face < 2; face++) {
        for (size_t k = leaf * r->n_points; k < (leaf + 1) * r->n_points; k++) {
            uint32_t met = r->meets[face][k];
            pps_bands e = met < NOT_A_LEAF                  ? r->sent[met]
                          : met >= GROUND && met != NOTHING ? ground[met & LOW_BITS] / 4
                                                            : pps_bands_all(0);
            r->image[2 * (size_t)r->element[k] + face] += e;
            mean[face] += e;
        }
        mean[face] /= (float)r->n_points;
    }
    average(r, leaf, r->image, mean);
}

static void start(pps_radiosity *r, const pps_lit_scene *lit,
                  const pps_light_field *field) {
#pragma omp parallel for num_threads(r->threads) schedule(static)
    for (size_t leaf = 0; leaf < r->n_leaves; leaf++) {
        light_elements(r, lit, leaf);
        if (r->fresh) {
            take_cells(r, lit->cells, field, leaf);
        }
    }
    r->fresh = false;
}

/* Carry light once along all rays; the last time it is the leaves' answer. */
static void carry(pps_radiosity *r, const pps_lit_scene *lit, const pps_bands *ground,
                  bool last) {
    size_t bands = (size_t)lit->scene->n_bands;
#pragma omp parallel num_threads(r->threads)
    {
#pragma omp for schedule(static)
        for (size_t leaf = 0; leaf < r->n_leaves; leaf++) {
            send(r, lit->scene, leaf);
        }
#pragma omp for schedule(static)
        for (size_t leaf = 0; leaf < r->n_leaves; leaf++) {
            pps_bands mean[2];
            receive(r, ground, leaf, mean);
            for (size_t b = 0; b < bands && last; b++) {
                float *out = &r->scattered[2 * (leaf * bands + b)];
                out[PPS_FRONT] = mean[PPS_FRONT][b];
                out[PPS_BACK] = mean[PPS_BACK][b];
            }
        }
    }
}

pps_status pps_radiosity_solve(pps_radiosity *r, const pps_lit_scene *lit,
                               const pps_bands *ground, double tolerance,
                               pps_light_field *field) {
    double change = (double)INFINITY;
    set_sun(r, lit->scene->sun.to);
    start(r, lit, field);
    pps_anderson_restart(&r->anderson);
    for (int rounds = 0; change > tolerance; rounds++) {
        if (rounds == ROUNDS_MAX) {
            return PPS_ERR_CONVERGENCE;
        }
        carry(r, lit, ground, false);
        change = pps_anderson_step(&r->anderson, r->weight, r->state, r->image);
    }
    carry(r, lit, ground, true);
    field->leaf_scattered = r->scattered;
    field->leaf_sky = r->sky;
    field->leaf_sun = (const float(*)[2])r->leaf_sun;
    return PPS_OK;
}
