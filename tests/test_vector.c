/* Vector loops: exponentials, triangular solves, small eigenproblems, ray moments.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/support.h"

#include <math.h>
#include <string.h>

#include "core/series.h"
#include "core/vector.h"
#include "solver/eigen.h"
#include "solver/lapack.h"

/* Uniform in [0, 1), the same on every machine. */
static double uniform(uint64_t *seed) {
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) * 0x1p-53;
}

static void exponentials_are_good_to_one_ulp(void **state) {
    (void)state;
    enum { N = 1001 };
    static const double range[] = {1e-3, 1, 30, 700};
    double x[N], y[N];
    uint64_t seed = 1;
    for (int r = 0; r < 4; r++) {
        for (int i = 0; i < N; i++) {
            x[i] = range[r] * (2 * uniform(&seed) - 1);
        }
        pps_exp_array(N, x, y);
        for (int i = 0; i < N; i++) {
            long double exact = expl((long double)x[i]);
            double ulp = nextafter((double)exact, HUGE_VAL) - (double)exact;
            assert_true(fabsl((long double)y[i] - exact) <= 1.01L * (long double)ulp);
        }
    }
}

static void exponentials_end_well(void **state) {
    (void)state;
    double x[] = {0, -0.0, -708, -709, -1e5, -1e300, -HUGE_VAL, 1e-300, -1e-20}, y[9];
    static const double want[] = {1, 1, 3.307553003638408e-308, 0, 0, 0, 0, 1, 1};
    pps_exp_array(9, x, y);
    for (int i = 0; i < 9; i++) {
        assert_close(y[i], want[i], 1e-12, 0);
    }
}

/* A number has the same bits wherever it stands. */
static void exponentials_do_not_depend_on_their_place(void **state) {
    (void)state;
    double x[40], y[40], one;
    uint64_t seed = 7;
    for (int i = 0; i < 40; i++) {
        x[i] = -50 * uniform(&seed);
    }
    for (size_t n = 0; n <= 40; n++) {
        pps_exp_array(n, x, y);
        for (size_t i = 0; i < n; i++) {
            pps_exp_array(1, &x[i], &one);
            assert_memory_equal(&y[i], &one, sizeof one);
        }
    }
}

static void symmetric(int n, double spread, uint64_t *seed, double *a) {
    for (int j = 0; j < n; j++) {
        for (int i = j; i < n; i++) {
            double size = exp(-spread * (i + j) / (2.0 * n));
            a[i + j * n] = a[j + i * n] =
                size * ((i == j ? 2 : 0) + 2 * uniform(seed) - 1);
        }
    }
}

static void solves_have_small_residuals(void **state) {
    (void)state;
    enum { MOST = 20, COLUMNS = 16 };
    uint64_t seed = 3;
    for (int n = 1; n <= MOST; n++) {
        double a[MOST * MOST], factor[MOST * MOST], b[MOST * COLUMNS];
        double x[MOST * COLUMNS];
        symmetric(n, 3, &seed, a);
        for (int i = 0; i < n; i++) {
            a[i + i * n] += n;
        }
        memcpy(factor, a, sizeof a);
        assert_true(pps_cholesky(n, factor));
        for (int i = 0; i < n; i++) {
            factor[i + i * n] = 1 / factor[i + i * n];
        }
        for (int i = 0; i < n * COLUMNS; i++) {
            b[i] = x[i] = uniform(&seed);
        }
        pps_rows_solve((size_t)n, factor, COLUMNS, x);
        for (int i = 0; i < n; i++) {
            for (int c = 0; c < COLUMNS; c++) {
                double sum = 0;
                for (int j = 0; j < n; j++) {
                    sum += a[i + j * n] * x[j * COLUMNS + c];
                }
                assert_close(sum, b[i * COLUMNS + c], 0, 1e-14);
            }
        }
    }
}

static void indefinite_matrices_have_no_factor(void **state) {
    (void)state;
    double a[4] = {1, 2, 2, 1}, zero[1] = {0}, nan[1] = {NAN};
    assert_false(pps_cholesky(2, a));
    assert_false(pps_cholesky(1, zero));
    assert_false(pps_cholesky(1, nan));
}

/* A = Y diag Y^T, Y orthogonal, values ascending: to rounding of the largest. */
static void check_eigen(int n, const double *a) {
    static double copy[PPS_EIGEN_SMALL * PPS_EIGEN_SMALL];
    static double y[PPS_EIGEN_SMALL * PPS_EIGEN_SMALL];
    double value[PPS_EIGEN_SMALL];
    memcpy(copy, a, (size_t)(n * n) * sizeof *a);
    assert_true(pps_eigen_small(n, copy, value, y));
    double size = fmax(fabs(value[0]), fabs(value[n - 1]));
    for (int i = 0; i < n; i++) {
        assert_true(i == 0 || value[i] >= value[i - 1]);
        for (int j = 0; j < n; j++) {
            double sum = 0, product = 0;
            for (int k = 0; k < n; k++) {
                sum += y[i + k * n] * value[k] * y[j + k * n];
                product += y[k + i * n] * y[k + j * n];
            }
            assert_close(sum, a[i + j * n], 0, 2e-14 * size);
            assert_close(product, i == j, 0, 2e-14);
        }
    }
}

static void small_eigenproblems_are_solved(void **state) {
    (void)state;
    static double a[PPS_EIGEN_SMALL * PPS_EIGEN_SMALL];
    uint64_t seed = 11;
    for (int n = 1; n <= PPS_EIGEN_SMALL; n += n < 10 ? 1 : 9) {
        for (int kind = 0; kind < 4; kind++) {
            symmetric(n, 8.0 * kind, &seed, a);
            check_eigen(n, a);
        }
    }
    /* diagonal; all equal; one large element beside the diagonal; nothing */
    memset(a, 0, sizeof a);
    check_eigen(7, a);
    for (int i = 0; i < 7; i++) {
        a[i + i * 7] = i % 3;
    }
    check_eigen(7, a);
    a[3 + 1 * 7] = a[1 + 3 * 7] = 1e-9;
    a[6 + 0 * 7] = a[0 + 6 * 7] = 1e6;
    check_eigen(7, a);
    for (int i = 0; i < 49; i++) {
        a[i] = 1;
    }
    check_eigen(7, a);
}

/* c int_0^t (s/w)^d e^(-c (t - s)) ds by composite Gauss points, in long double. */
static long double moment(int d, double w, double t, double c) {
    static const long double x[3] = {0.2386191860831969086L, 0.6612093864662645137L,
                                     0.9324695142031520278L};
    static const long double weight[3] = {
        0.4679139345726910473L, 0.3607615730481386076L, 0.1713244923791703450L};
    long double sum = 0, run = fminl((long double)t, 60 / (long double)c);
    enum { PANELS = 60 };
    for (int i = 0; i < PANELS; i++) {
        for (int k = 0; k < 6; k++) {
            long double at = ((long double)i + 0.5L + (k < 3 ? x[k] : -x[k - 3]) / 2) /
                             PANELS * run; /* t - s */
            sum += weight[k % 3] / 2 * run / PANELS *
                   powl(((long double)t - at) / (long double)w, d) *
                   expl(-(long double)c * at);
        }
    }
    return (long double)c * sum;
}

static void ray_moments_are_the_integrals(void **state) {
    (void)state;
    static const double c[PPS_LANES] = {1, 1.7, 3, 9, 24, 26, 80, 1e4};
    static const double share[] = {1, 0.6, 0.01, 1e-7}, w = 0.9;
    for (int i = 0; i < 4; i++) {
        double t = share[i] * w, ect[PPS_LANES], root[PPS_LANES];
        double got[PPS_SERIES_TERMS * PPS_LANES];
        for (int l = 0; l < PPS_LANES; l++) {
            ect[l] = exp(-c[l] * t);
            root[l] = exp(-c[l] * t / 2);
        }
        pps_series_moments(PPS_LANES, w, t, c, ect, root, got);
        for (int d = 0; d < PPS_SERIES_TERMS; d++) {
            for (int l = 0; l < PPS_LANES; l++) {
                double want = (double)moment(d, w, t, c[l]);
                assert_close(got[d * PPS_LANES + l], want, 3e-14, 1e-300);
            }
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponentials_are_good_to_one_ulp),
        cmocka_unit_test(exponentials_end_well),
        cmocka_unit_test(exponentials_do_not_depend_on_their_place),
        cmocka_unit_test(solves_have_small_residuals),
        cmocka_unit_test(indefinite_matrices_have_no_factor),
        cmocka_unit_test(small_eigenproblems_are_solved),
        cmocka_unit_test(ray_moments_are_the_integrals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
