/* Nodes, matrices and outputs of the Runge-Kutta references.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "reference/plane.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/phase.h>

#include "core/legendre.h"
#include "core/quadrature.h"

static const double PI = 3.14159265358979323846;

enum { DEFAULT_STREAMS = 16 };

/* ---- small linear algebra ---- */

static void swap_rows(int n, double *a, int i, int j) {
    for (int k = 0; i != j && k < n; k++) {
        double keep = a[i * n + k];
        a[i * n + k] = a[j * n + k];
        a[j * n + k] = keep;
    }
}

static int pivot_row(int n, const double *a, int column) {
    int best = column;
    for (int i = column + 1; i < n; i++) {
        if (fabs(a[i * n + column]) > fabs(a[best * n + column])) {
            best = i;
        }
    }
    return best;
}

bool pps_plane_eliminate(int n, double *a, int n_rhs, double *y) {
    for (int j = 0; j < n; j++) {
        int pivot = pivot_row(n, a, j);
        if (!(fabs(a[pivot * n + j]) > 0)) {
            return false;
        }
        swap_rows(n, a, j, pivot);
        swap_rows(n_rhs, y, j, pivot);
        for (int i = j + 1; i < n; i++) {
            double factor = a[i * n + j] / a[j * n + j];
            for (int k = j; k < n; k++) {
                a[i * n + k] -= factor * a[j * n + k];
            }
            for (int k = 0; k < n_rhs; k++) {
                y[i * n_rhs + k] -= factor * y[j * n_rhs + k];
            }
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = 0; k < n_rhs; k++) {
            for (int j = i + 1; j < n; j++) {
                y[i * n_rhs + k] -= a[i * n + j] * y[j * n_rhs + k];
            }
            y[i * n_rhs + k] /= a[i * n + i];
        }
    }
    return true;
}

static bool positive_definite(int n, double *a) {
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < j; k++) {
            for (int i = j; i < n; i++) {
                a[i * n + j] -= a[i * n + k] * a[j * n + k];
            }
        }
        if (!(a[j * n + j] > 0)) {
            return false;
        }
        double root = sqrt(a[j * n + j]);
        for (int i = j; i < n; i++) {
            a[i * n + j] /= root;
        }
    }
    return true;
}

/* ---- one order ---- */

/* Everything an order is made of, in one piece of memory. */
typedef struct {
    pps_plane plane;
    double *weight;   /* n */
    double *legendre; /* (rows + 1) x streams: rows, then mu0 */
    double *work;     /* n x n */
} order;

static void order_free(order *o) { free(o->plane.mu); }

static pps_status order_create(order *o, const pps_plane_model *model, int rows) {
    size_t n = (size_t)model->streams / 2, r = (size_t)rows;
    size_t moments = (size_t)model->streams;
    double *m = calloc(3 * r + 2 * r * n + n + (r + 1) * moments + n * n, sizeof *m);
    if (!m) {
        return PPS_ERR_MEMORY;
    }
    o->plane = (pps_plane){.n = (int)n,
                           .rows = rows,
                           .carried = rows,
                           .mu = m,
                           .s = m + r,
                           .r = m + 2 * r,
                           .c = m + 3 * r,
                           .b = m + 3 * r + r * n,
                           .w = model->slab.thickness,
                           .q = 1 / model->mu0,
                           .albedo = model->slab.albedo,
                           .tolerance = model->tolerance};
    o->weight = m + 3 * r + 2 * r * n;
    o->legendre = o->weight + n;
    o->work = o->legendre + (r + 1) * moments;
    pps_hemisphere_nodes(PPS_NODES_GAUSS, (int)n, o->plane.mu, o->weight);
    return PPS_OK;
}

/* even + odd and even - odd, where these are the sums over l of (2l+1) g^l x_l y_l with
 * l + m even and odd: scattering into the same and into the other hemisphere. */
static void couple(int m, int moments, double g, const double *x, const double *y,
                   double *same, double *other) {
    double power = pow(g, m), sum[2] = {0, 0};
    for (int l = m; l < moments; l++) {
        sum[(l - m) % 2] += (2 * l + 1) * power * x[l - m] * y[l - m];
        power *= g;
    }
    *same = sum[0] + sum[1];
    *other = sum[0] - sum[1];
}

static void order_fill(order *o, const pps_plane_model *model, int m) {
    pps_plane *p = &o->plane;
    int moments = model->streams;
    double g = model->slab.g, albedo = model->slab.albedo;
    double beam = (m == 0 ? 1 : 2) * albedo / (4 * PI);
    double *own = o->legendre + p->rows * moments;
    pps_legendre(m, moments, model->mu0, own);
    for (int i = 0; i < p->rows; i++) {
        pps_legendre(m, moments, p->mu[i], o->legendre + i * moments);
    }
    for (int i = 0; i < p->rows; i++) {
        const double *x = o->legendre + i * moments;
        double same, other;
        for (int j = 0; j < p->n; j++) {
            couple(m, moments, g, x, o->legendre + j * moments, &same, &other);
            p->c[i * p->n + j] = albedo / 2 * same * o->weight[j] / p->mu[i];
            p->b[i * p->n + j] = albedo / 2 * other * o->weight[j] / p->mu[i];
        }
        couple(m, moments, g, x, own, &same, &other);
        p->s[i] = beam * same / p->mu[i];
        p->r[i] = beam * other / p->mu[i];
    }
}

/* 1 - albedo (even sum) and 1 - albedo (odd sum), symmetrised by the roots of the weights,
 * are positive definite wherever the discrete problem means anything. */
static bool order_definite(order *o) {
    const pps_plane *p = &o->plane;
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int i = 0; i < p->n; i++) {
            for (int j = 0; j < p->n; j++) {
                double k = p->mu[i] * (p->c[i * p->n + j] + sign * p->b[i * p->n + j]);
                o->work[i * p->n + j] =
                    (i == j) - k * sqrt(o->weight[i] / o->weight[j]);
            }
        }
        /* At albedo 1 order 0 has the eigenvalue 0 itself. */
        for (int i = 0; i < p->n; i++) {
            o->work[i * p->n + i] += 1e-12;
        }
        if (!positive_definite(p->n, o->work)) {
            return false;
        }
    }
    return true;
}

pps_status pps_plane_init(pps_plane_model *model, const pps_slab *slab,
                          const pps_options *opts, bool carry_all,
                          pps_plane_solver solver) {
    *model =
        (pps_plane_model){.slab = *slab,
                          .mu0 = 1,
                          .streams = opts->streams ? opts->streams : DEFAULT_STREAMS,
                          .tolerance = opts->tolerance,
                          .plain = opts->delta_m == PPS_DELTA_M_OFF,
                          .carry_all = carry_all,
                          .solver = solver};
    if (opts->delta_m == PPS_DELTA_M_ON || opts->nodes > PPS_NODES_GAUSS) {
        return PPS_ERR_UNSUPPORTED;
    }
    order o;
    pps_status status = order_create(&o, model, model->streams / 2);
    for (int m = 0; !status && m < model->streams; m++) {
        order_fill(&o, model, m);
        if (!order_definite(&o)) {
            status = PPS_ERR_INDEFINITE;
        }
        if (m + 1 == model->streams || status) {
            order_free(&o);
        }
    }
    return status;
}

/* ---- depths ---- */

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sort, and keep each value once; how many. */
static int sorted_once(size_t n, double *x) {
    int kept = 0;
    qsort(x, n, sizeof *x, ascending);
    for (size_t i = 0; i < n; i++) {
        if (kept == 0 || x[i] != x[kept - 1]) {
            x[kept++] = x[i];
        }
    }
    return kept;
}

static int index_of(int n, const double *x, double value) {
    int i = 0;
    while (i + 1 < n && x[i] != value) {
        i++;
    }
    return i;
}

/* The depths wanted and both edges, ascending, each once. */
static double *all_depths(double w, size_t n, const double *tau, int *count) {
    double *all = malloc((n + 2) * sizeof *all);
    if (all) {
        for (size_t k = 0; k < n; k++) {
            all[k] = tau[k];
        }
        all[n] = 0;
        all[n + 1] = w;
        *count = sorted_once(n + 2, all);
    }
    return all;
}

/* ---- directions far below the nodes ---- */

static double exp1(double t, double a, double b) {
    double z = fabs(b - a) * t;
    return t * exp(-fmin(a, b) * t) * (z > 0 ? -expm1(-z) / z : 1);
}

/* The source of row i is x . (D, U) + y e for light going down (sign 1), with the roles of
 * D and U, s and r exchanged for light going up (sign -1). Along the ray
 *     sign mu I' = -I + mu (x . (D, U) + y e)
 * has the particular solution z . (D, U) + f e with
 *     (1 + sign mu L^T) z = mu x,  f (1 - sign mu q) = mu y - sign mu z . (s, -r),
 * L the matrix of the nodes. 1/mu exceeds every eigenvalue of L, so it exists. work:
 * 4 n^2 + 2 n; z is left in its end. */
static bool particular(const pps_plane *p, int i, int sign, double *work,
                       double *f_times) {
    int n = p->n, size = 2 * n;
    double mu = p->mu[i], *a = work, *z = work + size * size;
    for (int j = 0; j < n; j++) { /* row j of A: column j of L */
        for (int k = 0; k < n; k++) {
            double c = p->c[k * n + j] - (j == k ? 1 / p->mu[j] : 0);
            double b = p->b[k * n + j];
            a[j * size + k] = sign * mu * c + (j == k);
            a[j * size + n + k] = -sign * mu * b;
            a[(n + j) * size + k] = sign * mu * b;
            a[(n + j) * size + n + k] = -sign * mu * c + (j == k);
        }
        z[j] = mu * (sign > 0 ? p->c : p->b)[i * n + j];
        z[n + j] = mu * (sign > 0 ? p->b : p->c)[i * n + j];
    }
    if (!pps_plane_eliminate(size, a, 1, z)) {
        return false;
    }
    double sum = mu * (sign > 0 ? p->s : p->r)[i];
    for (int j = 0; j < n; j++) {
        sum -= sign * mu * (z[j] * p->s[j] - z[n + j] * p->r[j]);
    }
    *f_times = sum;
    return true;
}

static double homogeneous(const pps_plane *p, const double *z, const double *down,
                          const double *up, int k) {
    double sum = 0;
    for (int j = 0; j < p->n; j++) {
        sum += z[j] * down[k * p->rows + j] + z[p->n + j] * up[k * p->rows + j];
    }
    return sum;
}

/* Rows beyond the carried ones at every depth: the particular solution less what it is
 * where the ray starts, attenuated. */
static bool graze(const pps_plane *p, int n_tau, const double *tau, double *down,
                  double *up, double *work) {
    const double *z = work + 4 * p->n * p->n;
    for (int i = p->carried; i < p->rows; i++) {
        double f, c = 1 / p->mu[i];
        for (int sign = -1; sign <= 1; sign += 2) {
            if (!particular(p, i, sign, work, &f)) {
                return false;
            }
            int edge = sign > 0 ? 0 : n_tau - 1;
            double start = homogeneous(p, z, down, up, edge);
            for (int k = 0; k < n_tau; k++) {
                double run = fabs(tau[k] - tau[edge]);
                /* (e^(-q tau) - e^(-c tau))/(1 - mu q), and its like from below */
                double beam = sign > 0
                                  ? c * exp1(run, p->q, c)
                                  : exp(-p->q * tau[k]) * -expm1(-(c + p->q) * run) /
                                        (1 + p->mu[i] * p->q);
                (sign > 0 ? down : up)[k * p->rows + i] =
                    homogeneous(p, z, down, up, k) - start * exp(-c * run) + f * beam;
            }
        }
    }
    return true;
}

/* ---- fluxes ---- */

static pps_flux flux_at(const order *o, double mu0, double tau, const double *down,
                        const double *up) {
    pps_flux f = {.direct = mu0 * exp(-tau / mu0)};
    for (int i = 0; i < o->plane.n; i++) {
        f.up += 2 * PI * o->weight[i] * o->plane.mu[i] * up[i];
        f.down += 2 * PI * o->weight[i] * o->plane.mu[i] * down[i];
        f.mean_diffuse += o->weight[i] * (up[i] + down[i]) / 2;
    }
    f.mean = f.mean_diffuse + exp(-tau / mu0) / (4 * PI);
    return f;
}

/* D, then U, of one order at all depths: 2 n_tau x rows numbers; all 0 for albedo 0. */
static pps_status fields(const pps_plane_model *model, const order *o, int n_tau,
                         const double *tau, double *memory) {
    size_t n = (size_t)(n_tau * o->plane.rows);
    memset(memory, 0, 2 * n * sizeof *memory);
    return model->slab.albedo > 0
               ? model->solver(&o->plane, n_tau, tau, memory, memory + n)
               : PPS_OK;
}

pps_status pps_plane_flux(pps_plane_model *model, size_t n, const double *tau,
                          pps_flux *flux) {
    order o;
    int count = 0;
    pps_status status = order_create(&o, model, model->streams / 2);
    if (status) {
        return status;
    }
    double *depth = all_depths(model->slab.thickness, n, tau, &count);
    size_t size = (size_t)(count * o.plane.rows);
    double *down = depth ? malloc(2 * size * sizeof *down) : NULL;
    status = down ? PPS_OK : PPS_ERR_MEMORY;
    if (!status) {
        order_fill(&o, model, 0);
        status = fields(model, &o, count, depth, down);
    }
    for (size_t k = 0; !status && k < n; k++) {
        size_t at = (size_t)(index_of(count, depth, tau[k]) * o.plane.rows);
        flux[k] = flux_at(&o, model->mu0, tau[k], down + at, down + size + at);
    }
    model->orders = 1;
    free(down);
    free(depth);
    order_free(&o);
    return status;
}

/* ---- radiance ---- */

/* |mu| wanted, largest first so that the grazing ones are last; n_mu at most. */
static pps_status directions(const pps_plane_model *model, const pps_grid *at,
                             order *o) {
    double *wanted = malloc((at->n_mu + 1) * sizeof *wanted);
    if (!wanted) {
        return PPS_ERR_MEMORY;
    }
    for (size_t j = 0; j < at->n_mu; j++) {
        wanted[j] = fabs(at->mu[j]);
    }
    int count = sorted_once(at->n_mu, wanted), n = model->streams / 2;
    pps_status status = order_create(o, model, n + count);
    if (!status) {
        int carried = n;
        for (int j = 0; j < count; j++) {
            double mu = wanted[count - 1 - j];
            o->plane.mu[n + j] = mu;
            carried += model->carry_all || mu >= o->plane.mu[0] / 2;
        }
        o->plane.carried = carried;
    }
    free(wanted);
    return status;
}

/* Single scattering with the exact phase function less the truncated one. */
static double correction(const pps_plane_model *model, double tau, double mu,
                         double phi) {
    double q = 1 / model->mu0, c = 1 / fabs(mu), run = model->slab.thickness - tau;
    double cosine = pps_cos_scattering(model->mu0, mu, phi);
    double power = 1, truncated = 0, here = 1, before = 0;
    for (int l = 0; l < model->streams; l++) {
        truncated += (2 * l + 1) * power * here;
        double next = ((2 * l + 1) * cosine * here - l * before) / (l + 1);
        before = here;
        here = next;
        power *= model->slab.g;
    }
    double p = pps_hg(model->slab.g, cosine) - truncated / (4 * PI);
    return model->slab.albedo * p *
           (mu > 0 ? c * exp1(tau, q, c)
                   : c / (c + q) * exp(-q * tau) * -expm1(-(c + q) * run));
}

/* Add an order to the radiance; the largest share of it that is added anywhere. */
static double add_order(const order *o, int m, int n_tau, const double *tau,
                        const double *field, const pps_grid *at, double *radiance) {
    const pps_plane *p = &o->plane;
    double most = 0, largest = 0;
    size_t size = (size_t)(n_tau * p->rows), out = 0;
    for (size_t k = 0; k < at->n_tau; k++) {
        int row = index_of(n_tau, tau, at->tau[k]) * p->rows + p->n;
        for (size_t j = 0; j < at->n_mu; j++) {
            int i = index_of(p->rows - p->n, p->mu + p->n, fabs(at->mu[j]));
            double value = field[(at->mu[j] > 0 ? 0 : size) + (size_t)(row + i)];
            for (size_t a = 0; a < at->n_phi; a++, out++) {
                radiance[out] += value * pps_cos_degrees(m * at->phi[a]);
                largest = fmax(largest, fabs(radiance[out]));
            }
            most = fmax(most, fabs(value));
        }
    }
    return largest > 0 ? most / largest : 0;
}

/* Orders until two in a row add less than a hundredth of the tolerance. */
static pps_status sum_orders(pps_plane_model *model, order *o, int n_tau,
                             const double *tau, double *memory, const pps_grid *at,
                             double *radiance) {
    size_t size = (size_t)(n_tau * o->plane.rows);
    double *down = memory, *up = memory + size, *work = memory + 2 * size;
    int small = 0;
    for (int m = 0; m < model->streams && small < 2; m++) {
        order_fill(o, model, m);
        pps_status status = fields(model, o, n_tau, tau, memory);
        if (status) {
            return status;
        }
        if (!graze(&o->plane, n_tau, tau, down, up, work)) {
            return PPS_ERR_UNSUPPORTED;
        }
        double share = add_order(o, m, n_tau, tau, memory, at, radiance);
        small = share <= 1e-5 * model->tolerance ? small + 1 : 0;
        model->orders = m + 1;
    }
    return PPS_OK;
}

static void correct_single(const pps_plane_model *model, const pps_grid *at,
                           double *radiance) {
    for (size_t k = 0; k < at->n_tau; k++) {
        for (size_t j = 0; j < at->n_mu; j++) {
            for (size_t i = 0; i < at->n_phi; i++) {
                *radiance++ += correction(model, at->tau[k], at->mu[j], at->phi[i]);
            }
        }
    }
}

pps_status pps_plane_radiance(pps_plane_model *model, const pps_grid *at,
                              double *radiance) {
    size_t n = at->n_tau * at->n_mu * at->n_phi;
    if (n == 0) {
        return PPS_OK;
    }
    order o;
    int count = 0;
    pps_status status = directions(model, at, &o);
    if (status) {
        return status;
    }
    double *depth = all_depths(model->slab.thickness, at->n_tau, at->tau, &count);
    size_t fields_size = 2 * (size_t)(count * o.plane.rows);
    size_t work_size = (size_t)(4 * o.plane.n * o.plane.n + 2 * o.plane.n);
    double *memory = depth ? malloc((fields_size + work_size) * sizeof *memory) : NULL;
    status = memory ? PPS_OK : PPS_ERR_MEMORY;
    if (!status) {
        memset(radiance, 0, n * sizeof *radiance);
        status = sum_orders(model, &o, count, depth, memory, at, radiance);
    }
    if (!status && !model->plain) {
        correct_single(model, at, radiance);
    }
    free(memory);
    free(depth);
    order_free(&o);
    return status;
}
