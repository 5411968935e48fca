/* The method "exact": discrete ordinates with as many streams, nodes and orders as the
 * tolerance asks for.
 *
 * With a given number of streams it is one solve. With `auto` it climbs a ladder of stream
 * counts until neighbours agree to the tolerance, and returns the finest: their
 * difference is the error of the coarser one, so the estimate is on the safe side. The
 * ladder is entered where the answer is expected, from (albedo, g, tolerance) alone, so
 * that a case has one answer whatever was solved before it. Eigenproblems are kept for
 * all thicknesses and beams of the model.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/method.h"
#include "core/tolerance.h"
#include "solver/dom.h"

static const int ladder[] = {12,  16,  24,  32,  48,  64,  96,
                             128, 192, 256, 384, 512, 768, 1024};
enum { N_LADDER = sizeof ladder / sizeof ladder[0] };

static const double PI = 3.14159265358979323846;

/* With many azimuthal orders the last rungs would take minutes. */
enum { MOST_STREAMS_RADIANCE = 256 };

typedef struct {
    pps_slab slab;
    pps_options opts;
    double mu0;
    bool sky; /* isotropic light instead of the beam */
    /* More beams than one, at once (given streams only): */
    size_t n_beams;
    const double *beams;
    size_t n_orders_used;
    int *orders_used; /* of each beam */
    /* Solvers kept; a given number of streams uses kept[0]. */
    pps_dom *kept[N_LADDER][PPS_NODES_GRADED + 1];
    pps_info info;
} exact;

static pps_status exact_init(void *state, const pps_slab *slab,
                             const pps_options *opts) {
    exact *e = state;
    e->slab = *slab;
    e->opts = *opts;
    e->info.error_estimate = (double)NAN;
    if (opts->delta_m == PPS_DELTA_M_ON && slab->g < 0) {
        return PPS_ERR_UNSUPPORTED;
    }
    return PPS_OK;
}

static void exact_clear(void *state) {
    exact *e = state;
    free(e->orders_used);
    for (int i = 0; i < N_LADDER; i++) {
        for (int nodes = 0; nodes <= PPS_NODES_GRADED; nodes++) {
            pps_dom_free(e->kept[i][nodes]);
        }
    }
}

static pps_status exact_solve(void *state, double thickness, double mu0) {
    exact *e = state;
    e->slab.thickness = thickness;
    e->mu0 = mu0;
    e->sky = false;
    e->n_beams = 1;
    return PPS_OK;
}

static pps_status exact_solve_beams(void *state, double thickness, size_t n,
                                    const double *mu0) {
    exact *e = state;
    if (e->opts.streams == 0) {
        return PPS_ERR_UNSUPPORTED; /* each beam climbs by itself */
    }
    if (n > e->n_orders_used) {
        int *orders = realloc(e->orders_used, n * sizeof *orders);
        if (!orders) {
            return PPS_ERR_MEMORY;
        }
        e->orders_used = orders;
        e->n_orders_used = n;
    }
    e->slab.thickness = thickness;
    e->beams = mu0;
    e->sky = false;
    e->n_beams = n;
    for (size_t b = 0; b < n; b++) {
        e->orders_used[b] = 1;
    }
    return PPS_OK;
}

static pps_status exact_solve_sky(void *state, double thickness) {
    exact *e = state;
    e->slab.thickness = thickness;
    e->mu0 = 1;
    e->sky = true;
    e->n_beams = 1;
    return PPS_OK;
}

static pps_nodes nodes_of(const exact *e, int streams) {
    if (e->opts.delta_m == PPS_DELTA_M_OFF) {
        return PPS_NODES_GAUSS;
    }
    return e->opts.nodes != PPS_NODES_AUTO ? e->opts.nodes
                                           : pps_dom_choose_nodes(&e->slab, streams);
}

/* Is the solver solved, to so many orders, for these beams? */
static bool solved_for(const pps_dom *dom, bool sky, size_t n, const double *mu0,
                       int orders) {
    bool same = dom->beams.n == n && dom->beams.sky == sky, azimuth = false;
    for (size_t b = 0; b < n && same && !sky; b++) {
        same = dom->beams.mu0[b] == mu0[b];
        azimuth = azimuth || mu0[b] < 1;
    }
    return same && (!azimuth || dom->n_solved >= orders ||
                    dom->n_solved == dom->discrete.n_moments);
}

/* The solver of a rung with at least so many orders, made and solved for the present slab
 * and n beams. */
static pps_status rung_solve_beams(exact *e, int index, int streams, int orders,
                                   double azimuth, size_t n, const double *mu0,
                                   pps_dom **out) {
    pps_nodes nodes = nodes_of(e, streams);
    pps_dom **kept = &e->kept[index][nodes];
    pps_status status = PPS_OK;
    if (!*kept) {
        pps_dom_opts opts = {.streams = streams,
                             .nodes = nodes,
                             .delta_m = e->opts.delta_m,
                             .orders = 1,
                             .tolerance = azimuth};
        status = pps_dom_create(&e->slab, &opts, kept);
    } else if ((*kept)->slab.thickness != e->slab.thickness) {
        status = pps_dom_set_thickness(*kept, e->slab.thickness);
    }
    if (!status) {
        status = pps_dom_want_orders(*kept, orders, azimuth);
    }
    if (status) {
        return status;
    }
    *out = *kept;
    if (solved_for(*kept, e->sky, n, mu0, orders)) {
        return PPS_OK;
    }
    return e->sky ? pps_dom_solve_sky(*kept) : pps_dom_solve_beams(*kept, n, mu0);
}

static pps_status rung_solve(exact *e, int index, int streams, int orders,
                             double azimuth, pps_dom **out) {
    return rung_solve_beams(e, index, streams, orders, azimuth, 1, &e->mu0, out);
}

/* What is asked of a rung: a radiance or fluxes, as n plain numbers. */
typedef struct {
    const pps_grid *at; /* NULL for fluxes */
    size_t n_tau;
    const double *tau;
    size_t n;
} request;

static pps_status rung_fluxes(exact *e, int index, int streams, const request *what,
                              pps_flux *flux) {
    pps_dom *dom;
    pps_status status = rung_solve(e, index, streams, 1, 0, &dom);
    if (!status) {
        status = pps_dom_flux(dom, what->n_tau, what->tau, flux);
        e->info.orders = 1;
    }
    return status;
}

/* As many orders as g and the tolerance ask for, doubled while the last ones still add. */
static pps_status rung_radiance(exact *e, int index, int streams, double azimuth,
                                const request *what, double *radiance) {
    int orders = e->mu0 == 1 ? 1 : pps_dom_orders_for(e->slab.g, azimuth, streams);
    for (;; orders *= 2) {
        pps_dom *dom;
        double rest;
        pps_status status = rung_solve(e, index, streams, orders, azimuth, &dom);
        if (status) {
            return status;
        }
        int used = orders < dom->n_orders ? orders : dom->n_orders;
        status = pps_dom_radiance_orders(dom, 0, 1, used, what->at, radiance, &rest);
        e->info.orders = used;
        if (status || rest <= 10 * azimuth) {
            return status;
        }
    }
}

static void describe(exact *e, int streams) {
    e->info.streams = streams;
    e->info.nodes = nodes_of(e, streams);
    e->info.delta_m = e->opts.delta_m != PPS_DELTA_M_OFF && e->slab.g > 0;
}

/* The answer of one rung as numbers, and what it used. */
static pps_status rung_answer(exact *e, int index, int streams, double azimuth,
                              const request *what, double *answer) {
    describe(e, streams);
    return what->at ? rung_radiance(e, index, streams, azimuth, what, answer)
                    : rung_fluxes(e, index, streams, what, (pps_flux *)(void *)answer);
}

/* Where to enter the ladder. Fitted to where `exact` meets its tolerance over g 0..0.95
 * and thickness 0.01..inf (tests/test_auto.c shows that it does). */
static int first_rung(const exact *e) {
    double digits = -log10(e->opts.tolerance), g = fabs(e->slab.g);
    double expected = 8 * digits - 16;
    if (g > 0) {
        expected = fmax(expected, 0.75 * digits * log(10.0) / -log(g));
    }
    int index = 0;
    while (index + 2 < N_LADDER && ladder[index + 1] <= 0.8 * expected) {
        index++;
    }
    return index;
}

static int last_rung(const request *what) {
    int last = N_LADDER - 1;
    while (what->at && ladder[last] > MOST_STREAMS_RADIANCE) {
        last--;
    }
    return last;
}

/* Rungs that must agree. In thin slabs and under grazing beams convergence is slow and not
 * even, as the nodes pass through directions mu ~ thickness or mu ~ mu0: two neighbours
 * may agree by chance, three hardly do (tests/test_auto_random.c). */
enum { MOST_AGREEING = 3 };
static int agreeing_rungs(const exact *e) {
    return e->slab.thickness < 0.1 || e->mu0 < 0.05 ? 3 : 2;
}

/* The largest difference of the newest answer to those before it; answer n is kept in
 * kept[n % MOST_AGREEING]. */
static double disagreement(const request *what, double *const *kept, int newest,
                           int agreeing) {
    double worst = 0;
    for (int back = 1; back < agreeing; back++) {
        worst = fmax(worst, pps_tolerance_missed(what->at, what->n,
                                                 kept[(newest - back) % MOST_AGREEING],
                                                 kept[newest % MOST_AGREEING]));
    }
    return worst;
}

/* Climb the ladder; on success kept[*newest % MOST_AGREEING] is the answer. */
static pps_status climb(exact *e, const request *what, double *const *kept,
                        int *newest) {
    int last = last_rung(what), agreeing = agreeing_rungs(e), n_answers = 0;
    int first = first_rung(e);
    double azimuth = e->opts.tolerance / 100;
    for (int i = first < last ? first : last - 1; i <= last; i++) {
        pps_status status = rung_answer(e, i, ladder[i], azimuth, what,
                                        kept[n_answers % MOST_AGREEING]);
        if (status == PPS_ERR_INDEFINITE) {
            n_answers = 0; /* more streams may mend it */
            continue;
        }
        if (status) {
            return status;
        }
        *newest = n_answers++;
        if (n_answers >= agreeing) {
            e->info.error_estimate = disagreement(what, kept, *newest, agreeing);
            if (e->info.error_estimate <= e->opts.tolerance) {
                return PPS_OK;
            }
        }
    }
    return n_answers > 0 ? PPS_ERR_TOLERANCE : PPS_ERR_INDEFINITE;
}

/* ---- many beams of given streams ---- */

static const double TO_ROUNDING = 1e-15; /* the azimuth series of given streams */

/* Beam b by itself, when its azimuth series takes more orders than were expected. */
static pps_status beam_again(exact *e, size_t b, const request *what, double *answer) {
    e->mu0 = e->beams[b];
    pps_status status = rung_answer(e, 0, e->opts.streams, TO_ROUNDING, what, answer);
    e->orders_used[b] = e->info.orders;
    return status;
}

static pps_status radiances_at_once(exact *e, const request *what, double *radiance) {
    int streams = e->opts.streams;
    int orders = pps_dom_orders_for(e->slab.g, TO_ROUNDING, streams);
    double *rest = malloc(e->n_beams * sizeof *rest);
    pps_dom *dom;
    if (!rest) {
        return PPS_ERR_MEMORY;
    }
    pps_status status = rung_solve_beams(e, 0, streams, orders, TO_ROUNDING, e->n_beams,
                                         e->beams, &dom);
    if (!status) {
        int used = orders < dom->n_orders ? orders : dom->n_orders;
        /* The directions of a sweep stay the same. */
        status = pps_view_is_of(dom->view, what->at->n_mu, what->at->mu)
                     ? PPS_OK
                     : pps_dom_set_directions(dom, what->at->n_mu, what->at->mu);
        if (!status) {
            status = pps_dom_radiance_orders(dom, 0, e->n_beams, used, what->at,
                                             radiance, rest);
        }
        for (size_t b = 0; b < e->n_beams && !status; b++) {
            e->orders_used[b] = e->beams[b] == 1 ? 1 : used;
            if (rest[b] > 10 * TO_ROUNDING) {
                status = beam_again(e, b, what, radiance + b * what->n);
            }
        }
    }
    free(rest);
    return status;
}

static pps_status fluxes_at_once(exact *e, const request *what, pps_flux *flux) {
    pps_dom *dom;
    pps_status status =
        rung_solve_beams(e, 0, e->opts.streams, 1, 0, e->n_beams, e->beams, &dom);
    for (size_t b = 0; b < e->n_beams; b++) {
        e->orders_used[b] = 1;
    }
    return status ? status : pps_dom_flux(dom, what->n_tau, what->tau, flux);
}

/* ---- without scattering ---- */

/* At albedo 0 there is the beam and nothing else: no streams, no error. (The sky is left
 * to the streams, as its fluxes are integrals over directions.) */
static void beams_alone(exact *e, const request *what, double *answer) {
    pps_flux *flux = (pps_flux *)(void *)answer;
    if (e->opts.streams > 0) {
        describe(e, e->opts.streams);
        e->info.orders = 1;
    } else {
        e->info = (pps_info){.error_estimate = 0};
    }
    if (what->at) {
        memset(answer, 0, e->n_beams * what->n * sizeof *answer);
        return;
    }
    for (size_t b = 0; b < e->n_beams; b++) {
        double mu0 = e->n_beams > 1 ? e->beams[b] : e->mu0;
        for (size_t k = 0; k < what->n_tau; k++) {
            double direct = exp(-what->tau[k] / mu0);
            *flux++ = (pps_flux){.direct = mu0 * direct, .mean = direct / (4 * PI)};
        }
    }
}

/* ---- all together ---- */

static pps_status produce(exact *e, const request *what, double *answer) {
    e->info.error_estimate = (double)NAN;
    if (e->slab.albedo == 0 && !e->sky) {
        beams_alone(e, what, answer);
        return PPS_OK;
    }
    if (e->opts.streams > 0) {
        /* Given streams: the azimuth series to rounding. */
        if (e->n_beams > 1) {
            describe(e, e->opts.streams);
            return what->at ? radiances_at_once(e, what, answer)
                            : fluxes_at_once(e, what, (pps_flux *)(void *)answer);
        }
        return rung_answer(e, 0, e->opts.streams, TO_ROUNDING, what, answer);
    }
    double *memory = malloc((MOST_AGREEING * what->n + 1) * sizeof *memory);
    if (!memory) {
        return PPS_ERR_MEMORY;
    }
    double *kept[MOST_AGREEING];
    for (size_t i = 0; i < MOST_AGREEING; i++) {
        kept[i] = memory + i * what->n;
    }
    int newest = 0;
    pps_status status = climb(e, what, kept, &newest);
    if (!status) {
        memcpy(answer, kept[newest % MOST_AGREEING], what->n * sizeof *answer);
    }
    free(memory);
    return status;
}

static pps_status exact_radiance(void *state, const pps_grid *at, double *radiance) {
    request what = {.at = at, .n = at->n_tau * at->n_mu * at->n_phi};
    return produce(state, &what, radiance);
}

static pps_status exact_flux(void *state, size_t n, const double *tau, pps_flux *flux) {
    request what = {.n_tau = n, .tau = tau, .n = n * sizeof *flux / sizeof(double)};
    return produce(state, &what, (double *)(void *)flux);
}

static void exact_query(const void *state, pps_info *info) {
    *info = ((const exact *)state)->info;
}

static void exact_query_beam(const void *state, size_t b, pps_info *info) {
    const exact *e = state;
    *info = e->info;
    info->orders = b < e->n_beams ? e->orders_used[b] : 0;
}

static const pps_method_ops ops = {
    .state_size = sizeof(exact),
    .init = exact_init,
    .solve = exact_solve,
    .solve_sky = exact_solve_sky,
    .solve_beams = exact_solve_beams,
    .query_beam = exact_query_beam,
    .radiance = exact_radiance,
    .flux = exact_flux,
    .query = exact_query,
    .clear = exact_clear,
};

const pps_method pps_method_exact = {
    .name = "exact",
    .cost = "eigenproblems per (albedo, g), then microseconds to milliseconds a case",
    .summary = "discrete ordinates (SPP Eq. 7), streams chosen to the tolerance",
    .limits = "refuses where 256 streams (fluxes: 1024) miss the tolerance, as 1e-6 "
              "for radiances at g = 0.95",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .shares_beams = true,
    .ops = &ops,
};
