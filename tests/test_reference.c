/* The true problem, against tables computed by methods that share nothing with discrete
 * ordinates (data/reference; each file says how).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/dom.h>

#include "support/support.h"

enum { STREAMS = 128 };

static pps_dom *create(double albedo, double g, double w, int streams, int orders) {
    pps_slab slab = {albedo, g, w};
    pps_dom_opts opts = {.streams = streams, .orders = orders};
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&slab, &opts, &dom), PPS_OK);
    return dom;
}

/* Columns: w, omega, mu0, R, Tdif, Tdir. Good to 17 digits. */
static void isotropic_fluxes_to_13_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_isotropic_flux.csv");
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        double w = row[0], mu0 = row[2], tau[2] = {0, w};
        pps_dom *dom = create(row[1], 0, w, STREAMS, 1);
        pps_flux flux[2];
        assert_int_equal(pps_dom_solve(dom, mu0), PPS_OK);
        assert_int_equal(pps_dom_flux(dom, 2, tau, flux), PPS_OK);
        assert_close(flux[0].up / mu0, row[3], 1e-13, 0);
        assert_close(flux[1].down / mu0, row[4], 1e-13, 0);
        assert_close(flux[1].direct / mu0, row[5], 1e-14, 0);
        pps_dom_free(dom);
    }
    support_table_free(&t);
}

/* Columns: g, omega, w, mu0, R, Tdif, Tdir, Umid, Dmid, .. Good to 12 digits. */
static void anisotropic_fluxes_to_12_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_hg_flux.csv");
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        double w = row[2], mu0 = row[3], tau[3] = {0, w / 2, w};
        pps_dom *dom = create(row[1], row[0], w, STREAMS, 1);
        pps_flux flux[3];
        assert_int_equal(pps_dom_solve(dom, mu0), PPS_OK);
        assert_int_equal(pps_dom_flux(dom, 3, tau, flux), PPS_OK);
        assert_close(flux[0].up / mu0, row[4], 1e-12, 0);
        assert_close(flux[2].down / mu0, row[5], 1e-12, 0);
        assert_close(flux[1].up / mu0, row[7], 1e-12, 0);
        assert_close(flux[1].down / mu0, row[8], 1e-12, 0);
        pps_dom_free(dom);
    }
    support_table_free(&t);
}

/* Columns: g, omega, w, mu0, mu, phi, top up, bottom down, mid up, mid down. */
static void radiances_to_12_digits(void **state) {
    (void)state;
    support_table t = support_read("slab_hg_radiance.csv");
    pps_dom *dom = NULL;
    const double *last = NULL;
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        double w = row[2], tau[3] = {0, w / 2, w}, mu[2] = {-row[4], row[4]};
        if (!last || row[0] != last[0] || row[1] != last[1]) {
            pps_dom_free(dom);
            dom = create(row[1], row[0], w, STREAMS, 0);
        }
        assert_int_equal(pps_dom_set_thickness(dom, w), PPS_OK);
        assert_int_equal(pps_dom_solve(dom, row[3]), PPS_OK);
        pps_grid at = {3, 2, 1, tau, mu, &row[5]};
        double radiance[6];
        assert_int_equal(pps_dom_radiance(dom, &at, radiance), PPS_OK);
        assert_close(radiance[0], row[6], 1e-12, 0);
        assert_close(radiance[5], row[7], 1e-12, 0);
        assert_close(radiance[2], row[8], 1e-12, 0);
        assert_close(radiance[3], row[9], 1e-12, 0);
        last = row;
    }
    pps_dom_free(dom);
    support_table_free(&t);
}

/* Columns: omega, mu, H, plane albedo, pi I(0, -mu)/mu at mu0 = mu. */
static void half_space_follows_the_h_function(void **state) {
    (void)state;
    support_table t = support_read("hfunction_isotropic.csv");
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        double mu0 = row[1], mu = -mu0, tau = 0, phi = 0, radiance;
        if (mu0 < 0.001) {
            continue;
        }
        pps_dom *dom = create(row[0], 0, (double)INFINITY, STREAMS, 1);
        pps_flux flux;
        assert_int_equal(pps_dom_solve(dom, mu0), PPS_OK);
        assert_int_equal(pps_dom_flux(dom, 1, &tau, &flux), PPS_OK);
        assert_close(flux.up / mu0, row[3], 1e-13, 0);
        pps_grid at = {1, 1, 1, &tau, &mu, &phi};
        assert_int_equal(pps_dom_radiance(dom, &at, &radiance), PPS_OK);
        assert_close(3.14159265358979323846 * radiance / mu0, row[4], 1e-13, 0);
        pps_dom_free(dom);
    }
    support_table_free(&t);
}

/* Columns: g, omega, k, 1 - k, .. Where k < 0.99; nearer to 1 it merges with the
 * continuous spectrum, which no finite number of nodes separates. */
static void diffusion_exponents_to_10_digits(void **state) {
    (void)state;
    support_table t = support_read("diffusion_exponent.csv");
    int checked = 0;
    for (size_t i = 0; i < t.n_rows; i++) {
        const double *row = t.value + i * t.n_columns;
        if (!(row[2] < 0.99)) {
            continue;
        }
        pps_dom *dom = create(row[1], row[0], 10, 2 * STREAMS, 1);
        pps_dom_info info;
        pps_dom_query(dom, &info);
        assert_close(info.diffusion_exponent, row[2], 1e-10, 0);
        pps_dom_free(dom);
        checked++;
    }
    assert_true(checked > 50);
    support_table_free(&t);
}

/* Conservative thick slabs: T of isotropic illumination is 4/3 / ((1-g) w + 2 q'), and
 * the beam sees (1 + ..)/..: the product of escape functions; here by the ratio of two
 * thicknesses, 1/T linear in w with slope 3 (1-g)/(4 f(mu0)). */
static void
conservative_transmission_falls_as_the_extrapolated_thickness(void **state) {
    (void)state;
    static const struct {
        double g, q;
    } cases[] = {{0, 0.7104460896},
                 {0.5, 0.7119556672},
                 {-0.5, 0.7140753875},
                 {0.75, 0.7133632908}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double g = cases[i].g, tau, inverse[2];
        for (int j = 0; j < 2; j++) {
            double w = j ? 400 : 200;
            pps_dom *dom = create(1, g, w, STREAMS, 1);
            pps_flux flux;
            tau = w;
            assert_int_equal(pps_dom_solve(dom, 0.7), PPS_OK);
            assert_int_equal(pps_dom_flux(dom, 1, &tau, &flux), PPS_OK);
            inverse[j] = 1 / flux.down;
            pps_dom_free(dom);
        }
        /* 1/T = slope ((1-g) w + 2 q'): q' from two thicknesses. */
        double slope = (inverse[1] - inverse[0]) / (200 * (1 - g));
        double q = (inverse[0] / slope - (1 - g) * 200) / 2;
        assert_close(q, cases[i].q, 0, 1e-9);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_fluxes_to_13_digits),
        cmocka_unit_test(anisotropic_fluxes_to_12_digits),
        cmocka_unit_test(radiances_to_12_digits),
        cmocka_unit_test(half_space_follows_the_h_function),
        cmocka_unit_test(diffusion_exponents_to_10_digits),
        cmocka_unit_test(conservative_transmission_falls_as_the_extrapolated_thickness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
