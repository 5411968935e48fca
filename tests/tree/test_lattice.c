/* The lattice on made-up cells: a slab as a periodic column against libppscat's exact
 * solution, energy, a ground, single cells, warm starts; no rays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
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
    c->wood = calloc(n, sizeof *c->wood);
    c->both_clear = calloc(n, sizeof *c->both_clear);
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
    free(b->cells.wood);
    free(b->cells.cell_of);
    free(b->cells.n_leaves);
    free(b->cells.n_points);
    free(b->cells.both_clear);
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

/* The same with the slab library's phase function. */
static pps_light_field *solve_isotropic(const box *b,
                                        const pps_light_options *options) {
    pps_light_field *field = solve(b, options);
    pps_lattice_set_isotropic(field->state);
    pps_light_field_forget(field);
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
        pps_light_field *field = solve_isotropic(&b, &plain);
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
            assert_true(sqrt(error / size) < 0.01);
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
    pps_light_field *field = solve_isotropic(&b, &plain);
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

/* A conservative slab over a white ground lets nothing go but through its top: what the
 * ground takes in it gives back, and everything leaves where it came in. */
static void a_white_ground_gives_everything_back(void **state) {
    (void)state;
    enum { NZ = 20, PERIOD = 12, LAYER = PERIOD * PERIOD };
    static const double w[2] = {0.3, 2};
    for (int i = 0; i < 2; i++) {
        box b = box_of(PERIOD, PERIOD, NZ, true, w[i] / NZ);
        set_albedos(&b, 1, (double[]){1});
        b.scene->ground =
            (pps_ground){.present = true, .height = -1, .reflectance = {1}};
        shade_as_slab(&b, w[i]);
        pps_light_field *field = solve(&b, &plain);
        const float *f = field->flux;
        double top = 1.5 * (double)f[3 * LAYER * (NZ - 1) + 2] -
                     0.5 * (double)f[3 * LAYER * (NZ - 2) + 2];
        double bottom = 1.5 * (double)f[2] - 0.5 * (double)f[3 * LAYER + 2];
        assert_close(-top, 1, 0, 0.02);
        assert_close(-bottom, exp(-w[i]), 0, 0.02);
        pps_light_field_free(field);
        box_free(&b);
    }
}

/* Under a ground the exact slab over a Lambertian reflector, its sky included. */
static void sky_and_ground_as_the_exact_slab(void **state) {
    (void)state;
    enum { NZ = 24, PERIOD = 12 };
    double w = 1.5, albedo = 0.8, reflectance = 0.3, sky = 0.2;
    box b = box_of(PERIOD, PERIOD, NZ, true, w / NZ);
    set_albedos(&b, 1, &albedo);
    b.scene->ground =
        (pps_ground){.present = true, .height = 0, .reflectance = {reflectance}};
    b.scene->sky = (pps_sky){.zenith = {sky}, .horizon = {sky}};
    shade_as_slab(&b, w);
    pps_light_options all = {.kappa = 1};
    pps_light_field *field = solve_isotropic(&b, &all);
    pps_model *model;
    pps_slab slab = {albedo, 0, w};
    pps_options options = {.light = {.beam = 1, .sky = sky, .ground = reflectance}};
    pps_model_create(pps_method_find("exact"), &slab, &options, &model);
    pps_model_solve(model, w, 1);
    for (int z = 0; z < NZ; z++) {
        double tau = w * (NZ - z - 0.5) / NZ;
        pps_flux flux;
        pps_model_flux(model, 1, &tau, &flux);
        double from_sky = 0; /* uncollided, which the slab calls diffuse */
        for (int j = 0; j < field->n_directions; j++) {
            if (b.cells.directions.to[j][2] > 0) {
                from_sky +=
                    4 * PI / field->n_directions * sky *
                    (double)field->sky[z * PERIOD * PERIOD * field->n_directions + j];
            }
        }
        assert_close((double)field->diffuse[z * PERIOD * PERIOD] + from_sky,
                     4 * PI * flux.mean_diffuse, 0.03, 0);
    }
    pps_model_free(model);
    pps_light_field_free(field);
    box_free(&b);
}

/* Leaves that reflect only send light back, those that transmit only on. */
static void reflecting_leaves_send_the_sun_back_up(void **state) {
    (void)state;
    enum { NZ = 16, PERIOD = 12, LAYER = PERIOD * PERIOD };
    double up[3], albedo = 0.5;
    for (int k = 0; k < 3; k++) {
        box b = box_of(PERIOD, PERIOD, NZ, true, 1.0 / NZ);
        set_albedos(&b, 1, &albedo);
        pps_leaf_optics *o = &b.scene->prototype[0].optics;
        for (int face = 0; face < 2; face++) {
            o->reflectance[face][0] = albedo * k / 2;
            o->transmittance[face][0] = albedo * (2 - k) / 2;
        }
        shade_as_slab(&b, 1);
        pps_light_field *field = solve(&b, &plain);
        up[k] = -(double)field->flux[3 * LAYER * (NZ - 1) + 2];
        pps_light_field_free(field);
        box_free(&b);
    }
    assert_true(up[2] > 1.3 * up[1] && up[1] > 1.3 * up[0]);
}

/* One cell under a full sun: phi_d = a (1 - e)(v + phi_d), e what escapes of its light. */
static void a_single_cell_keeps_what_does_not_escape(void **state) {
    (void)state;
    static const double albedo[4] = {0.2, 0.6, 0.9, 1};
    box b = box_of(1, 1, 1, false, 0.8);
    set_albedos(&b, 4, albedo);
    b.cells.sun_visibility[0] = 0.7;
    pps_light_field *field = solve_isotropic(&b, &plain);
    double dark =
        (double)field->diffuse[0] / (albedo[0] * (0.7 + (double)field->diffuse[0]));
    assert_true(dark > 0.2 && dark < 0.45);
    for (int k = 1; k < 4; k++) {
        double phi = (double)field->diffuse[k];
        assert_close(phi / (albedo[k] * (0.7 + phi)), dark, 5e-3, 0);
    }
    pps_light_field_free(field);
    box_free(&b);
}

/* A crown-like box: a ball of leaf cells in an empty grid. */
static box ball_of(bool periodic) {
    enum { N = 12 };
    box b = box_of(N, N, N, periodic, 0.2);
    for (int i = 0; i < N * N * N; i++) {
        double x = i % N - 5.5, y = i / N % N - 5.5, z = i / N / N - 5.5;
        double inside = x * x + y * y + z * z < 36;
        b.cells.area[i] *= inside;
        b.cells.n_points[i] = b.cells.n_leaves[i] = inside > 0;
        b.cells.sun_visibility[i] = exp(-0.2 * (5.5 - z));
        for (int j = 0; j < 22; j++) {
            b.cells.visibility[22 * i + j] = 0.4F;
        }
    }
    return b;
}

static void threads_do_not_change_the_answer(void **state) {
    (void)state;
    for (int periodic = 0; periodic < 2; periodic++) {
        box b = ball_of(periodic);
        pps_light_options one = plain, two = plain;
        one.threads = 1;
        two.threads = 2;
        pps_light_field *f1 = solve(&b, &one), *f2 = solve(&b, &two);
        size_t n = b.cells.n_cells;
        assert_memory_equal(f1->diffuse, f2->diffuse, n * sizeof *f1->diffuse);
        assert_memory_equal(f1->flux, f2->flux, 3 * n * sizeof *f1->flux);
        pps_light_field_free(f1);
        pps_light_field_free(f2);
        box_free(&b);
    }
}

static void a_moved_sun_starts_from_the_last_answer(void **state) {
    (void)state;
    box b = ball_of(true);
    pps_light_field *field = solve(&b, &plain);
    const pps_light_model *lattice = pps_light_model_find("lattice");
    int cold = field->sweeps;
    for (size_t i = 0; i < b.cells.n_cells; i++) {
        b.cells.sun_visibility[i] *= 0.97;
    }
    assert_int_equal(pps_light_field_solve(lattice, b.scene, &b.cells, &plain, &field),
                     PPS_OK);
    assert_true(field->sweeps < cold - 1);
    pps_light_field *fresh = solve(&b, &plain);
    for (size_t i = 0; i < b.cells.n_cells; i++) {
        assert_close((double)field->diffuse[i], (double)fresh->diffuse[i], 5e-3, 1e-6);
    }
    pps_light_field_free(fresh);
    pps_light_field_forget(field);
    assert_int_equal(pps_light_field_solve(lattice, b.scene, &b.cells, &plain, &field),
                     PPS_OK);
    assert_int_equal(field->sweeps, cold);
    pps_light_field_free(field);
    box_free(&b);
}

/* Visibilities as the lattice itself has them: nothing clusters. Half as visible: leaves
 * catch more, so kappa rises, and never past its bounds. */
static void the_escape_factor_measures_what_cells_cannot_see(void **state) {
    (void)state;
    box b = ball_of(false);
    pps_lattice *lattice;
    for (int k = 0; k < 3; k++) {
        static const double seen[] = {1, 0.4, 0};
        double kappa;
        for (size_t i = 0; i < 22 * b.cells.n_cells; i++) {
            b.cells.visibility[i] = (float)seen[k];
            b.cells.both_clear[i / 22] = seen[k] * seen[k];
        }
        assert_int_equal(pps_lattice_create(b.scene, &b.cells, 0, 1, &lattice), PPS_OK);
        kappa = pps_lattice_kappa(lattice, 5 * 144 + 5 * 12 + 5);
        assert_true(k == 0   ? kappa == 0.5
                    : k == 1 ? kappa > 0.8 && kappa < 1.3
                             : kappa > 1.3);
        pps_lattice_free(lattice);
        assert_int_equal(pps_lattice_create(b.scene, &b.cells, 1.25, 1, &lattice),
                         PPS_OK);
        assert_close(pps_lattice_kappa(lattice, 5 * 144 + 5 * 12 + 5), 1.25, 1e-7, 0);
        pps_lattice_free(lattice);
    }
    box_free(&b);
}

/* One radiance all around and leaves that do not absorb: it is the same within, whether or
 * not some leaves of a cell are open and others hidden. To 2 %, for escape factors are
 * means over 3^3 cells. */
static void an_enclosure_of_one_radiance_stays_so(void **state) {
    (void)state;
    pps_light_field *field[2];
    box b = ball_of(false);
    pps_light_options sky = {.sources = PPS_SKY | PPS_SKY_INDIRECT};
    set_albedos(&b, 1, (double[]){1});
    b.scene->sky = (pps_sky){.zenith = {1}, .horizon = {1}, .below = {1}};
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < b.cells.n_cells; i++) {
            b.cells.both_clear[i] = k == 0 ? 0.16 : 0.24;
        }
        field[k] = solve(&b, &sky);
    }
    double sum[2] = {0, 0};
    for (size_t i = 0; i < b.cells.n_cells; i++) {
        sum[0] += b.cells.area[i] * (double)field[0]->diffuse[i];
        sum[1] += b.cells.area[i] * (double)field[1]->diffuse[i];
    }
    assert_true(sum[0] > 0);
    assert_close(sum[1], sum[0], 0.02, 0);
    pps_light_field_free(field[0]);
    pps_light_field_free(field[1]);
    box_free(&b);
}

static void the_table_finds_its_models_and_refuses_what_they_lack(void **state) {
    (void)state;
    box b = ball_of(false);
    assert_string_equal(pps_light_model_at(0)->name, "lattice");
    assert_null(pps_light_model_find("latice"));
    assert_null(pps_light_model_at(pps_light_model_count()));
    pps_irradiance *out;
    for (size_t i = 0; i < pps_light_model_count(); i++) {
        const pps_light_model *model = pps_light_model_at(i);
        assert_ptr_equal(pps_light_model_find(model->name), model);
        assert_int_equal(pps_light_model_run(model, b.scene, &b.cells, NULL, &out),
                         PPS_OK);
        for (size_t k = 0; k < b.scene->n_leaves; k++) {
            assert_true(out->front[k] >= 0 && out->back[k] >= 0);
        }
        pps_irradiance_free(out);
        pps_light_options bad = {.compensate = PPS_COMPENSATE_DERIVED};
        assert_int_equal(pps_light_model_run(model, b.scene, &b.cells, &bad, &out),
                         model->compensates ? PPS_OK : PPS_ERR_UNSUPPORTED);
        pps_irradiance_free(out);
        bad = (pps_light_options){.sources = 16};
        assert_int_equal(pps_light_model_run(model, b.scene, &b.cells, &bad, &out),
                         PPS_ERR_ARGUMENT);
        assert_null(out);
    }
    box_free(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_is_the_exact_slab),
        cmocka_unit_test(a_slab_absorbs_what_it_does_not_let_out),
        cmocka_unit_test(a_white_ground_gives_everything_back),
        cmocka_unit_test(sky_and_ground_as_the_exact_slab),
        cmocka_unit_test(reflecting_leaves_send_the_sun_back_up),
        cmocka_unit_test(a_single_cell_keeps_what_does_not_escape),
        cmocka_unit_test(threads_do_not_change_the_answer),
        cmocka_unit_test(a_moved_sun_starts_from_the_last_answer),
        cmocka_unit_test(the_escape_factor_measures_what_cells_cannot_see),
        cmocka_unit_test(an_enclosure_of_one_radiance_stays_so),
        cmocka_unit_test(the_table_finds_its_models_and_refuses_what_they_lack),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
