/* One mode of a slab: the equations it satisfies, its edges, its ray integrals.
 *
 * That psi and phi satisfy both equations and both boundary conditions is all there is
 * to show: the problem has one solution. The equations are tested as integrals over
 * short stretches, psi(b) - psi(a) = int (-phi + beta e^(-q t)) and so for phi.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <float.h>
#include <math.h>

#include "core/mode.h"
#include "core/quadrature.h"

enum { POINTS = 24, HALVINGS = 70 };

/* ---- modes of every kind ---- */

typedef struct {
    pps_mode_kind kind;
    double k, w, q;
} slab_mode;

static const slab_mode modes[] = {
    {PPS_MODE_THIN, 0, 1e-9, 1},
    {PPS_MODE_THIN, 0, 1, 1.5},
    {PPS_MODE_THIN, 0.9, 1, 1.9},
    {PPS_MODE_THIN, 1.5, 0.5, 1.5}, /* on resonance */
    {PPS_MODE_THIN, 900, 1e-3, 1000},
    {PPS_MODE_THIN, 1e-9, 0.1, 3},
    {PPS_MODE_SMALL, 0, 10, 1},
    {PPS_MODE_SMALL, 0, 1e9, 1.25},
    {PPS_MODE_SMALL, 1e-9, 1e6, 2},
    {PPS_MODE_SMALL, 0.05, 10, 2},
    {PPS_MODE_SMALL, 0.9, 1, 1e4},
    {PPS_MODE_SMALL, 2.001, 0.499, 4.1},
    {PPS_MODE_RESONANT, 2, 1, 2},
    {PPS_MODE_RESONANT, 2, 50, 2},
    {PPS_MODE_RESONANT, 1.25, 4, 1.25 * (1 + 1e-14)},
    {PPS_MODE_RESONANT, 3, 7, 3 * (1 - 1e-8)},
    {PPS_MODE_RESONANT, 1.4, 3, 1},
    {PPS_MODE_RESONANT, 1, 1e4, 1.9},
    {PPS_MODE_RESONANT, 1.5, INFINITY, 1.5},
    {PPS_MODE_RESONANT, 0.7, INFINITY, 1},
    {PPS_MODE_NORMAL, 0.3, 5, 1},
    {PPS_MODE_NORMAL, 40, 0.5, 1},
    {PPS_MODE_NORMAL, 1, 30, 1000},
    {PPS_MODE_NORMAL, 0.01, 1e4, 5},
    {PPS_MODE_NORMAL, 0, INFINITY, 1},
    {PPS_MODE_NORMAL, 1e-9, INFINITY, 2},
    {PPS_MODE_NORMAL, 12, INFINITY, 3},
};
enum { N_MODES = sizeof modes / sizeof modes[0] };

/* Beam sources and boundary coupling G. */
static const struct {
    double alpha, beta, g;
} sources[] = {{1, 0, 1}, {0, 1, 0.3}, {0.7, -0.4, 5}, {2, 0.5, 0.01}};
enum { N_SOURCES = sizeof sources / sizeof sources[0] };

static pps_mode solve(const slab_mode *m, int source) {
    pps_mode mode;
    pps_mode_beam(&mode, m->k, m->w, m->q, sources[source].alpha, sources[source].beta);
    pps_mode_solve(&mode, sources[source].g, 0);
    return mode;
}

/* Runs a check on every mode with every source. */
static void for_all_modes(void (*check)(const pps_mode *mode, double g)) {
    for (int i = 0; i < N_MODES; i++) {
        for (int s = 0; s < N_SOURCES; s++) {
            pps_mode mode = solve(&modes[i], s);
            check(&mode, sources[s].g);
        }
    }
}

/* The depth that stands for the bottom: of a half-space, 50 lengths of its slowest
 * decay. */
static double deepest(const pps_mode *mode) {
    double slowest = mode->k > 0 ? fmin(mode->k, mode->q) : mode->q;
    return fmin(mode->w, 50 / slowest);
}

static void table_has_the_kinds_it_names(void **state) {
    (void)state;
    for (int i = 0; i < N_MODES; i++) {
        pps_mode mode = solve(&modes[i], 0);
        assert_int_equal(mode.kind, modes[i].kind);
    }
}

/* ---- the equations ---- */

/* The two integrals from a to b, and the size of what they are made of. */
typedef struct {
    double psi, phi, psi_size, phi_size;
} increments;

static increments integrate_equations(const pps_mode *mode, double a, double b) {
    double node[POINTS], weight[POINTS], k2 = mode->k * mode->k;
    increments sum = {0};
    pps_gauss_unit(POINTS, node, weight);
    for (int i = 0; i < POINTS; i++) {
        double t = a + (b - a) * node[i], dt = (b - a) * weight[i], psi, phi;
        double beam = exp(-mode->q * t);
        pps_mode_state(mode, t, &psi, &phi);
        sum.psi += dt * (-phi + mode->beta * beam);
        sum.phi += dt * (-k2 * psi + mode->alpha * beam);
        sum.psi_size += dt * (fabs(phi) + fabs(mode->beta) * beam);
        sum.phi_size += dt * (k2 * fabs(psi) + fabs(mode->alpha) * beam);
    }
    return sum;
}

static void check_equations_on(const pps_mode *mode, double a, double b) {
    double psi[2], phi[2];
    pps_mode_state(mode, a, &psi[0], &phi[0]);
    pps_mode_state(mode, b, &psi[1], &phi[1]);
    increments sum = integrate_equations(mode, a, b);
    /* Exponentials of large arguments bring their own rounding; phi holds its digits
     * beside the source beta. */
    double rounding = 1e-14 + (mode->k + mode->q) * b * DBL_EPSILON;
    double source = fabs(mode->beta) * exp(-mode->q * a);
    assert_close(psi[1] - psi[0], sum.psi, 0,
                 rounding * (fabs(psi[0]) + fabs(psi[1]) + sum.psi_size));
    assert_close(phi[1] - phi[0], sum.phi, 0,
                 rounding * (fabs(phi[0]) + fabs(phi[1]) + sum.phi_size + source));
}

/* On stretches of a length or less of the fastest change, at shares of the depth. */
static void check_equations(const pps_mode *mode, double g) {
    (void)g;
    double depth = deepest(mode), step = fmin(depth / 4, 1 / (mode->k + mode->q));
    for (int i = 0; i <= 8; i++) {
        double from = (depth - step) * i / 8;
        check_equations_on(mode, from, from + step);
    }
}

static void both_equations_hold_through_the_slab(void **state) {
    (void)state;
    for_all_modes(check_equations);
}

/* ---- the edges ---- */

/* The length over which the beam feeds the mode. */
static double beam_length(const pps_mode *mode) { return fmin(mode->w, 1 / mode->q); }

/* The size of phi at a depth, had nothing cancelled: what the sources add up to, and
 * how much of it is left. psi is of this size times beam_length. */
static double strength_at(const pps_mode *mode, double tau) {
    double fed = fabs(mode->beta) + fabs(mode->alpha) * beam_length(mode);
    return fed * exp(-fmin(mode->k, mode->q) * tau);
}

static void check_edges(const pps_mode *mode, double g) {
    double psi, phi;
    pps_mode_state(mode, 0, &psi, &phi);
    assert_close(g * psi, -phi, 1e-14, 1e-15 * strength_at(mode, 0));
    if (isinf(mode->w)) {
        assert_close(mode->c2, 0, 0, 0); /* nothing grows */
        return;
    }
    pps_mode_state(mode, mode->w, &psi, &phi);
    assert_close(g * psi, phi, 1e-13, 1e-15 * strength_at(mode, mode->w));
}

static void nothing_falls_in_at_the_edges(void **state) {
    (void)state;
    for_all_modes(check_edges);
}

/* ---- across the switches between kinds ---- */

/* Two neighbouring modes that are solved in different ways. */
static const struct {
    slab_mode here, there;
} switches[] = {
    /* w q = 2 */
    {{PPS_MODE_THIN, 0, 1, 1.9999999999999998}, {PPS_MODE_SMALL, 0, 1, 2}},
    {{PPS_MODE_THIN, 0.3, 1, 1.9999999999999998}, {PPS_MODE_SMALL, 0.3, 1, 2}},
    {{PPS_MODE_THIN, 400, 0x1p-9, 1023.9999999999999},
     {PPS_MODE_SMALL, 400, 0x1p-9, 1024}},
    /* k w = 1, not thin, before and after resonance */
    {{PPS_MODE_SMALL, 0.49999999999999994, 2, 3}, {PPS_MODE_NORMAL, 0.5, 2, 3}},
    {{PPS_MODE_SMALL, 0.0099999999999999985, 100, 1},
     {PPS_MODE_NORMAL, 0.010000000000000002, 100, 1}},
    {{PPS_MODE_SMALL, 1.9999999999999998, 0.5, 4.5}, {PPS_MODE_NORMAL, 2, 0.5, 4.5}},
    /* k w = 1, thin: on resonance and off */
    {{PPS_MODE_THIN, 0.99999999999999989, 1, 1.5}, {PPS_MODE_RESONANT, 1, 1, 1.5}},
    {{PPS_MODE_THIN, 3.9999999999999996, 0.25, 4}, {PPS_MODE_RESONANT, 4, 0.25, 4}},
    {{PPS_MODE_THIN, 3.9999999999999996, 0.25, 1}, {PPS_MODE_NORMAL, 4, 0.25, 1}},
    /* |k/q - 1| = 1/2 */
    {{PPS_MODE_NORMAL, 1, 3, 2}, {PPS_MODE_RESONANT, 1.0000000000000002, 3, 2}},
    {{PPS_MODE_NORMAL, 1, 40, 2}, {PPS_MODE_RESONANT, 1.0000000000000002, 40, 2}},
    {{PPS_MODE_NORMAL, 3, 3, 2}, {PPS_MODE_RESONANT, 2.9999999999999996, 3, 2}},
    {{PPS_MODE_NORMAL, 3, INFINITY, 2},
     {PPS_MODE_RESONANT, 2.9999999999999996, INFINITY, 2}},
};
enum { N_SWITCHES = sizeof switches / sizeof switches[0] };

static const double shares[] = {0, 1e-6, 0.1, 0.5, 0.9, 1};
static const double cosines[] = {1, 0.6, 0.05, 1e-4, -1e-4, -0.05, -0.6, -1};
enum { N_SHARES = sizeof shares / sizeof shares[0] };
enum { N_COSINES = sizeof cosines / sizeof cosines[0] };

static void ray_integrals(const pps_mode *mode, double tau, double mu, double *psi,
                          double *phi) {
    pps_ray ray;
    pps_ray_init(&ray, mode->w, mode->q, tau, mu);
    pps_mode_depth at = pps_mode_at(mode, tau);
    pps_mode_ray(mode, &ray, &at, psi, phi);
}

/* The same psi and phi twice, to 1e-12 or the rounding of parts that cancel. */
static void assert_same(const double psi[2], const double phi[2], double size,
                        double length) {
    assert_close(psi[0], psi[1], 1e-12, 1e-15 * size * length);
    assert_close(phi[0], phi[1], 1e-12, 1e-15 * size);
}

static void solution_is_continuous_across_kinds(void **state) {
    (void)state;
    for (int i = 0; i < N_SWITCHES * N_SOURCES; i++) {
        pps_mode here = solve(&switches[i / N_SOURCES].here, i % N_SOURCES);
        pps_mode there = solve(&switches[i / N_SOURCES].there, i % N_SOURCES);
        assert_int_equal(here.kind, switches[i / N_SOURCES].here.kind);
        assert_int_equal(there.kind, switches[i / N_SOURCES].there.kind);
        for (int d = 0; d < N_SHARES; d++) {
            double tau = shares[d] * deepest(&there), psi[2], phi[2];
            pps_mode_state(&here, tau, &psi[0], &phi[0]);
            pps_mode_state(&there, tau, &psi[1], &phi[1]);
            assert_same(psi, phi, strength_at(&there, tau), beam_length(&there));
        }
    }
}

static void ray_integrals_are_continuous_across_kinds(void **state) {
    (void)state;
    for (int i = 0; i < N_SWITCHES * N_SOURCES; i++) {
        pps_mode here = solve(&switches[i / N_SOURCES].here, i % N_SOURCES);
        pps_mode there = solve(&switches[i / N_SOURCES].there, i % N_SOURCES);
        for (int d = 0; d < N_SHARES * N_COSINES; d++) {
            double tau = shares[d / N_COSINES] * deepest(&there), psi[2], phi[2];
            double mu = cosines[d % N_COSINES], run = mu > 0 ? tau : here.w - tau;
            ray_integrals(&here, tau, mu, &psi[0], &phi[0]);
            ray_integrals(&there, tau, mu, &psi[1], &phi[1]);
            double share = -expm1(-run / fabs(mu));
            assert_same(psi, phi, share * strength_at(&there, tau),
                        beam_length(&there));
        }
    }
}

/* ---- ray integrals ---- */

typedef struct {
    double node[POINTS], weight[POINTS];
    double psi, phi, psi_size, phi_size;
} ray_sums;

/* A Gauss panel of c f(t) e^(-c s), t = tau - side s, over s between two distances. */
static void add_panel(const pps_mode *mode, const pps_ray *ray, double from, double to,
                      ray_sums *sum) {
    double width = fabs(to - from), side = ray->down ? 1 : -1;
    for (int i = 0; i < POINTS; i++) {
        double s = from + (to - from) * sum->node[i], psi, phi;
        double kernel = width * sum->weight[i] * ray->c * exp(-ray->c * s);
        pps_mode_state(mode, ray->tau - side * s, &psi, &phi);
        sum->psi += kernel * psi;
        sum->phi += kernel * phi;
        sum->psi_size += kernel * fabs(psi);
        sum->phi_size += kernel * fabs(phi);
    }
}

/* Panels that halve towards `at`, so that an exponential of any rate is resolved. */
static void add_graded(const pps_mode *mode, const pps_ray *ray, double at, double to,
                       ray_sums *sum) {
    double far = to - at;
    for (int panel = 0; panel <= HALVINGS; panel++) {
        double near = panel < HALVINGS ? far / 2 : 0;
        add_panel(mode, ray, at + near, at + far, sum);
        far = near;
    }
}

static void check_ray(const pps_mode *mode, double tau, double mu) {
    pps_ray ray;
    pps_ray_init(&ray, mode->w, mode->q, tau, mu);
    double run = mu > 0 ? tau : fmin(mode->w - tau, 50 / ray.c), psi, phi;
    ray_sums sum = {0};
    pps_gauss_unit(POINTS, sum.node, sum.weight);
    add_graded(mode, &ray, 0, run / 2, &sum);
    add_graded(mode, &ray, run, run / 2, &sum);
    ray_integrals(mode, tau, mu, &psi, &phi);
    double exponents = (mode->k + mode->q) * tau * DBL_EPSILON;
    double beam = strength_at(mode, tau) * -expm1(-ray.c * run);
    double parts = (1e-15 + exponents) * (beam + mode->k * sum.psi_size);
    assert_close(psi, sum.psi, 0,
                 (1e-14 + exponents) * sum.psi_size + parts * beam_length(mode));
    assert_close(phi, sum.phi, 0, (1e-14 + exponents) * sum.phi_size + parts);
}

static void check_rays(const pps_mode *mode, double g) {
    (void)g;
    for (int i = 0; i < N_SHARES * N_COSINES; i++) {
        double tau = shares[i / N_COSINES] * deepest(mode);
        check_ray(mode, tau, cosines[i % N_COSINES]);
    }
}

static void ray_integrals_are_those_of_the_solution(void **state) {
    (void)state;
    for_all_modes(check_rays);
}

/* mu = mu0 and k |mu| = 1: where the factors of partial fractions are infinite. */
static void ray_integrals_hold_on_their_own_resonances(void **state) {
    (void)state;
    for (int i = 0; i < N_MODES; i++) {
        pps_mode mode = solve(&modes[i], 2);
        double beam = 1 / mode.q, own = mode.k > 1 ? 1 / mode.k : 1;
        for (int d = 0; d < N_SHARES; d++) {
            double tau = shares[d] * deepest(&mode);
            check_ray(&mode, tau, beam);
            check_ray(&mode, tau, -beam);
            check_ray(&mode, tau, own);
            check_ray(&mode, tau, -own);
            check_ray(&mode, tau, own * (1 + 1e-9));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_has_the_kinds_it_names),
        cmocka_unit_test(both_equations_hold_through_the_slab),
        cmocka_unit_test(nothing_falls_in_at_the_edges),
        cmocka_unit_test(solution_is_continuous_across_kinds),
        cmocka_unit_test(ray_integrals_are_continuous_across_kinds),
        cmocka_unit_test(ray_integrals_are_those_of_the_solution),
        cmocka_unit_test(ray_integrals_hold_on_their_own_resonances),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
