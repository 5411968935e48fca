/* The lattice on made-up cells: a slab as a periodic column against libppscat's exact
 * solution, energy, a ground, single cells, warm starts; no rays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/method.h>
#include <ppscat/tree/field.h>
#include <ppscat/tree/grow.h>

#include "support/support.h"
#include "tree/lattice.h"

static const double PI = 3.14159265358979323846;

/* A box of n cells of optical depth `depth` each, every one with one leaf. */
typedef struct {
    pps_scene *scene;
    pps_cells cells;
} box;

static box box_of(int nx, int ny, int nz, bool periodic, double depth) {
    box made = {.cells = {.n = {nx, ny, nz},
                          .size = 0.5,
                          .periodic = periodic,
                          .directions = pps_directions_22()}};
    pps_cells *c = &made.cells;
    c->n_cells = (size_t)nx * (size_t)ny * (size_t)nz;
    size_t n = c->n_cells, n_directions = (size_t)c->directions.n;
    pps_crown crown = {.leaf_area_index = 1, .n_leaves = (uint32_t)n, .seed = 1};
    pps_mesh *mesh;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    assert_int_equal(pps_scene_single(mesh, 0.95, &made.scene), PPS_OK);
    c->area = malloc(n * sizeof *c->area);
    c->cell_of = malloc(n * sizeof *c->cell_of);
    c->n_leaves = malloc(n * sizeof *c->n_leaves);
    c->n_points = malloc(n * sizeof *c->n_points);
    c->sun_depth = calloc(4 * n, sizeof *c->sun_depth);
    c->sun_behind = c->sun_depth + n;
    c->sun_visibility = c->sun_behind + n;
    c->sun_clear = c->sun_visibility + n;
    c->depth = calloc(2 * n * n_directions, sizeof *c->depth);
    c->visibility = c->depth + n * n_directions;
    for (size_t i = 0; i < n; i++) {
        c->area[i] = 2 * depth * c->size * c->size;
        c->cell_of[i] = (uint32_t)i;
        c->n_leaves[i] = 1;
        c->n_points[i] = 1;
    }
    return made;
}

static void box_free(box *b) {
    free(b->cells.area);
    free(b->cells.cell_of);
    free(b->cells.n_leaves);
    free(b->cells.n_points);
    free(b->cells.sun_depth);
    free(b->cells.depth);
    pps_scene_free(b->scene);
}

static double decay_mean(double x) { return x > 0 ? -expm1(-x) / x : 1; }

/* Sun and directions as a slab of this optical thickness sees them, means over cells. */
static void shade_as_slab(box *b, double w) {
    pps_cells *c = &b->cells;
    int per_layer = c->n[0] * c->n[1], n_directions = c->directions.n;
    double thin = w / c->n[2];
    for (size_t i = 0; i < c->n_cells; i++) {
        double above = thin * (c->n[2] - 1 - (int)i / per_layer);
        double below = thin * ((int)i / per_layer);
        double mu0 = b->scene->sun.to[2];
        c->sun_visibility[i] = exp(-above / mu0) * decay_mean(thin / mu0);
        c->sun_clear[i] = exp(-below / mu0) * decay_mean(thin / mu0);
        for (int j = 0; j < n_directions; j++) {
            double z = c->directions.to[j][2];
            double path = z > 0 ? above / z : below / -z;
            c->visibility[i * (size_t)n_directions + (size_t)j] =
                (float)(exp(-path) * decay_mean(thin / fabs(z)));
        }
    }
}

static pps_light_field *solve(const box *b, const pps_light_options *options) {
    pps_light_field *field = NULL;
    assert_int_equal(pps_light_field_solve(pps_light_model_find("lattice"), b->scene,
                                           &b->cells, options, &field),
                     PPS_OK);
    return field;
}

/* kappa = 1: these boxes have no leaves that could cluster. */
static const pps_light_options plain = {.kappa = 1,
                                        .sources = PPS_SUN | PPS_SUN_INDIRECT};

static void set_albedos(box *b, int n_bands, const double *albedo) {
    b->scene->n_bands = n_bands;
    for (int k = 0; k < n_bands; k++) {
        b->scene->sun.irradiance[k] = 1;
        for (int face = 0; face < 2; face++) {
            b->scene->prototype[0].optics.reflectance[face][k] = albedo[k] / 2;
            b->scene->prototype[0].optics.transmittance[face][k] = albedo[k] / 2;
        }
    }
    assert_int_equal(pps_scene_index(b->scene), PPS_OK);
}

static void a_column_is_the_exact_slab(void **state) {
    (void)state;
    static const double albedo[4] = {0.3, 0.8, 0.95, 0}, mu0s[] = {1, 0.6};
    enum { NZ = 24, PERIOD = 16 };
    for (int i = 0; i < 8; i++) {
        double w = 0.5 * (1 << i / 2), mu0 = mu0s[i % 2];
        box b = box_of(PERIOD, PERIOD, NZ, true, w / NZ);
        set_albedos(&b, 4, albedo);
        memcpy(b.scene->sun.to, (double[]){sqrt(1 - mu0 * mu0), 0, mu0},
               sizeof b.scene->sun.to);
        shade_as_slab(&b, w);
        pps_light_field *field = solve(&b, &plain);
        for (int k = 0; k < 3; k++) {
            pps_model *model;
            pps_slab slab = {albedo[k], 0, w};
            pps_model_create(pps_method_find("exact"), &slab, NULL, &model);
            pps_model_solve(model, w, mu0);
            double error = 0, size = 0, net = 0;
            for (int z = 0; z < NZ; z++) {
                double tau = w * (NZ - z - 0.5) / NZ;
                pps_flux flux;
                pps_model_flux(model, 1, &tau, &flux);
                size_t at = (size_t)(4 * z * PERIOD * PERIOD + k);
                error +=
                    pow((double)field->diffuse[at] - 4 * PI * flux.mean_diffuse, 2);
                size += pow(4 * PI * flux.mean, 2);
                net = fmax(
                    net, fabs((double)field->flux[3 * at + 2] - (flux.down - flux.up)));
            }
            if(getenv("DBG")) printf("w %g mu0 %g albedo %g: rms %.4f net %.4f sweeps %d\n", w, mu0, albedo[k], sqrt(error/size), net, field->sweeps);
            assert_true(sqrt(error / size) < 0.03);
            assert_close(net, 0, 0, 0.01);
            pps_model_free(model);
        }
        assert_close((double)field->diffuse[3], 0, 0, 0); /* albedo 0 */
        pps_light_field_free(field);
        box_free(&b);
    }
}

/* What leaves absorb and what leaves the slab, which is what falls in less the direct
 * light that passes, by the lattice's own net flux at its two faces. */
static void a_slab_absorbs_what_it_does_not_let_out(void **state) {
    (void)state;
    static const double albedo[4] = {0.5, 0.9, 0.99, 1};
    enum { NZ = 40, PERIOD = 16, LAYER = 4 * PERIOD * PERIOD };
    double w = 3;
    box b = box_of(PERIOD, PERIOD, NZ, true, w / NZ);
    set_albedos(&b, 4, albedo);
    shade_as_slab(&b, w);
    pps_light_field *field = solve(&b, &plain);
    for (int k = 0; k < 4; k++) {
        double absorbed = 0;
        for (int z = 0; z < NZ; z++) {
            double phi = (double)field->diffuse[LAYER * z + k] +
                         b.cells.sun_visibility[LAYER / 4 * z];
            absorbed += w / NZ * (1 - albedo[k]) * phi;
        }
        pps_model *model;
        pps_slab slab = {albedo[k], 0, w};
        double tau[2] = {0, w};
        pps_flux flux[2];
        pps_model_create(pps_method_find("exact"), &slab, NULL, &model);
        pps_model_solve(model, w, 1);
        pps_model_flux(model, 2, tau, flux);
        double kept = 1 - flux[0].up - flux[1].down - flux[1].direct;
        assert_close(absorbed, kept, 0, 0.005);
        /* Cell centres are half a cell inside: extrapolate the net flux to the faces. */
        const float *f = field->flux;
        double top = 1.5 * (double)f[3 * (LAYER * (NZ - 1) + k) + 2] -
                     0.5 * (double)f[3 * (LAYER * (NZ - 2) + k) + 2];
        double bottom =
            1.5 * (double)f[3 * k + 2] - 0.5 * (double)f[3 * (LAYER + k) + 2];
        double scattered_in = -expm1(-w);
        assert_close(absorbed, scattered_in - (bottom - top), 0, 0.004);
        pps_model_free(model);
    }
    pps_light_field_free(field);
    box_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_is_the_exact_slab),
        cmocka_unit_test(a_slab_absorbs_what_it_does_not_let_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
