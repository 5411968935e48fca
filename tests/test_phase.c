/* The phase function and its integrals, against quadrature of the function itself.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <float.h>
#include <math.h>

#include <ppscat/phase.h>

#include "core/phase.h"
#include "core/vector.h"

#include "core/quadrature.h"

static const double PI = 3.14159265358979323846;

enum { POINTS = 24, HALVINGS = 40 };

typedef struct {
    double g, mu0;
} peak;

typedef double (*integrand)(const peak *p, double x);

/* The integral from `at` to `to` (either side of it) on Gauss panels that halve towards
 * `at`, where the integrand may have a peak of any width. */
static double integrate(integrand f, const peak *p, double at, double to) {
    double node[POINTS], weight[POINTS], sum = 0, far = to - at;
    pps_gauss_unit(POINTS, node, weight);
    for (int panel = 0; panel <= HALVINGS; panel++) {
        double near = panel < HALVINGS ? far / 2 : 0;
        for (int i = 0; i < POINTS; i++) {
            double x = at + near + (far - near) * node[i];
            sum += fabs(far - near) * weight[i] * f(p, x);
        }
        far = near;
    }
    return sum;
}

/* ---- p itself ---- */

static const double asymmetries[] = {0,    0.1,   -0.1, 0.5,  -0.5, 0.59, -0.59,
                                     0.61, -0.61, 0.9,  -0.9, 0.99, -0.99};
enum { N_ASYMMETRIES = sizeof asymmetries / sizeof asymmetries[0] };

static double density(const peak *p, double x) { return 2 * PI * pps_hg(p->g, x); }
static double first_moment(const peak *p, double x) { return x * density(p, x); }

static void phase_function_integrates_to_one(void **state) {
    (void)state;
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        peak p = {.g = asymmetries[i]};
        double side = p.g < 0 ? -1 : 1;
        assert_close(integrate(density, &p, side, -side), 1, 1e-13, 0);
    }
}

static void mean_cosine_is_the_asymmetry_parameter(void **state) {
    (void)state;
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        peak p = {.g = asymmetries[i]};
        double side = p.g < 0 ? -1 : 1;
        assert_close(integrate(first_moment, &p, side, -side), p.g, 1e-13, 1e-15);
    }
}

/* p(1) = (1 + g)/(4 pi (1 - g)^2), where 1 + g^2 - 2 g x would have lost all digits. */
static void forward_peak_keeps_its_digits(void **state) {
    (void)state;
    for (double e = 1e-1; e > 1e-10; e /= 10) {
        double g = 1 - e, gap = 1 - g, height = (1 + g) / (4 * PI * gap * gap);
        assert_close(pps_hg(g, 1), height, 1e-14, 0);
        assert_close(pps_hg(-g, -1), height, 1e-14, 0);
    }
}

/* ---- azimuthal mean ---- */

/* The trapezoid sum over n points, off by e^(-n (1 - |g|)) at most: below rounding. */
static double azimuth_sum(double g, double mu, double mu0) {
    int n = (int)ceil(80 / (1 - fabs(g)));
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += pps_hg(g, pps_cos_scattering(mu0, mu, 360.0 * i / n));
    }
    return sum / n;
}

static void azimuth_mean_is_the_mean_over_azimuth(void **state) {
    (void)state;
    static const double cosines[] = {-1, -0.99, -0.5, -1e-3, 1e-3, 0.3, 0.5, 0.9, 1};
    static const double beams[] = {1e-3, 0.3, 0.5, 0.9, 1};
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        double g = asymmetries[i], width = (1 - fabs(g)) * (1 - fabs(g));
        for (size_t j = 0; j < sizeof cosines / sizeof *cosines; j++) {
            for (size_t k = 0; k < sizeof beams / sizeof *beams; k++) {
                double mean = pps_hg_azimuth_mean(g, cosines[j], beams[k]);
                /* The sum takes cos Theta to DBL_EPSILON: its own error at the peak. */
                assert_close(mean, azimuth_sum(g, cosines[j], beams[k]),
                             1e-14 + 2 * DBL_EPSILON / width, 0);
            }
        }
    }
}

/* Of a beam along the normal, or in that direction, nothing depends on azimuth. */
static void along_the_normal_the_mean_is_the_phase_function(void **state) {
    (void)state;
    static const double cosines[] = {-1, -0.7, -1e-9, 1e-9, 0.3, 0.999, 1};
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        for (size_t j = 0; j < sizeof cosines / sizeof *cosines; j++) {
            double mu = cosines[j], want = pps_hg(asymmetries[i], mu);
            assert_close(pps_hg_azimuth_mean(asymmetries[i], mu, 1), want, 1e-14, 0);
            if (mu > 0) {
                assert_close(pps_hg_azimuth_mean(asymmetries[i], 1, mu), want, 1e-14,
                             0);
            }
        }
    }
}

/* Many at once are each by itself, to the last bit, wherever they stand. */
static void azimuth_means_do_not_know_each_other(void **state) {
    (void)state;
    enum { N = 2 * PPS_LANES };
    double mu[N], mean[N];
    for (int k = 0; k < N; k++) {
        mu[k] = -1 + (2 * k + 1) / (double)N;
    }
    pps_hg_azimuth_means(-0.8, 0.3, N, mu, mean);
    for (int k = 0; k < N; k++) {
        assert_close(mean[k], pps_hg_azimuth_mean(-0.8, mu[k], 0.3), 0, 0);
    }
}

/* ---- backward fraction ---- */

static const double incidences[] = {1e-3, 1e-2, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999, 1};
enum { N_INCIDENCES = sizeof incidences / sizeof incidences[0] };

static double mean_over_ring(const peak *p, double mu) {
    return 2 * PI * pps_hg_azimuth_mean(p->g, mu, p->mu0);
}

/* 2 pi int_-1^0 of the azimuthal mean: a peak at -mu0 when g < 0, and the wing of the
 * forward one at 0. */
static double backward_by_quadrature(double g, double mu0) {
    peak p = {g, mu0};
    double sum = integrate(mean_over_ring, &p, 0, -mu0 / 2) +
                 integrate(mean_over_ring, &p, -mu0, -mu0 / 2);
    return mu0 < 1 ? sum + integrate(mean_over_ring, &p, -mu0, -1) : sum;
}

static void backward_fraction_is_the_integral_over_the_other_hemisphere(void **state) {
    (void)state;
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        for (int j = 0; j < N_INCIDENCES; j++) {
            double g = asymmetries[i], mu0 = incidences[j];
            assert_close(pps_hg_backward(g, mu0), backward_by_quadrature(g, mu0), 1e-12,
                         0);
        }
    }
}

static void opposite_asymmetries_share_all_light(void **state) {
    (void)state;
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        for (int j = 0; j < N_INCIDENCES; j++) {
            double g = asymmetries[i], mu0 = incidences[j];
            assert_close(pps_hg_backward(g, mu0) + pps_hg_backward(-g, mu0), 1, 1e-15,
                         0);
        }
    }
}

static void series_and_elliptic_form_meet(void **state) {
    (void)state;
    for (int j = 0; j < N_INCIDENCES; j++) {
        for (int side = -1; side <= 1; side += 2) {
            double below = nextafter(0.6, 0) * side, above = 0.6 * side;
            assert_close(pps_hg_backward(below, incidences[j]),
                         pps_hg_backward(above, incidences[j]), 1e-14, 0);
        }
    }
}

/* R = 1/2 - (3/4) g mu0 + O(g^3), and at grazing incidence O(mu0). */
static void backward_fraction_tends_to_one_half(void **state) {
    (void)state;
    for (int j = 0; j < N_INCIDENCES; j++) {
        double mu0 = incidences[j];
        assert_close(pps_hg_backward(0, mu0), 0.5, 0, 0);
        assert_close(pps_hg_backward(1e-6, mu0), 0.5 - 0.75e-6 * mu0, 1e-15, 0);
        assert_close(pps_hg_backward(-1e-6, mu0), 0.5 + 0.75e-6 * mu0, 1e-15, 0);
    }
    static const double grazing[] = {0, 1e-300, 1e-160, 1e-100, 1e-20};
    for (int i = 0; i < N_ASYMMETRIES; i++) {
        for (size_t j = 0; j < sizeof grazing / sizeof *grazing; j++) {
            assert_close(pps_hg_backward(asymmetries[i], grazing[j]), 0.5, 1e-15, 0);
        }
    }
}

static void extreme_asymmetry_stays_finite_and_positive(void **state) {
    (void)state;
    static const double extreme[] = {0.999, 1 - 1e-6, 1 - 1e-9};
    for (size_t i = 0; i < sizeof extreme / sizeof *extreme; i++) {
        double g = extreme[i];
        for (int j = 0; j < N_INCIDENCES; j++) {
            double mu0 = incidences[j];
            double ahead = pps_hg_azimuth_mean(g, mu0, mu0);
            double back = pps_hg_azimuth_mean(-g, -mu0, mu0);
            double less = pps_hg_backward(g, mu0), more = pps_hg_backward(-g, mu0);
            assert_true(isfinite(ahead) && ahead > 0);
            assert_close(back, ahead, 1e-14, 0);
            assert_true(less > 0 && less < 0.5);
            assert_true(more > 0.5 && more < 1);
        }
    }
}

/* ---- angles ---- */

static void rational_cosines_are_exact(void **state) {
    (void)state;
    static const struct {
        double angle, cosine;
    } table[] = {{0, 1},      {60, 0.5},  {90, 0},    {120, -0.5}, {180, -1},
                 {240, -0.5}, {270, 0},   {300, 0.5}, {360, 1},    {-60, 0.5},
                 {-90, 0},    {-180, -1}, {450, 0},   {720, 1},    {3600060, 0.5}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_close(pps_cos_degrees(table[i].angle), table[i].cosine, 0, 0);
    }
}

static void other_cosines_are_right(void **state) {
    (void)state;
    for (int i = -500; i <= 500; i++) {
        double angle = 0.73 * i;
        assert_close(pps_cos_degrees(angle), cos(angle * (PI / 180)), 0, 2e-15);
        assert_close(pps_cos_degrees(-angle), pps_cos_degrees(angle), 0, 0);
    }
}

static void scattering_angle_spans_forward_to_backward(void **state) {
    (void)state;
    for (int j = 0; j < N_INCIDENCES; j++) {
        double mu0 = incidences[j];
        assert_close(pps_cos_scattering(mu0, mu0, 0), 1, 2e-16, 0);
        assert_close(pps_cos_scattering(mu0, -mu0, 180), -1, 2e-16, 0);
        assert_close(pps_cos_scattering(mu0, 0.4, 90), 0.4 * mu0, 1e-15, 0);
        assert_close(pps_cos_scattering(1, mu0, 77), mu0, 0, 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phase_function_integrates_to_one),
        cmocka_unit_test(mean_cosine_is_the_asymmetry_parameter),
        cmocka_unit_test(forward_peak_keeps_its_digits),
        cmocka_unit_test(azimuth_mean_is_the_mean_over_azimuth),
        cmocka_unit_test(along_the_normal_the_mean_is_the_phase_function),
        cmocka_unit_test(azimuth_means_do_not_know_each_other),
        cmocka_unit_test(backward_fraction_is_the_integral_over_the_other_hemisphere),
        cmocka_unit_test(opposite_asymmetries_share_all_light),
        cmocka_unit_test(series_and_elliptic_form_meet),
        cmocka_unit_test(backward_fraction_tends_to_one_half),
        cmocka_unit_test(extreme_asymmetry_stays_finite_and_positive),
        cmocka_unit_test(rational_cosines_are_exact),
        cmocka_unit_test(other_cosines_are_right),
        cmocka_unit_test(scattering_angle_spans_forward_to_backward),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
