/* The method "auto": model no more than the scene needs. It picks the cheapest method and
 * setting whose error meets the tolerance.
 *
 * How big an error is comes from a table made by running every candidate over a grid of
 * slabs (data/auto_errors.csv; make_auto_table.c says how). Between grid lines it is taken
 * two thirds of the way from the interpolated to the largest of the surrounding corners:
 * halfway is wrong once in a hundred, the largest costs twice as much. Where the table does
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
    double cost;
} candidate[] = {
#define ROW(name, streams, cost) {name, streams, cost},
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

/* An axis of the grid and where errors are about linear between its lines. */
typedef struct {
    int n;
    const double *line;
    double (*scale)(double);
} axis;

static double plain(double x) { return x; }

/* Shares of light lost, down to where thickness and not absorption ends it. */
static double lost(double albedo) { return -log(1 - albedo + 1e-4); }

static const axis axes[] = {{PPS_AUTO_N_ALBEDO, pps_auto_albedo, lost},
                            {PPS_AUTO_N_G, pps_auto_g, plain},
                            {PPS_AUTO_N_THICKNESS, pps_auto_thickness, log},
                            {PPS_AUTO_N_MU0, pps_auto_mu0, plain}};
enum { ALBEDO, G, THICKNESS, MU0, N_AXES };

/* The grid lines about a case, and its share of the way from the lower to the upper. */
typedef struct {
    int low[N_AXES], high[N_AXES];
    double share[N_AXES];
} cell;

/* False where x is outside the grid. */
static bool bracket(const axis *a, double x, int *low, int *high, double *share) {
    if (!(x >= a->line[0] && x <= a->line[a->n - 1])) {
        return false;
    }
    *low = 0;
    while (*low + 1 < a->n && a->line[*low + 1] <= x) {
        (*low)++;
    }
    *high = a->line[*low] == x ? *low : *low + 1;
    double from = a->scale(a->line[*low]), to = a->scale(a->line[*high]);
    *share = *high > *low ? (a->scale(x) - from) / (to - from) : 0;
    return true;
}

static bool find_cell(const automatic *a, double thickness, double mu0, cell *c) {
    double last = pps_auto_thickness[PPS_AUTO_N_THICKNESS - 1];
    double x[N_AXES] = {a->slab.albedo, a->slab.g, fmin(thickness, last), mu0};
    for (int i = 0; i < N_AXES; i++) {
        if (!bracket(&axes[i], x[i], &c->low[i], &c->high[i], &c->share[i])) {
            return false;
        }
    }
    if (x[ALBEDO] > 0 && pps_auto_albedo[c->low[ALBEDO]] == 0) {
        c->low[ALBEDO] = c->high[ALBEDO]; /* without scattering nothing has an error */
    }
    return true;
}

static const char *corner(const cell *c, int which, int metric) {
    int row = 0;
    for (int i = 0; i < N_AXES; i++) {
        row = row * axes[i].n + (which >> i & 1 ? c->high[i] : c->low[i]);
    }
    return table[row][metric];
}

static double weight(const cell *c, int which) {
    double product = 1;
    for (int i = 0; i < N_AXES; i++) {
        product *= which >> i & 1 ? c->share[i] : 1 - c->share[i];
    }
    return product;
}

/* The error of a candidate in fifths of a decade; above all where it cannot. */
static double level_of(const cell *c, int index, int metric) {
    double worst = PPS_AUTO_LOWEST, mean = 0;
    for (int which = 0; which < 1 << N_AXES; which++) {
        char code = corner(c, which, metric)[index];
        if (code == '~') {
            return HUGE_VAL;
        }
        worst = fmax(worst, pps_auto_level(code));
        mean += weight(c, which) * pps_auto_level(code);
    }
    return (2 * worst + mean) / 3;
}

static int choose(automatic *a, double thickness, double mu0) {
    cell c;
    int chosen = FALLBACK, metric = (int)a->opts.tolerance_of;
    double wanted = PPS_AUTO_PER_DECADE * log10(a->opts.tolerance) + 1e-9;
    a->bound = (double)NAN;
    if (a->opts.tolerance < 1e-6 || !find_cell(a, thickness, mu0, &c)) {
        return FALLBACK;
    }
    for (int i = 0; i < PPS_AUTO_N_CANDIDATES; i++) {
        double level = level_of(&c, i, metric);
        if (level <= wanted &&
            (chosen == FALLBACK || candidate[i].cost < candidate[chosen].cost)) {
            a->bound = pow(10, level / PPS_AUTO_PER_DECADE);
            chosen = i;
        }
    }
    return chosen;
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
