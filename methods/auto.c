/* The method "auto": model no more than the scene needs. It picks the cheapest method and
 * setting whose error meets the tolerance.
 *
 * How big an error is comes from a table made by running every candidate over a grid of
 * slabs (data/auto_errors.csv; make_auto_table.c says how). Between grid lines the largest
 * of the surrounding corners is taken, which is the safety margin. Where the table does
 * not reach (g > 0.9, thickness < 0.01, mu0 < 0.05, sky or ground, tolerances below 1e-6)
 * or nothing in it is good enough, it is `exact` with its own estimate.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "core/method.h"
#include "methods/auto_grid.h"

static const char *const table[PPS_AUTO_N_CELLS][PPS_AUTO_METRICS] = {
#include "auto_table.inc"
};

static const struct {
    const char *name;
    int streams;
} candidate[] = {
#define ROW(name, streams) {name, streams},
    PPS_AUTO_CANDIDATES(ROW)
#undef ROW
};

enum { FALLBACK = PPS_AUTO_N_CANDIDATES };

typedef struct {
    pps_slab slab;
    pps_options opts;
    pps_model *model[PPS_AUTO_N_CANDIDATES + 1]; /* made when first wanted */
    int chosen;
    double bound; /* of the error, from the table; NAN when `exact` estimates itself */
} automatic;

static pps_status auto_init(void *state, const pps_slab *slab,
                            const pps_options *opts) {
    automatic *a = state;
    a->slab = *slab;
    a->opts = *opts;
    a->opts.light = (pps_light){.beam = 1}; /* sky and ground come from outside */
    return PPS_OK;
}

static void auto_clear(void *state) {
    automatic *a = state;
    for (int c = 0; c <= FALLBACK; c++) {
        pps_model_free(a->model[c]);
    }
}

/* The grid lines below and above x: *low, and *low + 1 unless x lies on a line. False
 * where x is outside. */
static bool bracket(int n, const double *line, double x, int *low, int *high) {
    if (!(x >= line[0] && x <= line[n - 1])) {
        return false;
    }
    *low = 0;
    while (*low + 1 < n && line[*low + 1] <= x) {
        (*low)++;
    }
    *high = line[*low] == x ? *low : *low + 1;
    return true;
}

typedef struct {
    int low[4], high[4];
} cell;

static bool find_cell(const automatic *a, double thickness, double mu0, cell *c) {
    double last = pps_auto_thickness[PPS_AUTO_N_THICKNESS - 1];
    return bracket(PPS_AUTO_N_ALBEDO, pps_auto_albedo, a->slab.albedo, &c->low[0],
                   &c->high[0]) &&
           bracket(PPS_AUTO_N_G, pps_auto_g, a->slab.g, &c->low[1], &c->high[1]) &&
           bracket(PPS_AUTO_N_THICKNESS, pps_auto_thickness, fmin(thickness, last),
                   &c->low[2], &c->high[2]) &&
           bracket(PPS_AUTO_N_MU0, pps_auto_mu0, mu0, &c->low[3], &c->high[3]);
}

static const char *corner(const cell *c, int which, int metric) {
    int at[4];
    for (int axis = 0; axis < 4; axis++) {
        at[axis] = which >> axis & 1 ? c->high[axis] : c->low[axis];
    }
    int row = ((at[0] * PPS_AUTO_N_G + at[1]) * PPS_AUTO_N_THICKNESS + at[2]) *
                  PPS_AUTO_N_MU0 +
              at[3];
    return table[row][metric];
}

/* The largest error of a candidate on the corners, in fifths of a decade. */
static int worst_level(const cell *c, int index, int metric) {
    int worst = PPS_AUTO_LOWEST;
    for (int which = 0; which < 16; which++) {
        char code = corner(c, which, metric)[index];
        int level = code == '~' ? PPS_AUTO_HIGHEST + 1 : pps_auto_level(code);
        worst = level > worst ? level : worst;
    }
    return worst;
}

static int choose(automatic *a, double thickness, double mu0) {
    cell c;
    int metric = (int)a->opts.tolerance_of;
    int wanted = (int)floor(PPS_AUTO_PER_DECADE * log10(a->opts.tolerance) + 1e-9);
    a->bound = (double)NAN;
    if (a->opts.tolerance < 1e-6 || !find_cell(a, thickness, mu0, &c)) {
        return FALLBACK;
    }
    for (int i = 0; i < PPS_AUTO_N_CANDIDATES; i++) {
        int level = worst_level(&c, i, metric);
        if (level <= wanted) {
            a->bound = pow(10, (double)level / PPS_AUTO_PER_DECADE);
            return i;
        }
    }
    return FALLBACK;
}

/* The model of a candidate. */
static pps_status obtain(automatic *a, int index) {
    if (a->model[index]) {
        return PPS_OK;
    }
    pps_options opts = a->opts;
    if (index != FALLBACK) {
        opts.streams = candidate[index].streams;
    }
    const pps_method *method =
        pps_method_find(index == FALLBACK ? "exact" : candidate[index].name);
    return method ? pps_model_create(method, &a->slab, &opts, &a->model[index])
                  : PPS_ERR_UNSUPPORTED;
}

static pps_status auto_solve(void *state, double thickness, double mu0) {
    automatic *a = state;
    a->chosen = choose(a, thickness, mu0);
    pps_status status = obtain(a, a->chosen);
    return status ? status : pps_model_solve(a->model[a->chosen], thickness, mu0);
}

static pps_status auto_radiance(void *state, const pps_grid *at, double *radiance) {
    automatic *a = state;
    return pps_model_radiance(a->model[a->chosen], at, radiance);
}

static pps_status auto_flux(void *state, size_t n, const double *tau, pps_flux *flux) {
    automatic *a = state;
    return pps_model_flux(a->model[a->chosen], n, tau, flux);
}

static void auto_query(const void *state, pps_info *info) {
    const automatic *a = state;
    if (!a->model[a->chosen]) {
        return;
    }
    pps_model_query(a->model[a->chosen], info);
    info->used =
        pps_method_find(a->chosen == FALLBACK ? "exact" : candidate[a->chosen].name);
    if (a->chosen != FALLBACK) {
        info->error_estimate = a->bound;
        info->by_table = true;
    }
}

static const pps_method_ops ops = {.state_size = sizeof(automatic),
                                   .init = auto_init,
                                   .solve = auto_solve,
                                   .radiance = auto_radiance,
                                   .flux = auto_flux,
                                   .query = auto_query,
                                   .clear = auto_clear};

const pps_method pps_method_auto = {
    .name = "auto",
    .cost = "that of the method it picks",
    .summary =
        "the cheapest method whose error meets the tolerance, by a table of errors",
    .limits = "the error is rms_rel (or what --tol-of says) over the depths and "
              "directions of the table, met in 99 % of cases",
    .fields = true,
    .fluxes = true,
    .half_space = true,
    .ops = &ops,
};
