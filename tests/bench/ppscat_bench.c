/* ppscat-bench: how long the library's work takes, against the targets it was built to.
 *
 *     ppscat-bench [FILE.csv]
 *
 * One thread, results in memory, CPU seconds, the least of many rounds. Single cases
 * are timed from nothing (create, solve, output, free) with an allocator that keeps its
 * pages; a sweep keeps what it may keep.
 * Targets are multiples of cdisort's speed. Built with PPSCAT_CDISORT=FOLDER, the source of
 * cdisort, it takes turns with ours, and `times` is what was measured; else its times are
 * those of the machine that the targets were set on, and `times` compares machines too.
 * Other programs: scripts/bench-peers.sh. The second table shows how much of a case is
 * eigenproblems, and LAPACK's own time for them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cblas.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <lapacke.h>

#include <ppscat/ppscat.h>

#include "bench_cdisort.h"

enum {
    LEAST_ROUNDS = 5,
    MOST_ROUNDS = 300,
    N_DEPTHS = 10,
    N_MU = 16,
    N_PHI = 19,
    MOST_STREAMS = 64
};
static const double ROUND_SECONDS = 0.002, SECONDS = 1.5; /* short: between others */

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void require(pps_status status) {
    if (status) {
        fprintf(stderr, "ppscat-bench: %s\n", pps_status_string(status));
        exit(1);
    }
}

/* Two programs that are timed against each other solve the same problem. */
static void same(double ours, double theirs) {
    if (!(fabs(ours - theirs) < 1e-6 * ours)) {
        fprintf(stderr, "ppscat-bench: cdisort has %.9g, ppscat %.9g\n", theirs, ours);
        exit(1);
    }
}

static void *memory(size_t n, size_t size) {
    void *block = calloc(n, size);
    if (!block) {
        require(PPS_ERR_MEMORY);
    }
    return block;
}

typedef struct {
    void (*run)(void *); /* NULL: nothing to time */
    void *context;
    long repeats;
    double best;
} job;

static job job_of(void (*run)(void *), void *context) {
    job j = {run, context, 1, run ? HUGE_VAL : (double)NAN};
    if (run) {
        double start = now();
        run(context);
        j.repeats += (long)(ROUND_SECONDS / fmax(now() - start, 1e-7));
    }
    return j;
}

static void run_round(job *j) {
    if (!j->run) {
        return;
    }
    double start = now();
    for (long i = 0; i < j->repeats; i++) {
        j->run(j->context);
    }
    j->best = fmin(j->best, (now() - start) / (double)j->repeats);
}

/* Seconds of one run of each, the least of many short rounds, in turn. */
static void take_turns(job *a, job *b) {
    double end = now() + SECONDS;
    for (int round = 0; round < LEAST_ROUNDS || (round < MOST_ROUNDS && now() < end);
         round++) {
        run_round(a);
        run_round(b);
    }
}

static double seconds(void (*run)(void *), void *context) {
    job a = job_of(run, context), none = job_of(NULL, NULL);
    take_turns(&a, &none);
    return a.best;
}

/* ---- one case from nothing ---- */

typedef struct {
    pps_dom_opts opts;
    bool radiances;
    double tau[N_DEPTHS], mu[N_MU], phi[N_PHI];
    double radiance[N_DEPTHS * N_MU * N_PHI];
    pps_flux flux[N_DEPTHS];
} one_case;

static const pps_slab slab = {.albedo = 0.95, .g = 0.5, .thickness = 10};
static const double MU0 = 0.6;

/* The discretisation of cdisort, all its orders: equal streams, equal sums. */
static one_case *case_of(int streams, bool radiances) {
    one_case *c = memory(1, sizeof *c);
    c->opts = (pps_dom_opts){.streams = streams,
                             .nodes = PPS_NODES_GAUSS,
                             .orders = radiances ? streams : 1};
    c->radiances = radiances;
    for (int k = 0; k < N_DEPTHS; k++) {
        c->tau[k] = slab.thickness * k / (N_DEPTHS - 1);
    }
    for (int j = 0; j < N_MU; j++) { /* off the nodes */
        c->mu[j] = (2 * j + 1 - N_MU) / (double)N_MU;
    }
    for (int i = 0; i < N_PHI; i++) {
        c->phi[i] = 10 * i;
    }
    return c;
}

static void run_case(void *context) {
    one_case *c = context;
    pps_dom *dom;
    require(pps_dom_create(&slab, &c->opts, &dom));
    require(pps_dom_solve(dom, MU0));
    if (c->radiances) {
        pps_grid at = {N_DEPTHS, N_MU, N_PHI, c->tau, c->mu, c->phi};
        require(pps_dom_radiance(dom, &at, c->radiance));
    }
    require(pps_dom_flux(dom, N_DEPTHS, c->tau, c->flux));
    pps_dom_free(dom);
}

/* cdisort ready to solve the same case again and again, which must agree. */
static bench_cdisort *cdisort_of(const one_case *c) {
    size_t n_mu = c->radiances ? N_MU : 0;
    pps_grid at = {N_DEPTHS, n_mu, N_PHI, c->tau, c->mu, c->phi};
    bench_cdisort *theirs = bench_cdisort_create(c->opts.streams, &at);
    if (theirs) {
        bench_cdisort_set(theirs, &slab, MU0, c->tau);
        bench_cdisort_solve(theirs);
        same(c->flux[0].up, bench_cdisort_flux_up(theirs));
    }
    return theirs;
}

/* The eigenproblems of a case alone, with what is made of them. */
static void solve_eigenproblems(void *context) {
    one_case *c = context;
    double k[MOST_STREAMS / 2];
    pps_dom *dom;
    pps_dom_opts opts = c->opts;
    require(pps_dom_create(&slab, &opts, &dom)); /* order 0 */
    for (int m = 1; m < opts.orders; m++) {
        require(pps_dom_eigenvalues(dom, m, k)); /* made, read and thrown away */
    }
    pps_dom_free(dom);
}

/* LAPACK's own time for one of them: a graded matrix of that size. */
typedef struct {
    int n;
    double *given, *a, *value, *work;
    int *iwork;
} lapack_problem;

static lapack_problem *lapack_of(int n) {
    lapack_problem *p = memory(1, sizeof *p);
    size_t nn = (size_t)n * (size_t)n;
    p->n = n;
    p->given = memory(5 * nn + 20 * (size_t)n + 100, sizeof *p->given);
    p->a = p->given + nn;
    p->value = p->a + nn;
    p->work = p->value + n;
    p->iwork = memory(10 * (size_t)n + 100, sizeof *p->iwork);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            p->given[i + j * n] = exp(-8.0 * (i + j) / (2 * n)) / (1 + abs(i - j));
        }
    }
    return p;
}

static void run_lapack(void *context) {
    lapack_problem *p = context;
    int n = p->n;
    memcpy(p->a, p->given, (size_t)n * (size_t)n * sizeof *p->a);
    if (LAPACKE_dsyevd_work(LAPACK_COL_MAJOR, 'V', 'L', n, p->a, n, p->value, p->work,
                            1 + 6 * n + 2 * n * n, p->iwork, 3 + 5 * n)) {
        require(PPS_ERR_CONVERGENCE);
    }
}

/* ---- the sweep: 10 albedos, 3 g, 8 thicknesses, 10 mu0 ---- */

enum { N_ALBEDO = 10, N_G = 3, N_THICKNESS = 8, N_MU0 = 10, N_SWEEP_DEPTHS = 5 };
enum { SWEEP_STREAMS = 16, N_CASES = N_ALBEDO * N_G * N_THICKNESS * N_MU0 };

static const double sweep_albedo[N_ALBEDO] = {0.1, 0.3,  0.5,  0.7,  0.8,
                                              0.9, 0.95, 0.98, 0.99, 0.999};
static const double sweep_g[N_G] = {0, 0.5, 0.75};
static const double sweep_thickness[N_THICKNESS] = {0.1, 0.3, 1, 2, 5, 10, 30, 100};
static const double sweep_mu0[N_MU0] = {0.08, 0.18, 0.28, 0.38, 0.48,
                                        0.58, 0.68, 0.78, 0.88, 0.98};

typedef struct {
    bool radiances;
    double phi[N_PHI];
    bench_cdisort *cdisort;
    double *radiance; /* of all cases */
    pps_flux *flux;
} sweep;

static sweep *sweep_of(bool radiances) {
    sweep *s = memory(1, sizeof *s);
    s->radiances = radiances;
    for (int i = 0; i < N_PHI; i++) {
        s->phi[i] = 10 * i;
    }
    size_t n = radiances ? (size_t)N_CASES * N_SWEEP_DEPTHS * SWEEP_STREAMS * N_PHI : 1;
    s->radiance = memory(n, sizeof *s->radiance);
    s->flux = memory((size_t)N_CASES * N_SWEEP_DEPTHS, sizeof *s->flux);
    pps_grid at = {N_SWEEP_DEPTHS, radiances ? SWEEP_STREAMS : 0, N_PHI, NULL, NULL,
                   s->phi};
    s->cdisort = bench_cdisort_create(SWEEP_STREAMS, &at);
    return s;
}

static void sweep_depths(double thickness, double *tau) {
    for (int k = 0; k < N_SWEEP_DEPTHS; k++) {
        tau[k] = thickness * k / (N_SWEEP_DEPTHS - 1);
    }
}

/* All beams of a slab at once. */
static void sweep_slab(sweep *s, pps_dom *dom, double thickness, double **radiance,
                       pps_flux **flux) {
    double tau[N_SWEEP_DEPTHS], mu[SWEEP_STREAMS], weight[SWEEP_STREAMS / 2];
    double *node = mu + SWEEP_STREAMS / 2;
    sweep_depths(thickness, tau);
    require(pps_dom_nodes(dom, node, weight));
    for (int j = 0; j < SWEEP_STREAMS / 2; j++) {
        mu[j] = -mu[SWEEP_STREAMS - 1 - j];
    }
    pps_grid at = {N_SWEEP_DEPTHS, SWEEP_STREAMS, N_PHI, tau, mu, s->phi};
    require(pps_dom_set_thickness(dom, thickness));
    require(pps_dom_set_directions(dom, s->radiances ? SWEEP_STREAMS : 0, mu));
    require(pps_dom_solve_beams(dom, N_MU0, sweep_mu0));
    require(pps_dom_flux(dom, N_SWEEP_DEPTHS, tau, *flux));
    *flux += N_MU0 * N_SWEEP_DEPTHS;
    if (s->radiances) {
        require(pps_dom_radiance(dom, &at, *radiance));
        *radiance += (size_t)N_MU0 * N_SWEEP_DEPTHS * SWEEP_STREAMS * N_PHI;
    }
}

static void run_sweep(void *context) {
    sweep *s = context;
    double *radiance = s->radiance;
    pps_flux *flux = s->flux;
    for (int a = 0; a < N_ALBEDO; a++) {
        for (int i = 0; i < N_G; i++) {
            pps_slab medium = {sweep_albedo[a], sweep_g[i], 1};
            pps_dom_opts opts = {.streams = SWEEP_STREAMS,
                                 .nodes = PPS_NODES_GAUSS,
                                 .orders = s->radiances ? SWEEP_STREAMS : 1};
            if (sweep_g[i] == 0) {
                opts.orders = 1; /* nobody sums orders that are zero */
            }
            pps_dom *dom;
            require(pps_dom_create(&medium, &opts, &dom));
            for (int t = 0; t < N_THICKNESS; t++) {
                sweep_slab(s, dom, sweep_thickness[t], &radiance, &flux);
            }
            pps_dom_free(dom);
        }
    }
}

/* cdisort takes one case after the other, and at g = 0 ends the orders by itself. */
static void run_cdisort_sweep(void *context) {
    sweep *s = context;
    double tau[N_SWEEP_DEPTHS];
    const pps_flux *flux = s->flux;
    for (int a = 0; a < N_ALBEDO; a++) {
        for (int i = 0; i < N_G; i++) {
            for (int t = 0; t < N_THICKNESS; t++) {
                pps_slab medium = {sweep_albedo[a], sweep_g[i], sweep_thickness[t]};
                sweep_depths(sweep_thickness[t], tau);
                for (int b = 0; b < N_MU0; b++, flux += N_SWEEP_DEPTHS) {
                    bench_cdisort_set(s->cdisort, &medium, sweep_mu0[b], tau);
                    bench_cdisort_solve(s->cdisort);
                    same(flux->up, bench_cdisort_flux_up(s->cdisort));
                }
            }
        }
    }
}

/* ---- closed forms ---- */

enum { N_FLUENCES = 4096 };

typedef struct {
    pps_hemispheric solved;
    double tau[N_FLUENCES], fluence[N_FLUENCES];
} closed_form;

static closed_form *hemispheric(void) {
    closed_form *c = memory(1, sizeof *c);
    require(pps_hemispheric_init(&c->solved, &slab, 0.4));
    for (int i = 0; i < N_FLUENCES; i++) {
        c->tau[i] = slab.thickness * i / (N_FLUENCES - 1);
    }
    return c;
}

static void run_closed(void *context) {
    closed_form *c = context;
    pps_hemispheric_fluence(&c->solved, N_FLUENCES, c->tau, c->fluence);
}

/* ---- the tables ---- */

static FILE *csv;

/* cdisort: the job, else its seconds on another machine. */
static void row(const char *work, int streams, int n_cases, job ours, job cdisort,
                double cdisort_seconds, double asked) {
    take_turns(&ours, &cdisort);
    double a = ours.best / n_cases,
           b = cdisort.run ? cdisort.best / n_cases : cdisort_seconds;
    printf("%-36s %4d %11.4g %11.4g %7.1f %7.0f\n", work, streams, 1e6 * a, 1e6 * b,
           b / a, asked);
    if (csv) {
        fprintf(csv, "%s,%d,%.17g,%.17g,%.0f\n", work, streams, a, b, asked);
    }
}

static void case_row(int streams, bool radiances, double cdisort_seconds,
                     double asked) {
    one_case *c = case_of(streams, radiances);
    job ours = job_of(run_case, c);
    bench_cdisort *theirs = cdisort_of(c);
    job cdisort = job_of(theirs ? bench_cdisort_solve : NULL, theirs);
    row(radiances ? "one case: radiances 10 x 16 x 19"
                  : "one case: fluxes at 10 depths",
        streams, 1, ours, cdisort, cdisort_seconds, asked);
    bench_cdisort_free(theirs);
    free(c);
}

static void sweep_row(bool radiances, double cdisort_seconds, double asked) {
    sweep *s = sweep_of(radiances);
    job ours = job_of(run_sweep, s);
    job cdisort = job_of(s->cdisort ? run_cdisort_sweep : NULL, s);
    row(radiances ? "2400 cases: radiances 5 x 16 x 19" : "2400 cases: fluxes",
        SWEEP_STREAMS, N_CASES, ours, cdisort, cdisort_seconds, asked);
    bench_cdisort_free(s->cdisort);
    free(s->radiance);
    free(s->flux);
    free(s);
}

static void closed_row(void) {
    closed_form *c = hemispheric();
    double each = seconds(run_closed, c) / N_FLUENCES;
    printf("\nhemispheric fluence: %.0f million evaluations a second (asked: 200)\n",
           1e-6 / each);
    if (csv) {
        fprintf(csv, "hemispheric fluence,0,%.17g,,\n", each);
    }
    free(c);
}

/* cdisort's seconds: those of the machine where the targets were set. */
static void targets(void) {
    printf("%-36s %4s %11s %11s %7s %7s\n", "work (us)", "n", "ours", "cdisort",
           "times", "asked");
    case_row(16, false, 18.6e-6, 4);
    case_row(32, false, 75e-6, 4);
    case_row(64, false, 370e-6, 7);
    case_row(16, true, 1.89e-3, 20);
    case_row(32, true, 5.3e-3, 10);
    case_row(64, true, 22e-3, 10);
    sweep_row(false, 14.8e-6, 40);
    sweep_row(true, 690e-6, 60);
    closed_row();
}

static void eigenproblems(void) {
    printf("\n%-36s %4s %11s %11s %7s %11s\n", "eigenproblems (us)", "n", "they take",
           "of", "share", "dsyevd's");
    for (int radiances = 0; radiances < 2; radiances++) {
        for (int streams = 16; streams <= MOST_STREAMS; streams *= 2) {
            one_case *c = case_of(streams, radiances);
            lapack_problem *p = lapack_of(streams / 2);
            double eigen = seconds(solve_eigenproblems, c), all = seconds(run_case, c);
            printf("%-36s %4d %11.4g %11.4g %6.0f%% %11.4g\n",
                   radiances ? "radiances, all orders" : "fluxes", streams, 1e6 * eigen,
                   1e6 * all, 100 * eigen / all,
                   1e6 * c->opts.orders * seconds(run_lapack, p));
            free(p->given);
            free(p->iwork);
            free(p);
            free(c);
        }
    }
}

int main(int argc, char **argv) {
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        fprintf(stderr, "usage: ppscat-bench [FILE.csv]\n");
        return 2;
    }
    openblas_set_num_threads(1);
#ifdef M_TRIM_THRESHOLD /* else free() hands pages back, and each case faults them in */
    mallopt(M_TRIM_THRESHOLD, 1 << 28);
    mallopt(M_MMAP_THRESHOLD, 1 << 25); /* the largest that glibc takes */
#endif
    if (argc == 2) {
        csv = fopen(argv[1], "w");
        if (!csv) {
            perror(argv[1]);
            return 1;
        }
        fprintf(csv, "work,streams,seconds,cdisort_seconds,asked\n");
    }
    targets();
    eigenproblems();
    return csv && fclose(csv) ? 1 : 0;
}
