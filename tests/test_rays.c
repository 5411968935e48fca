/* The vector loops of the solver against the scalar form of core/mode.h, mode by mode and
 * ray by ray; and beams together against beams alone, to the last bit.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/expdiff.h>
#include <ppscat/phase.h>

#include "core/vector.h"
#include "solver/dom.h"

enum { MOST_DEPTHS = 8, N_PHI = 3, STREAMS = 16, N = STREAMS / 2 };
static const double mus[] = {1e-3, 0.03, 0.11, 0.25, 0.5,  0.707, 0.93, 1,
                             -1,   -0.8, -0.6, -0.3, -0.1, -0.02, 1e-7, -1e-7};
enum { N_MU = sizeof mus / sizeof *mus };
static const double phis[N_PHI] = {0, 47, 180};
static const double beams[] = {0.001, 0.08, 0.2, 0.37, 0.5, 0.61, 0.77, 0.9, 0.98, 1};
enum { N_BEAMS = sizeof beams / sizeof *beams };

typedef struct {
    pps_slab slab;
    size_t n_tau;
    double tau[MOST_DEPTHS];
} slab_case;

static slab_case case_at(double albedo, double g, double w) {
    double least = isinf(w) ? 8 : fmin(w, 30);
    slab_case c = {{albedo, g, w}, MOST_DEPTHS, {0, 1e-9 * least, 1e-3 * least}};
    for (size_t k = 3; k < MOST_DEPTHS; k++) {
        c.tau[k] = least * pow(0.3, (double)(MOST_DEPTHS - 1 - k));
    }
    if (!isinf(w)) {
        c.tau[MOST_DEPTHS - 2] = w * (1 - 1e-7);
        c.tau[MOST_DEPTHS - 1] = w;
    }
    return c;
}

static pps_dom *solver(const pps_slab *slab, pps_nodes nodes) {
    pps_dom *dom;
    pps_dom_opts opts = {.streams = STREAMS, .nodes = nodes, .orders = STREAMS};
    assert_int_equal(pps_dom_create(slab, &opts, &dom), PPS_OK);
    return dom;
}

/* The term of an order along a ray, by pps_mode_ray; *size: its parts in absolute value. */
static double scalar_term(const pps_dom *dom, int m, size_t b, double tau, double mu,
                          double *size) {
    const pps_order *order = &dom->order[m];
    double at[PPS_LANES], ge[N * PPS_LANES], go[N * PPS_LANES], sum = 0;
    double legendre[STREAMS * PPS_LANES], w = pps_dom_scaled_thickness(dom);
    for (int l = 0; l < PPS_LANES; l++) {
        at[l] = fabs(mu);
    }
    pps_order_project(order, &dom->discrete, PPS_LANES, at, ge, go, legendre);
    pps_ray ray;
    pps_ray_init(&ray, w, dom->beams.q[b], tau, mu);
    *size = 0;
    for (int j = 0; j < N; j++) {
        double psi, phi;
        pps_mode mode = pps_order_mode(order, j, w, &dom->beams, b);
        pps_mode_depth here = pps_mode_at(&mode, tau);
        pps_mode_ray(&mode, &ray, &here, &psi, &phi);
        double even = ge[j * PPS_LANES] * psi;
        double odd = (mu > 0 ? 1 : -1) * go[j * PPS_LANES] * phi;
        sum += even + odd;
        *size += fabs(even) + fabs(odd);
    }
    return sum;
}

static double first_light(const pps_dom *dom, size_t b, double tau, double mu,
                          double phi) {
    pps_ray ray;
    pps_ray_init(&ray, pps_dom_scaled_thickness(dom), dom->beams.q[b], tau, mu);
    double x = pps_cos_scattering(dom->beams.mu0[b], mu, phi);
    return dom->slab.albedo / dom->stretch * pps_hg(dom->slab.g, x) * ray.beam;
}

/* (2 D - D^2)(x) of the peak D from its moments: 1 below L, g^(l - L) from there on. */
static double folded_peak(const pps_dom *dom, double x) {
    double sum = 0, here = 1, before = 0, moment = 1;
    for (int l = 0; l < 600; l++) {
        moment *= l > dom->discrete.n_moments ? dom->slab.g : 1;
        sum += (2 * l + 1) * (2 - moment) * moment * here / (16 * atan(1));
        double next = ((2 * l + 1) * x * here - l * before) / (l + 1);
        before = here;
        here = next;
    }
    return sum;
}

/* What the peak scatters twice (aureole.c), by the scalar form; *size: its parts. */
static double aureole(const pps_dom *dom, size_t b, double tau, double mu, double phi,
                      double *size) {
    double c = 1 / mu, q = dom->beams.q[b], sigma = dom->stretch, g = dom->slab.g;
    double x = pps_cos_scattering(dom->beams.mu0[b], mu, phi);
    double twice = dom->slab.albedo * dom->f,
           square = dom->slab.albedo * dom->slab.albedo;
    double paths = c / 2 *
                   (q * pps_exp2(tau, c, sigma * q, sigma * q) +
                    c * pps_exp2(tau, q, sigma * c, sigma * c));
    *size = square * paths * (2 * dom->f * pps_hg(g, x) + pps_hg(g * g, x));
    return -twice * twice * folded_peak(dom, x) * paths;
}

/* One ray in all azimuths; `size` bounds what its parts add up to. */
static void scalar_radiance(const pps_dom *dom, size_t b, double tau, double mu,
                            double *radiance, double *size) {
    double scaled = tau * dom->stretch;
    *size = 0;
    for (int i = 0; i < N_PHI; i++) {
        radiance[i] = first_light(dom, b, scaled, mu, phis[i]);
        *size = fmax(*size, radiance[i]);
        if (mu > 0 && dom->f > 0) {
            double parts;
            radiance[i] += aureole(dom, b, tau, mu, phis[i], &parts);
            *size += parts;
        }
    }
    int n_orders = dom->beams.mu0[b] == 1 ? 1 : dom->n_solved;
    for (int m = 0; m < n_orders; m++) {
        double part, term = scalar_term(dom, m, b, scaled, mu, &part);
        *size += part;
        for (int i = 0; i < N_PHI; i++) {
            radiance[i] += term * pps_cos_degrees(m * phis[i]);
        }
    }
}

static void check_case(const slab_case *c, pps_nodes nodes, double *worst) {
    static double radiance[N_BEAMS * MOST_DEPTHS * N_MU * N_PHI];
    pps_dom *dom = solver(&c->slab, nodes);
    pps_grid at = {c->n_tau, N_MU, N_PHI, c->tau, mus, phis};
    assert_int_equal(pps_dom_solve_beams(dom, N_BEAMS, beams), PPS_OK);
    assert_int_equal(pps_dom_radiance(dom, &at, radiance), PPS_OK);
    const double *got = radiance;
    for (size_t b = 0; b < N_BEAMS; b++) {
        for (size_t k = 0; k < c->n_tau; k++) {
            for (size_t j = 0; j < N_MU; j++, got += N_PHI) {
                double want[N_PHI], size;
                scalar_radiance(dom, b, c->tau[k], mus[j], want, &size);
                for (int i = 0; i < N_PHI; i++) {
                    double error = fabs(got[i] - want[i]) / fmax(size, 1e-300);
                    double allowed = 3e-14 * (1 + 0.02 * fabs(log(size))); /* of e^x */
                    if (!(error <= allowed)) {
                        print_message("albedo %g g %g w %g mu0 %g tau %g mu %g phi %g: "
                                      "%.17g, scalar %.17g, size %g\n",
                                      c->slab.albedo, c->slab.g, c->slab.thickness,
                                      beams[b], c->tau[k], mus[j], phis[i], got[i],
                                      want[i], size);
                    }
                    assert_true(error <= allowed);
                    *worst = fmax(*worst, error);
                }
            }
        }
    }
    pps_dom_free(dom);
}

static void rays_together_are_the_rays_alone(void **state) {
    (void)state;
    static const double albedo[] = {0.3, 0.95, 0.9999, 1}, g[] = {-0.5, 0, 0.6, 0.9};
    static const double w[] = {0.01, 0.2, 1, 1.7, 5, 9, 60, 1e4, INFINITY};
    double worst = 0;
    for (size_t a = 0; a < sizeof albedo / sizeof *albedo; a++) {
        for (size_t i = 0; i < sizeof g / sizeof *g; i++) {
            for (size_t t = 0; t < sizeof w / sizeof *w; t++) {
                slab_case c = case_at(albedo[a], g[i], w[t]);
                check_case(&c, (a + i + t) % 2 ? PPS_NODES_GAUSS : PPS_NODES_MAPPED,
                           &worst);
            }
        }
    }
    print_message("worst: %.2g of the parts\n", worst);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_together_are_the_rays_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
