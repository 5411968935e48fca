/* The contract of the public calls: status of every bad argument, failing allocations,
 * threads, silence.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/allocation.h"
#include "support/support.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <ppscat/ppscat.h>

static const double NOT_A_NUMBER = (double)NAN;

static const pps_slab good = {0.9, 0.5, 1};
static const double taus[] = {0, 0.5, 1}, mus[] = {0.7, -0.2, 1}, phis[] = {0, 75};
static const pps_grid grid = {3, 3, 2, taus, mus, phis};
enum { N_RADIANCES = 3 * 3 * 2 };

/* ---- allocation ---- */

/* A test that fails half-way leaves enough for those after it. */
static int restore_allocation(void **state) {
    (void)state;
    allocations_left = -1;
    return 0;
}

/* ---- status ---- */

static void status_texts_are_distinct(void **state) {
    (void)state;
    static const pps_status all[] = {
#define PPS_STATUS_CODE(code, text) code,
        PPS_STATUS_LIST(PPS_STATUS_CODE)
#undef PPS_STATUS_CODE
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        assert_true(strlen(pps_status_string(all[i])) > 0);
        for (size_t j = 0; j < i; j++) {
            assert_string_not_equal(pps_status_string(all[i]),
                                    pps_status_string(all[j]));
        }
    }
    assert_true(strlen(pps_status_string((pps_status)-1)) > 0);
    assert_true(strlen(pps_status_string((pps_status)1000)) > 0);
}

static void version_has_three_parts(void **state) {
    (void)state;
    const char *first = strchr(pps_version(), '.');
    assert_non_null(first);
    assert_non_null(strchr(first + 1, '.'));
}

/* ---- bad values ---- */

static const struct {
    pps_slab slab;
    pps_status status;
} slabs[] = {
    {{0, 0, 1}, PPS_OK},
    {{1, 0.999999, INFINITY}, PPS_OK},
    {{1, -0.999999, 1e-300}, PPS_OK},
    {{-1e-300, 0, 1}, PPS_ERR_ARGUMENT},
    {{1.2, 0, 1}, PPS_ERR_ARGUMENT},
    {{1 + 1e-15, 0, 1}, PPS_ERR_ARGUMENT},
    {{(double)NAN, 0, 1}, PPS_ERR_ARGUMENT},
    {{INFINITY, 0, 1}, PPS_ERR_ARGUMENT},
    {{0.5, 1, 1}, PPS_ERR_ARGUMENT},
    {{0.5, -1, 1}, PPS_ERR_ARGUMENT},
    {{0.5, (double)NAN, 1}, PPS_ERR_ARGUMENT},
    {{0.5, -INFINITY, 1}, PPS_ERR_ARGUMENT},
    {{0.5, 0, 0}, PPS_ERR_ARGUMENT},
    {{0.5, 0, -1}, PPS_ERR_ARGUMENT},
    {{0.5, 0, (double)NAN}, PPS_ERR_ARGUMENT},
    {{0.5, 0, -INFINITY}, PPS_ERR_ARGUMENT},
};
enum { N_SLABS = sizeof slabs / sizeof slabs[0] };

static void slabs_out_of_range_are_refused(void **state) {
    (void)state;
    for (int i = 0; i < N_SLABS; i++) {
        assert_int_equal(pps_slab_check(&slabs[i].slab), slabs[i].status);
    }
    assert_int_equal(pps_slab_check(NULL), PPS_ERR_ARGUMENT);
}

static void every_maker_refuses_bad_slabs(void **state) {
    (void)state;
    const pps_method *method = pps_method_find("single");
    for (int i = 0; i < N_SLABS; i++) {
        const pps_slab *slab = &slabs[i].slab;
        if (slabs[i].status == PPS_OK) {
            continue;
        }
        pps_dom *dom = (pps_dom *)(uintptr_t)1;
        pps_model *model = (pps_model *)(uintptr_t)1;
        pps_spp spp;
        assert_int_equal(pps_dom_create(slab, NULL, &dom), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_model_create(method, slab, NULL, &model),
                         PPS_ERR_ARGUMENT);
        assert_int_equal(pps_spp_init(&spp, slab, 1, PPS_SPP_CONSISTENT),
                         PPS_ERR_ARGUMENT);
        assert_null(dom);
        assert_null(model);
    }
}

static const struct {
    double mu0;
    pps_status status;
} beams[] = {{1, PPS_OK},
             {1e-300, PPS_OK},
             {0, PPS_ERR_ARGUMENT},
             {-0.5, PPS_ERR_ARGUMENT},
             {1 + 1e-15, PPS_ERR_ARGUMENT},
             {(double)NAN, PPS_ERR_ARGUMENT},
             {INFINITY, PPS_ERR_ARGUMENT}};
enum { N_BEAMS = sizeof beams / sizeof beams[0] };

static void beams_out_of_range_are_refused(void **state) {
    (void)state;
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&good, &(pps_dom_opts){.streams = 4}, &dom),
                     PPS_OK);
    for (int i = 0; i < N_BEAMS; i++) {
        pps_spp spp;
        assert_int_equal(pps_mu0_check(beams[i].mu0), beams[i].status);
        assert_int_equal(pps_dom_solve(dom, beams[i].mu0), beams[i].status);
        assert_int_equal(pps_spp_init(&spp, &good, beams[i].mu0, PPS_SPP_CONSISTENT),
                         beams[i].status);
    }
    pps_dom_free(dom);
}

static void every_method_refuses_bad_beams_and_thicknesses(void **state) {
    (void)state;
    static const double bad[] = {0, -1, (double)NAN, -INFINITY};
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t m = 0; m < n; m++) {
        pps_model *model;
        assert_int_equal(pps_model_create(table[m], &good, NULL, &model), PPS_OK);
        for (int i = 0; i < N_BEAMS; i++) {
            pps_status status = pps_model_solve(model, 1, beams[i].mu0);
            bool grazing = !beams[i].status && status == PPS_ERR_UNSUPPORTED;
            assert_true(status == beams[i].status || grazing);
        }
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            assert_int_equal(pps_model_solve(model, bad[i], 0.5), PPS_ERR_ARGUMENT);
        }
        pps_model_free(model);
    }
}

static const double outside[] = {-1e-9, 1.0000001, INFINITY, (double)NAN};
static const double horizontal[] = {0}, beyond[] = {1.1}, no_number[] = {(double)NAN};

static const struct {
    pps_grid grid;
    pps_status status;
} grids[] = {
    {{3, 3, 2, taus, mus, phis}, PPS_OK},
    {{0, 0, 0, NULL, NULL, NULL}, PPS_OK},
    {{1, 3, 2, &outside[0], mus, phis}, PPS_ERR_ARGUMENT},
    {{1, 3, 2, &outside[1], mus, phis}, PPS_ERR_ARGUMENT},
    {{1, 3, 2, &outside[2], mus, phis}, PPS_ERR_ARGUMENT},
    {{1, 3, 2, &outside[3], mus, phis}, PPS_ERR_ARGUMENT},
    {{3, 1, 2, taus, horizontal, phis}, PPS_ERR_ARGUMENT},
    {{3, 1, 2, taus, beyond, phis}, PPS_ERR_ARGUMENT},
    {{3, 1, 2, taus, no_number, phis}, PPS_ERR_ARGUMENT},
    {{3, 3, 1, taus, mus, no_number}, PPS_ERR_ARGUMENT},
    {{3, 3, 1, taus, mus, &outside[2]}, PPS_ERR_ARGUMENT},
    {{3, 3, 2, NULL, mus, phis}, PPS_ERR_ARGUMENT},
    {{3, 3, 2, taus, NULL, phis}, PPS_ERR_ARGUMENT},
    {{3, 3, 2, taus, mus, NULL}, PPS_ERR_ARGUMENT},
};
enum { N_GRIDS = sizeof grids / sizeof grids[0] };

static void grids_out_of_range_are_refused(void **state) {
    (void)state;
    double radiance[N_RADIANCES];
    pps_dom *dom;
    pps_model *model;
    pps_dom_create(&good, &(pps_dom_opts){.streams = 4}, &dom);
    pps_model_create(pps_method_find("spp"), &good, NULL, &model);
    assert_int_equal(pps_dom_solve(dom, 0.5), PPS_OK);
    assert_int_equal(pps_model_solve(model, 1, 0.5), PPS_OK);
    for (int i = 0; i < N_GRIDS; i++) {
        const pps_grid *at = &grids[i].grid;
        assert_int_equal(pps_grid_check(at, 1), grids[i].status);
        assert_int_equal(pps_dom_radiance(dom, at, radiance), grids[i].status);
        assert_int_equal(pps_model_radiance(model, at, radiance), grids[i].status);
    }
    assert_int_equal(pps_grid_check(NULL, 1), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_radiance(dom, &grid, NULL), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_radiance(dom, NULL, radiance), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_model_radiance(model, &grid, NULL), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_model_radiance(model, NULL, radiance), PPS_ERR_ARGUMENT);
    pps_dom_free(dom);
    pps_model_free(model);
}

static void depths_out_of_range_are_refused(void **state) {
    (void)state;
    pps_flux flux[3];
    pps_dom *dom;
    pps_model *model;
    pps_dom_create(&good, &(pps_dom_opts){.streams = 4}, &dom);
    pps_model_create(pps_method_find("spp"), &good, NULL, &model);
    assert_int_equal(pps_dom_solve(dom, 0.5), PPS_OK);
    assert_int_equal(pps_model_solve(model, 1, 0.5), PPS_OK);
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
        assert_int_equal(pps_tau_check(1, &outside[i], 1), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_dom_flux(dom, 1, &outside[i], flux), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_model_flux(model, 1, &outside[i], flux), PPS_ERR_ARGUMENT);
    }
    assert_int_equal(pps_tau_check(1, NULL, 1), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_tau_check(0, NULL, 1), PPS_OK);
    assert_int_equal(pps_tau_check(1, &outside[2], INFINITY), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_flux(dom, 3, taus, NULL), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_model_flux(model, 3, taus, NULL), PPS_ERR_ARGUMENT);
    pps_dom_free(dom);
    pps_model_free(model);
}

/* ---- options ---- */

static const struct {
    pps_dom_opts opts;
    double g;
    pps_status status;
} options[] = {
    {{0}, 0.5, PPS_OK},
    {{.streams = 2}, 0.5, PPS_OK},
    {{.streams = 7}, 0.5, PPS_ERR_ARGUMENT},
    {{.streams = 1}, 0.5, PPS_ERR_ARGUMENT},
    {{.streams = -2}, 0.5, PPS_ERR_ARGUMENT},
    {{.streams = PPS_STREAMS_MAX + 2}, 0.5, PPS_ERR_ARGUMENT},
    {{.nodes = (pps_nodes)4}, 0.5, PPS_ERR_ARGUMENT},
    {{.delta_m = (pps_delta_m)3}, 0.5, PPS_ERR_ARGUMENT},
    {{.nodes = PPS_NODES_MAPPED, .delta_m = PPS_DELTA_M_OFF}, 0.5, PPS_ERR_ARGUMENT},
    {{.nodes = PPS_NODES_GRADED, .delta_m = PPS_DELTA_M_OFF}, 0.5, PPS_ERR_ARGUMENT},
    {{.nodes = PPS_NODES_GAUSS, .delta_m = PPS_DELTA_M_OFF}, 0.5, PPS_OK},
    {{.tolerance = -1e-3}, 0.5, PPS_ERR_ARGUMENT},
    {{.tolerance = 1}, 0.5, PPS_ERR_ARGUMENT},
    {{.tolerance = (double)NAN}, 0.5, PPS_ERR_ARGUMENT},
    {{.delta_m = PPS_DELTA_M_ON}, 0.5, PPS_OK},
    {{.delta_m = PPS_DELTA_M_ON}, -0.5, PPS_ERR_UNSUPPORTED},
    {{.delta_m = PPS_DELTA_M_AUTO}, -0.5, PPS_OK},
    {{.streams = 8, .delta_m = PPS_DELTA_M_OFF}, 0.95, PPS_ERR_INDEFINITE},
};
enum { N_OPTIONS = sizeof options / sizeof options[0] };

static void solver_options_are_honoured_or_refused(void **state) {
    (void)state;
    for (int i = 0; i < N_OPTIONS; i++) {
        pps_slab slab = {1, options[i].g, 1};
        pps_dom *dom = (pps_dom *)(uintptr_t)1;
        pps_status status = pps_dom_create(&slab, &options[i].opts, &dom);
        assert_int_equal(status, options[i].status);
        assert_true((dom != NULL) == (status == PPS_OK));
        pps_dom_free(dom);
    }
    pps_dom *dom;
    assert_int_equal(pps_dom_create(&good, &(pps_dom_opts){.orders = -1}, &dom),
                     PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_create(&good, NULL, &dom), PPS_OK);
    pps_dom_free(dom);
}

/* `exact` makes its solvers when asked for output: there INDEFINITE shows. */
static pps_status status_of_exact(const pps_dom_opts *opts, double g) {
    pps_options own = {.streams = opts->streams ? opts->streams : 16,
                       .nodes = opts->nodes,
                       .delta_m = opts->delta_m,
                       .tolerance = opts->tolerance};
    pps_slab slab = {1, g, 1};
    pps_model *model = (pps_model *)(uintptr_t)1;
    pps_flux flux[3];
    pps_status status = pps_model_create(pps_method_find("exact"), &slab, &own, &model);
    if (status) {
        assert_null(model);
        return status;
    }
    assert_int_equal(pps_model_solve(model, 1, 0.5), PPS_OK);
    status = pps_model_flux(model, 3, taus, flux);
    pps_model_free(model);
    return status;
}

static void method_options_are_honoured_or_refused(void **state) {
    (void)state;
    for (int i = 0; i < N_OPTIONS; i++) {
        assert_int_equal(status_of_exact(&options[i].opts, options[i].g),
                         options[i].status);
    }
    pps_model *model = (pps_model *)(uintptr_t)1;
    assert_int_equal(pps_model_create(NULL, &good, NULL, &model), PPS_ERR_ARGUMENT);
    assert_null(model);
}

static void orders_not_asked_for_have_no_eigenvalues(void **state) {
    (void)state;
    double k[2];
    pps_dom *dom;
    pps_dom_create(&good, &(pps_dom_opts){.streams = 4, .orders = 2}, &dom);
    assert_int_equal(pps_dom_eigenvalues(dom, 0, k), PPS_OK);
    assert_int_equal(pps_dom_eigenvalues(dom, 1, k), PPS_OK);
    assert_true(k[0] <= k[1]);
    assert_int_equal(pps_dom_eigenvalues(dom, 2, k), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_eigenvalues(dom, -1, k), PPS_ERR_ARGUMENT);
    pps_dom_free(dom);
}

/* ---- order of calls ---- */

static void output_before_solve_is_refused(void **state) {
    (void)state;
    double radiance[N_RADIANCES];
    pps_flux flux[3];
    pps_dom *dom;
    pps_dom_create(&good, &(pps_dom_opts){.streams = 4}, &dom);
    assert_int_equal(pps_dom_radiance(dom, &grid, radiance), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_flux(dom, 3, taus, flux), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_solve(dom, 0.5), PPS_OK);
    assert_int_equal(pps_dom_flux(dom, 3, taus, flux), PPS_OK);
    assert_int_equal(pps_dom_set_thickness(dom, 2), PPS_OK);
    assert_int_equal(pps_dom_flux(dom, 3, taus, flux), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_set_thickness(dom, 0), PPS_ERR_ARGUMENT);
    assert_int_equal(pps_dom_set_thickness(dom, NOT_A_NUMBER), PPS_ERR_ARGUMENT);
    pps_dom_free(dom);
}

static void models_refuse_output_before_solve(void **state) {
    (void)state;
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t m = 0; m < n; m++) {
        double radiance[N_RADIANCES];
        pps_flux flux[3];
        pps_model *model;
        pps_model_create(table[m], &good, NULL, &model);
        assert_int_equal(pps_model_radiance(model, &grid, radiance), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_model_flux(model, 3, taus, flux), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_model_solve(model, 1, 0.5), PPS_OK);
        assert_int_equal(pps_model_solve(model, 1, 2), PPS_ERR_ARGUMENT);
        assert_int_equal(pps_model_flux(model, 3, taus, flux), PPS_ERR_ARGUMENT);
        pps_model_free(model);
    }
}

static void freeing_nothing_is_fine(void **state) {
    (void)state;
    pps_dom_free(NULL);
    pps_model_free(NULL);
}

/* ---- a whole job: create, solve, fluxes, radiances ---- */

typedef struct {
    pps_flux flux[3];
    double radiance[N_RADIANCES];
} answer;

/* What a method refuses is 0: radiances of one of fluxes only, all of one that is there to
 * fail. */
static pps_status output_of_model(pps_model *model, answer *out) {
    memset(out, 0, sizeof *out);
    pps_status status = pps_model_solve(model, 1, 0.5);
    status = status ? status : pps_model_flux(model, 3, taus, out->flux);
    status = status ? status : pps_model_radiance(model, &grid, out->radiance);
    return status == PPS_ERR_UNSUPPORTED ? PPS_OK : status;
}

static const pps_options coarse = {.tolerance = 1e-3, .photons = 100};

static pps_status run_model(const pps_method *method, answer *out) {
    pps_model *model = (pps_model *)(uintptr_t)1;
    pps_status status = pps_model_create(method, &good, &coarse, &model);
    if (status) {
        assert_null(model);
        return status;
    }
    status = output_of_model(model, out);
    pps_model_free(model);
    return status;
}

static pps_status output_of_dom(const pps_dom *dom, answer *out) {
    pps_status status = pps_dom_flux(dom, 3, taus, out->flux);
    return status ? status : pps_dom_radiance(dom, &grid, out->radiance);
}

static pps_status run_dom(answer *out) {
    pps_dom *dom = (pps_dom *)(uintptr_t)1;
    pps_status status = pps_dom_create(&good, &(pps_dom_opts){.streams = 16}, &dom);
    if (status) {
        assert_null(dom);
        return status;
    }
    status = pps_dom_solve(dom, 0.5);
    status = status ? status : output_of_dom(dom, out);
    pps_dom_free(dom);
    return status;
}

/* ---- memory ---- */

static void solver_survives_every_failing_allocation(void **state) {
    (void)state;
    answer out;
    pps_status status = PPS_ERR_MEMORY;
    long n = 0;
    for (; status; n++) {
        allocations_left = n;
        status = run_dom(&out);
        allocations_left = -1;
        assert_true(status == PPS_ERR_MEMORY || status == PPS_OK);
    }
    assert_true(n > 10);
}

static void every_method_survives_every_failing_allocation(void **state) {
    (void)state;
    size_t n_methods;
    const pps_method *const *table = pps_method_table(&n_methods);
    for (size_t m = 0; m < n_methods; m++) {
        answer out;
        pps_status status = PPS_ERR_MEMORY;
        long n = 0;
        for (; status; n++) {
            allocations_left = n;
            status = run_model(table[m], &out);
            allocations_left = -1;
            assert_true(status == PPS_ERR_MEMORY || status == PPS_OK);
        }
        assert_true(n > 2); /* the model and its state at least */
    }
}

/* A model that ran out of memory is as good as new. */
static void a_model_recovers_from_a_failed_allocation(void **state) {
    (void)state;
    answer fresh, again;
    const pps_method *exact = pps_method_find("exact");
    assert_int_equal(run_model(exact, &fresh), PPS_OK);
    pps_model *model;
    assert_int_equal(pps_model_create(exact, &good, &coarse, &model), PPS_OK);
    pps_status status = PPS_ERR_MEMORY;
    for (long n = 0; status; n += 7) {
        allocations_left = n;
        status = output_of_model(model, &again);
        allocations_left = -1;
        assert_true(status == PPS_ERR_MEMORY || status == PPS_OK);
    }
    pps_model_free(model);
    assert_memory_equal(&again, &fresh, sizeof fresh);
}

/* ---- threads ---- */

enum { N_THREADS = 2, REPEATS = 20 };

typedef struct {
    const pps_method *method; /* NULL: the shared solver */
    const pps_dom *shared;
    answer out[REPEATS];
    pps_status status;
} job;

static void *work(void *argument) {
    job *j = argument;
    j->status = PPS_OK;
    for (int i = 0; i < REPEATS && !j->status; i++) {
        j->status = j->method ? run_model(j->method, &j->out[i])
                              : output_of_dom(j->shared, &j->out[i]);
    }
    return NULL;
}

/* Both threads, and all their repeats, give `serial` to the last bit. */
static void assert_threads_give(const job *common, const answer *serial) {
    static job jobs[N_THREADS];
    pthread_t threads[N_THREADS];
    for (int i = 0; i < N_THREADS; i++) {
        jobs[i] = *common;
        assert_int_equal(pthread_create(&threads[i], NULL, work, &jobs[i]), 0);
    }
    for (int i = 0; i < N_THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    }
    for (int i = 0; i < N_THREADS; i++) {
        assert_int_equal(jobs[i].status, PPS_OK);
        for (int r = 0; r < REPEATS; r++) {
            assert_memory_equal(&jobs[i].out[r], serial, sizeof *serial);
        }
    }
}

static void threads_with_their_own_models_agree_with_one(void **state) {
    (void)state;
    static job common;
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t m = 0; m < n; m++) {
        answer serial;
        assert_int_equal(run_model(table[m], &serial), PPS_OK);
        common = (job){.method = table[m]};
        assert_threads_give(&common, &serial);
    }
}

static void threads_may_share_a_solved_solver(void **state) {
    (void)state;
    static job common;
    answer serial;
    pps_dom *dom;
    pps_dom_create(&good, &(pps_dom_opts){.streams = 16}, &dom);
    assert_int_equal(pps_dom_solve(dom, 0.5), PPS_OK);
    assert_int_equal(output_of_dom(dom, &serial), PPS_OK);
    common = (job){.shared = dom};
    assert_threads_give(&common, &serial);
    pps_dom_free(dom);
}

/* ---- silence ---- */

static void the_library_prints_nothing(void **state) {
    (void)state;
    int pipe_ends[2], out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
    assert_int_equal(pipe(pipe_ends), 0);
    fflush(NULL);
    dup2(pipe_ends[1], STDOUT_FILENO);
    dup2(pipe_ends[1], STDERR_FILENO);
    close(pipe_ends[1]);
    answer result;
    size_t n;
    const pps_method *const *table = pps_method_table(&n);
    for (size_t m = 0; m < n; m++) {
        run_model(table[m], &result);
    }
    pps_status refused = status_of_exact(&(pps_dom_opts){.streams = 7}, 0.5);
    fflush(NULL);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO); /* the last writing end of the pipe is closed */
    close(out);
    close(err);
    char text[64];
    ssize_t printed = read(pipe_ends[0], text, sizeof text);
    close(pipe_ends[0]);
    assert_int_equal(refused, PPS_ERR_ARGUMENT);
    assert_int_equal(printed, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(status_texts_are_distinct),
        cmocka_unit_test(version_has_three_parts),
        cmocka_unit_test(slabs_out_of_range_are_refused),
        cmocka_unit_test(every_maker_refuses_bad_slabs),
        cmocka_unit_test(beams_out_of_range_are_refused),
        cmocka_unit_test(every_method_refuses_bad_beams_and_thicknesses),
        cmocka_unit_test(grids_out_of_range_are_refused),
        cmocka_unit_test(depths_out_of_range_are_refused),
        cmocka_unit_test(solver_options_are_honoured_or_refused),
        cmocka_unit_test(method_options_are_honoured_or_refused),
        cmocka_unit_test(orders_not_asked_for_have_no_eigenvalues),
        cmocka_unit_test(output_before_solve_is_refused),
        cmocka_unit_test(models_refuse_output_before_solve),
        cmocka_unit_test(freeing_nothing_is_fine),
        cmocka_unit_test_teardown(solver_survives_every_failing_allocation,
                                  restore_allocation),
        cmocka_unit_test_teardown(every_method_survives_every_failing_allocation,
                                  restore_allocation),
        cmocka_unit_test_teardown(a_model_recovers_from_a_failed_allocation,
                                  restore_allocation),
        cmocka_unit_test(threads_with_their_own_models_agree_with_one),
        cmocka_unit_test(threads_may_share_a_solved_solver),
        cmocka_unit_test(the_library_prints_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
