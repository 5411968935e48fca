/* Doubling for one azimuthal order, and the field inside.
 *
 *   R, T     diffuse reflection and transmission: n_all rows (directions out), n + 1
 *            columns (n nodes in, weights included; the last one is the beam)
 *   decay    exp(-thickness / mu) of each direction, kept apart from T
 *   e        emission: what leaves either side of a layer that glows like the black
 *            body around it; (R + T + decay + e) 1 = 1 at m = 0
 *
 * Two equal layers (Hansen & Travis: HT74): with D = decay, for every column
 *   Y = T + R U, U = R (Y + D)         down and up between the two
 *   R' = R + (T + D) U,  T' = (T + D)(Y + D) - D D,  e' = e + (T + D)(1 - R)^-1 e.
 * At m = 0 every term is positive, and 1 - R R is solved through its row sums
 * (1 + R)(T 1 + D + e) rather than its diagonal. So nothing cancels: a conservative slab
 * keeps its digits at any thickness.
 *
 * The thin layer at the start has first and second order scattering; what is left out is
 * of relative size thickness^2.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/layers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/legendre.h"
#include "reference/linear.h"

static const double PI = 3.14159265358979323846;

typedef struct {
    double *r, *t;       /* n_all x (n + 1) */
    double *decay;       /* n_all, then that of the beam's column */
    double *e;           /* n */
    double *factors;     /* n x n: 1 - R R, factored when the layer is doubled */
    int *pivot;          /* n */
    bool opaque, shared; /* nothing comes through; the same as the layer below */
} layer;

enum { MOST_LEVELS = 1100 };

struct pps_stack {
    pps_stack_problem problem;
    const pps_directions *at;
    int n, n_all, columns;
    double thickness;  /* of the whole; finite */
    double thin;       /* thickness / 2^(n_levels - 1) */
    double *same;      /* p(mu_i, mu_c) of order m: n_all x columns */
    double *opposite;  /* p(-mu_i, mu_c) */
    double *rate;      /* 1/mu of all directions, then of the beam */
    double *in_weight; /* of a column: node weights, then the beam */
    double *half;      /* e^(-t/(2 mu)) of a thin layer t, as rate */
    double *third;     /* e^(-t/(3 mu)) */
    double *work;
    double *memory; /* all of the above and the layers, one after the other */
    size_t room, taken;
    int n_levels;
    layer level[MOST_LEVELS];
};

static size_t size_of(int rows, int columns) { return (size_t)rows * (size_t)columns; }

pps_stack *pps_stack_new(void) { return calloc(1, sizeof(pps_stack)); }

void pps_stack_free(pps_stack *s) {
    if (s) {
        free(s->memory);
        free(s);
    }
}

/* The next n doubles of the stack's memory. */
static double *take(pps_stack *s, size_t n) {
    double *at = s->memory + s->taken;
    s->taken += n;
    return at;
}

/* Of one layer: R, T, decay, e, factors and the pivots, as doubles. */
static size_t layer_size(const pps_stack *s) {
    size_t n = (size_t)s->n;
    return 2 * size_of(s->n_all, s->columns) + (size_t)s->n_all + 1 + n + n * n + n;
}

static layer take_layer(pps_stack *s) {
    size_t block = size_of(s->n_all, s->columns), n = (size_t)s->n;
    layer l = {.r = take(s, layer_size(s))};
    l.t = l.r + block;
    l.decay = l.t + block;
    l.e = l.decay + s->n_all + 1;
    l.factors = l.e + n;
    l.pivot = (int *)(void *)(l.factors + n * n);
    return l;
}

/* ---- the phase function ---- */

/* Where the beam's column finds its decay and rate. */
static int direction_of(const pps_stack *s, int column) {
    return column < s->n ? column : s->n_all;
}

static double mu_of_column(const pps_stack *s, int c) {
    return c < s->n ? s->at->mu[c] : s->problem.mu0;
}

/* Rows of P_l^m, those with l + m even and odd apart; odd ones change sign with mu. */
static void legendre_rows(const pps_stack *s, int n_rows, int column, double *even,
                          double *odd, double *p) {
    int m = s->problem.m, n_moments = s->problem.n_moments;
    double g = s->problem.slab.g, first = pow(g, m);
    for (int i = 0; i < n_rows; i++) {
        double power = first;
        pps_legendre(m, n_moments, column ? mu_of_column(s, i) : s->at->mu[i], p);
        for (int l = m; l < n_moments; l++) {
            double *to = (l - m) % 2 ? odd : even;
            to[i + (l - m) / 2 * n_rows] =
                p[l - m] * (column ? (2 * l + 1) * power : 1);
            power *= g;
        }
    }
}

/* Of the Legendre functions that phase_fill puts where the layers go later. */
static size_t phase_size(const pps_stack *s) {
    size_t rows = (size_t)s->n_all + (size_t)s->columns;
    size_t count = (size_t)(s->problem.n_moments - s->problem.m);
    return 2 * rows * ((count + 1) / 2) + count;
}

static void phase_fill(pps_stack *s) {
    int rows = s->n_all, columns = s->columns;
    int half = (s->problem.n_moments - s->problem.m + 1) / 2;
    double *even = s->memory + s->taken, *odd = even + size_of(rows, half);
    double *even_in = odd + size_of(rows, half);
    double *odd_in = even_in + size_of(columns, half);
    double *p = odd_in + size_of(columns, half);
    memset(even, 0, phase_size(s) * sizeof *even);
    legendre_rows(s, rows, 0, even, odd, p);
    legendre_rows(s, columns, 1, even_in, odd_in, p);
    pps_linear_outer(rows, columns, half, even, rows, even_in, columns, s->same, rows);
    pps_linear_outer(rows, columns, half, odd, rows, odd_in, columns, s->opposite,
                     rows);
    for (size_t i = 0; i < size_of(rows, columns); i++) {
        double sum = s->same[i] + s->opposite[i];
        s->opposite[i] = s->same[i] - s->opposite[i];
        s->same[i] = sum;
    }
}

/* ---- the thin layer ---- */

/* sinh(x)/x for |x| <= 0.1. */
static double sinhc(double x) {
    double x2 = x * x;
    return 1 + x2 / 6 * (1 + x2 / 20 * (1 + x2 / 42));
}

/* Scattered once: with a = 1/mu out, b = 1/mu in,
 * R: a int_0^t e^(-(a + b) x) dx,  T: a int_0^t e^(-b x) e^(-a (t - x)) dx. */
static void thin_once(const pps_stack *s, double t, layer *l) {
    for (int c = 0; c < s->columns; c++) {
        int d = direction_of(s, c);
        double b = s->rate[d];
        double in = s->problem.slab.albedo / 2 * s->in_weight[c] * t * s->half[d];
        for (int i = 0; i < s->n_all; i++) {
            double a = s->rate[i], out = in * a * s->half[i];
            size_t k = (size_t)i + size_of(s->n_all, c);
            l->r[k] = out * s->opposite[k] * sinhc((a + b) * t / 2);
            l->t[k] = out * s->same[k] * sinhc((a - b) * t / 2);
        }
    }
}

/* P diag(weight/mu e^(-t/(3 mu))) Q for the light between the two scatterings. */
static void between(const pps_stack *s, const double *p, const double *q,
                    double *scaled, double *product) {
    for (int c = 0; c < s->columns; c++) {
        for (int k = 0; k < s->n; k++) {
            scaled[k + c * s->n] = s->in_weight[k] * s->rate[k] * s->third[k] *
                                   q[(size_t)k + size_of(s->n_all, c)];
        }
    }
    pps_linear_multiply(s->n_all, s->columns, s->n, p, s->n_all, scaled, s->n, 0,
                        product, s->n_all);
}

/* A way of being scattered twice: forwards or not, first and second time, and how long the
 * ways in and out are on average, in thirds of the thickness. */
typedef struct {
    bool back_first, back_second;
    int out, in;
} two_scatterings;

static void thin_one_way(const pps_stack *s, double t, const two_scatterings *way,
                         layer *l) {
    double *scaled = s->work, *product = scaled + size_of(s->n, s->columns);
    double *into = way->back_first == way->back_second ? l->t : l->r;
    double q = s->problem.slab.albedo / 2, size = q * q * t * t / 2;
    between(s, way->back_second ? s->opposite : s->same,
            way->back_first ? s->opposite : s->same, scaled, product);
    for (int c = 0; c < s->columns; c++) {
        double third = s->third[direction_of(s, c)];
        double in = size * s->in_weight[c] * third * (way->in == 2 ? third : 1);
        for (int i = 0; i < s->n_all; i++) {
            double out = s->rate[i] * s->third[i] * (way->out == 2 ? s->third[i] : 1);
            size_t k = (size_t)i + size_of(s->n_all, c);
            into[k] += in * out * product[k];
        }
    }
}

static void thin_twice(const pps_stack *s, double t, layer *l) {
    static const two_scatterings ways[] = {{false, false, 1, 1},
                                           {true, true, 2, 2},
                                           {false, true, 2, 1},
                                           {true, false, 1, 2}};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        thin_one_way(s, t, &ways[i], l);
    }
}

/* Emission of the thin layer: unscattered and scattered once; and the diagonal of T such
 * that no energy is lost. */
static void thin_energy(const pps_stack *s, double t, layer *l) {
    double albedo = s->problem.slab.albedo;
    for (int i = 0; i < s->n; i++) {
        double a = s->rate[i], gap = -expm1(-a * t), scattered = 0, sum = 0;
        for (int k = 0; k < s->n; k++) {
            size_t ik = (size_t)i + size_of(s->n_all, k);
            scattered += s->in_weight[k] * (s->same[ik] + s->opposite[ik]) *
                         -expm1(-s->rate[k] * t / 2);
            sum += l->r[ik] + l->t[ik];
        }
        l->e[i] =
            (1 - albedo) * (gap + albedo / 2 * a * t * exp(-a * t / 2) * scattered);
        l->t[(size_t)i + size_of(s->n_all, i)] += gap - l->e[i] - sum;
    }
}

static void thin_layer(pps_stack *s, double t, bool twice, layer *l) {
    for (int i = 0; i <= s->n_all; i++) {
        s->half[i] = exp(-s->rate[i] * t / 2);
        s->third[i] = exp(-s->rate[i] * t / 3);
        l->decay[i] = exp(-s->rate[i] * t);
    }
    thin_once(s, t, l);
    if (twice) {
        thin_twice(s, t, l);
    }
    if (s->problem.m == 0) {
        thin_energy(s, t, l);
    }
}

/* ---- doubling ---- */

static double column_decay(const pps_stack *s, const layer *l, int c) {
    return l->decay[direction_of(s, c)];
}

/* v <- T 1 + decay + e over the nodes: 1 - R 1 without cancellation. */
static void not_reflected(const pps_stack *s, const layer *l, double *v) {
    for (int i = 0; i < s->n; i++) {
        v[i] = l->decay[i] + l->e[i];
    }
    for (int c = 0; c < s->n; c++) {
        for (int i = 0; i < s->n; i++) {
            v[i] += l->t[(size_t)i + size_of(s->n_all, c)];
        }
    }
}

/* Factor 1 - R R, given G = R R. */
static bool factor_between(const pps_stack *s, layer *l, const double *g, double *v) {
    int n = s->n;
    for (int c = 0; c < n; c++) {
        for (int i = 0; i < n; i++) {
            l->factors[i + c * n] = (i == c) - g[i + c * n];
        }
    }
    if (s->problem.m > 0) {
        return pps_linear_factor(n, l->factors, l->pivot);
    }
    double *excess = v + n;
    not_reflected(s, l, v);
    memcpy(excess, v, (size_t)n * sizeof *v);
    pps_linear_multiply(n, 1, n, l->r, s->n_all, v, n, 1, excess, n);
    return pps_linear_factor_excess(n, l->factors, excess, l->pivot);
}

static void double_emission(const pps_stack *s, const layer *l, layer *out, double *v) {
    int n = s->n;
    if (s->problem.m > 0) {
        return;
    }
    memcpy(v, l->e, (size_t)n * sizeof *v);
    pps_linear_multiply(n, 1, n, l->r, s->n_all, l->e, n, 1, v, n);
    pps_linear_solve(n, l->factors, l->pivot, 1, v, n);
    for (int i = 0; i < n; i++) {
        out->e[i] = l->e[i] + l->decay[i] * v[i];
    }
    pps_linear_multiply(n, 1, n, l->t, s->n_all, v, n, 1, out->e, n);
}

/* Y on the nodes: (1 - R R) Y = T + R R D. */
static bool light_between(const pps_stack *s, layer *l, double *g, double *y) {
    int n = s->n, all = s->n_all, columns = s->columns;
    pps_linear_multiply(n, columns, n, l->r, all, l->r, all, 0, g, n);
    if (!factor_between(s, l, g, y)) {
        return false;
    }
    for (int c = 0; c < columns; c++) {
        double decay = column_decay(s, l, c);
        for (int i = 0; i < n; i++) {
            y[(size_t)i + size_of(all, c)] =
                l->t[(size_t)i + size_of(all, c)] + g[i + c * n] * decay;
        }
    }
    pps_linear_solve(n, l->factors, l->pivot, columns, y, all);
    return true;
}

static bool opaque(const pps_stack *s, const layer *l) {
    const double nothing = 1e-280;
    for (size_t k = 0; k < size_of(s->n_all, s->columns); k++) {
        if (fabs(l->t[k]) > nothing) {
            return false;
        }
    }
    for (int i = 0; i <= s->n_all; i++) {
        if (l->decay[i] > nothing) {
            return false;
        }
    }
    return true;
}

/* *out <- two of *l. */
static bool double_layer(const pps_stack *s, layer *l, double thickness, layer *out) {
    int n = s->n, all = s->n_all, columns = s->columns;
    size_t block = size_of(all, columns);
    double *y = s->work, *u = y + block, *g = u + block;
    if (!light_between(s, l, g, y)) {
        return false;
    }
    for (int c = 0; c < columns; c++) { /* U = R (Y + D) */
        double decay = column_decay(s, l, c);
        for (int i = 0; i < all; i++) {
            size_t k = (size_t)i + size_of(all, c);
            u[k] = l->r[k] * decay;
        }
    }
    pps_linear_multiply(all, columns, n, l->r, all, y, all, 1, u, all);
    for (int c = 0; c < columns; c++) { /* Y = T + R U on the other directions */
        for (int i = n; i < all; i++) {
            size_t k = (size_t)i + size_of(all, c);
            y[k] = l->t[k];
        }
    }
    pps_linear_multiply(all - n, columns, n, l->r + n, all, u, all, 1, y + n, all);
    for (int c = 0; c < columns; c++) {
        double decay = column_decay(s, l, c);
        for (int i = 0; i < all; i++) {
            size_t k = (size_t)i + size_of(all, c);
            out->r[k] = l->r[k] + l->decay[i] * u[k];
            out->t[k] = l->t[k] * decay + l->decay[i] * y[k];
        }
    }
    pps_linear_multiply(all, columns, n, l->t, all, u, all, 1, out->r, all);
    pps_linear_multiply(all, columns, n, l->t, all, y, all, 1, out->t, all);
    double_emission(s, l, out, g);
    for (int i = 0; i <= all; i++) {
        out->decay[i] = exp(-s->rate[i] * thickness);
    }
    out->opaque = opaque(s, out);
    return true;
}

/* ---- the stack ---- */

/* Deep enough that what lies below cannot be seen from `deepest`: light falls off at
 * least as exp(-k tau), k = half the diffusion exponent, or, at albedo 1, as 1/tau. */
static double enough_for_infinity(const pps_stack_problem *p) {
    double co = 1 - p->slab.albedo;
    double k = 0.5 * fmin(1, sqrt(3 * co * (1 - p->slab.albedo * p->slab.g)));
    double reach = fmin(1e18 * (1 + p->deepest), 100 / k);
    return p->deepest + reach;
}

static int choose_levels(pps_stack *s) {
    double smallest = s->problem.mu0;
    for (int i = 0; i < s->n_all; i++) {
        smallest = fmin(smallest, s->at->mu[i]);
    }
    double thin = fmin(sqrt(s->problem.accuracy) / 20, smallest / 20);
    s->thickness = isinf(s->problem.slab.thickness) ? enough_for_infinity(&s->problem)
                                                    : s->problem.slab.thickness;
    int levels = 1;
    for (s->thin = s->thickness; s->thin > thin; s->thin /= 2) {
        levels++;
    }
    return levels;
}

/* False where 1 - R R cannot be factored. */
static bool build(pps_stack *s, int n_levels) {
    double thickness = s->thin;
    s->level[0] = take_layer(s);
    thin_layer(s, s->thin, true, &s->level[0]);
    for (s->n_levels = 1; s->n_levels < n_levels; s->n_levels++) {
        layer *below = &s->level[s->n_levels - 1], *next = &s->level[s->n_levels];
        thickness *= 2;
        if (below->shared) { /* opaque, and factored already */
            *next = *below;
            continue;
        }
        *next = take_layer(s);
        if (!double_layer(s, below, thickness, next)) {
            return false;
        }
        if (below->opaque) {
            *next = *below;
            next->shared = true;
        }
    }
    return true;
}

enum { FIELDS = 5 }; /* vectors that pps_stack_at works with */

static size_t work_size(const pps_stack *s) {
    return 2 * size_of(s->n_all, s->columns) + size_of(s->n, s->columns) +
           FIELDS * (size_t)s->n_all;
}

/* Memory for so many levels and the two layers that a depth may need; address space
 * only, where the upper ones turn out opaque. */
static bool provide(pps_stack *s, int levels) {
    size_t block = size_of(s->n_all, s->columns);
    size_t rest =
        2 * block + 3 * ((size_t)s->n_all + 1) + (size_t)s->columns + work_size(s);
    size_t layers = ((size_t)levels + 2) * layer_size(s), phase = phase_size(s);
    size_t room = rest + (layers > phase ? layers : phase);
    if (room > s->room) {
        free(s->memory);
        s->memory = malloc(room * sizeof *s->memory);
        s->room = s->memory ? room : 0;
    }
    s->taken = 0;
    return s->memory;
}

static void prepare(pps_stack *s) {
    size_t block = size_of(s->n_all, s->columns);
    s->same = take(s, block);
    s->opposite = take(s, block);
    s->rate = take(s, (size_t)s->n_all + 1);
    s->half = take(s, (size_t)s->n_all + 1);
    s->third = take(s, (size_t)s->n_all + 1);
    s->in_weight = take(s, (size_t)s->columns);
    s->work = take(s, work_size(s));
    for (int i = 0; i < s->n_all; i++) {
        s->rate[i] = 1 / s->at->mu[i];
    }
    s->rate[s->n_all] = 1 / s->problem.mu0;
    memcpy(s->in_weight, s->at->weight, (size_t)s->n * sizeof *s->in_weight);
    s->in_weight[s->n] = s->problem.beam * (s->problem.m == 0 ? 1 : 2) / (2 * PI);
    phase_fill(s);
}

pps_status pps_stack_build(pps_stack *s, const pps_stack_problem *problem,
                           const pps_directions *directions) {
    s->problem = *problem;
    s->at = directions;
    s->n = directions->n;
    s->n_all = directions->n_all;
    s->columns = s->n + 1;
    int levels = choose_levels(s);
    if (levels > MOST_LEVELS) {
        return PPS_ERR_UNSUPPORTED;
    }
    if (!provide(s, levels)) {
        return PPS_ERR_MEMORY;
    }
    prepare(s);
    return build(s, levels) ? PPS_OK : PPS_ERR_INDEFINITE;
}

double pps_stack_not_reflected(pps_stack *s) {
    const layer *whole = &s->level[s->n_levels - 1];
    double *v = s->work, sum = 0;
    not_reflected(s, whole, v);
    for (int i = 0; i < s->n; i++) {
        sum += 2 * s->at->weight[i] * s->at->mu[i] * v[i];
    }
    return sum;
}

/* ---- the field inside ---- */

/* v <- (T + D) in + beam's share through the layer (`column` of it); n_all rows. */
static void transmit(const pps_stack *s, const layer *l, const double *in,
                     const double *column, double beam, double *v) {
    for (int i = 0; i < s->n_all; i++) {
        v[i] = l->decay[i] * in[i] + column[i] * beam;
    }
    pps_linear_multiply(s->n_all, 1, s->n, l->t, s->n_all, in, s->n, 1, v, s->n_all);
}

static void add_reflected(const pps_stack *s, const layer *l, const double *in,
                          double *v) {
    pps_linear_multiply(s->n_all, 1, s->n, l->r, s->n_all, in, s->n, 1, v, s->n_all);
}

/* Light between an upper and a lower layer: `down` falls on the upper one from above,
 * `up` on the lower one from below, the beam has `beam` left. */
typedef struct {
    const layer *upper, *lower;
    const double *down, *up;
    double beam;
} junction;

static void meet(const pps_stack *s, const junction *j, double *down, double *up,
                 double *work) {
    const layer *a = j->upper, *b = j->lower;
    size_t beam_column = size_of(s->n_all, s->n);
    double below = j->beam * a->decay[s->n_all];
    transmit(s, a, j->down, a->t + beam_column, j->beam, down);
    transmit(s, b, j->up, b->r + beam_column, below, up);
    memcpy(work, down, (size_t)s->n * sizeof *work);
    pps_linear_multiply(s->n, 1, s->n, a->r, s->n_all, up, s->n, 1, work, s->n);
    if (a == b) {
        pps_linear_solve(s->n, a->factors, a->pivot, 1, work, s->n);
    } /* else thin: a second reflection is below rounding */
    add_reflected(s, b, work, up);
    add_reflected(s, a, up, down);
}

typedef struct {
    double *down, *up, *middle_down, *middle_up, *work;
} field;

/* Into the half that holds the depth, `place` in units of the thinnest layer from the top
 * of level j. */
static void descend(const pps_stack *s, int j, double *place, double *beam, field *f) {
    const layer *half = &s->level[j - 1];
    double size = ldexp(1, j - 1), *swap;
    meet(s, &(junction){half, half, f->down, f->up, *beam}, f->middle_down,
         f->middle_up, f->work);
    if (*place < size) {
        swap = f->up;
        f->up = f->middle_up;
        f->middle_up = swap;
    } else {
        swap = f->down;
        f->down = f->middle_down;
        f->middle_down = swap;
        *place -= size;
        *beam *= half->decay[s->n_all];
    }
}

/* The field at the top of level j: what comes up out of it is still wanted. */
static void finish_top(const pps_stack *s, int j, double beam, field *f) {
    const layer *l = &s->level[j];
    size_t beam_column = size_of(s->n_all, s->n);
    transmit(s, l, f->up, l->r + beam_column, beam, f->middle_up);
    add_reflected(s, l, f->down, f->middle_up);
    memcpy(f->middle_down, f->down, (size_t)s->n_all * sizeof *f->down);
}

static void finish_bottom(const pps_stack *s, int j, double beam, field *f) {
    const layer *l = &s->level[j];
    size_t beam_column = size_of(s->n_all, s->n);
    transmit(s, l, f->down, l->t + beam_column, beam, f->middle_down);
    add_reflected(s, l, f->up, f->middle_down);
    memcpy(f->middle_up, f->up, (size_t)s->n_all * sizeof *f->up);
}

/* Within the thinnest layer. Where it lies at an edge, light that starts from 0 there is
 * wanted to second order. */
static void finish_within(pps_stack *s, double place, bool edge, double beam,
                          field *f) {
    size_t taken = s->taken;
    layer upper = take_layer(s), lower = take_layer(s);
    thin_layer(s, place * s->thin, edge, &upper);
    thin_layer(s, (1 - place) * s->thin, edge, &lower);
    meet(s, &(junction){&upper, &lower, f->down, f->up, beam}, f->middle_down,
         f->middle_up, f->work);
    s->taken = taken;
}

static void locate(pps_stack *s, double tau, field *f) {
    int j = s->n_levels - 1;
    double whole = ldexp(1, j), place = tau / s->thickness * whole, beam = 1;
    bool edge = place < 1 || place > whole - 1;
    if (place >= whole) {
        finish_bottom(s, j, beam, f);
        return;
    }
    while (j > 0 && place > 0) {
        descend(s, j, &place, &beam, f);
        j--;
    }
    if (place > 0) {
        finish_within(s, place, edge, beam, f);
    } else {
        finish_top(s, j, beam, f);
    }
}

void pps_stack_at(pps_stack *s, double tau, const double *from_above,
                  const double *from_below, double *down, double *up) {
    size_t all = (size_t)s->n_all, bytes = all * sizeof(double);
    double *v = s->work + work_size(s) - FIELDS * all; /* behind that of thin layers */
    field f = {v, v + all, v + 2 * all, v + 3 * all, v + 4 * all};
    memcpy(f.down, from_above, bytes);
    memcpy(f.up, from_below, bytes);
    locate(s, tau, &f);
    memcpy(down, f.middle_down, bytes);
    memcpy(up, f.middle_up, bytes);
}
