/* ppscat-bench: how long the library's work takes, against the targets it was built to.
 *
 *     ppscat-bench [FILE.csv]
 *
 * One thread, results in memory, CPU seconds, the least of several rounds. Single cases
 * are timed from nothing (create, solve, output, free) with an allocator that keeps its
 * pages; a sweep keeps what it may keep.
 * A target is a time on the machine it was set on, so `ratio` (target / ours) compares
 * machines too; side by side with other programs: scripts/bench-peers.sh. The second
 * table shows how much of a case is eigenproblems, and LAPACK's own time for them.
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

enum { ROUNDS = 9, N_DEPTHS = 10, N_MU = 16, N_PHI = 19, MOST_STREAMS = 64 };
static const double ROUND_SECONDS = 0.05;

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

static void *memory(size_t n, size_t size) {
    void *block = calloc(n, size);
    if (!block) {
        require(PPS_ERR_MEMORY);
    }
    return block;
}

/* Seconds of one call of work(context): the least of ROUNDS means. */
static double seconds(void (*work)(void *), void *context) {
    double start = now(), best = HUGE_VAL;
    work(context);
    long repeats = 1 + (long)(ROUND_SECONDS / fmax(now() - start, 1e-7));
    for (int round = 0; round < ROUNDS; round++) {
        start = now();
        for (long i = 0; i < repeats; i++) {
            work(context);
        }
        best = fmin(best, (now() - start) / (double)repeats);
    }
    return best;
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
    require(pps_dom_solve(dom, 0.6));
    if (c->radiances) {
        pps_grid at = {N_DEPTHS, N_MU, N_PHI, c->tau, c->mu, c->phi};
        require(pps_dom_radiance(dom, &at, c->radiance));
    } else {
        require(pps_dom_flux(dom, N_DEPTHS, c->tau, c->flux));
    }
    pps_dom_free(dom);
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

typedef struct {
    bool radiances;
    double phi[N_PHI];
    double *radiance; /* of one slab: N_MU0 beams */
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
    return s;
}

/* All beams of a slab at once. */
static void sweep_slab(sweep *s, pps_dom *dom, double thickness, double **radiance,
                       pps_flux **flux) {
    double tau[N_SWEEP_DEPTHS], mu[SWEEP_STREAMS], weight[SWEEP_STREAMS / 2];
    double *node = mu + SWEEP_STREAMS / 2;
    for (int k = 0; k < N_SWEEP_DEPTHS; k++) {
        tau[k] = thickness * k / (N_SWEEP_DEPTHS - 1);
    }
    require(pps_dom_nodes(dom, node, weight));
    for (int j = 0; j < SWEEP_STREAMS / 2; j++) {
        mu[j] = -mu[SWEEP_STREAMS - 1 - j];
    }
    pps_grid at = {N_SWEEP_DEPTHS, SWEEP_STREAMS, N_PHI, tau, mu, s->phi};
    require(pps_dom_set_thickness(dom, thickness));
    double mu0[N_MU0];
    for (int i = 0; i < N_MU0; i++) {
        mu0[i] = 0.08 + 0.1 * i;
    }
    require(pps_dom_set_directions(dom, s->radiances ? SWEEP_STREAMS : 0, mu));
    require(pps_dom_solve_beams(dom, N_MU0, mu0));
    require(pps_dom_flux(dom, N_SWEEP_DEPTHS, tau, *flux));
    *flux += N_MU0 * N_SWEEP_DEPTHS;
    if (s->radiances) {
        require(pps_dom_radiance(dom, &at, *radiance));
        *radiance += (size_t)N_MU0 * N_SWEEP_DEPTHS * SWEEP_STREAMS * N_PHI;
    }
}

static void run_sweep(void *context) {
    static const double thickness[N_THICKNESS] = {0.1, 0.3, 1, 2, 5, 10, 30, 100};
    static const double albedo[N_ALBEDO] = {0.1, 0.3,  0.5,  0.7,   0.8,
                                            0.9, 0.95, 0.99, 0.999, 1};
    static const double g[N_G] = {0, 0.5, 0.75};
    sweep *s = context;
    double *radiance = s->radiance;
    pps_flux *flux = s->flux;
    for (int a = 0; a < N_ALBEDO; a++) {
        for (int i = 0; i < N_G; i++) {
            pps_slab medium = {albedo[a], g[i], 1};
            pps_dom_opts opts = {.streams = SWEEP_STREAMS,
                                 .nodes = PPS_NODES_GAUSS,
                                 .orders = s->radiances ? SWEEP_STREAMS : 1};
            if (g[i] == 0) {
                opts.orders = 1; /* nobody sums orders that are zero */
            }
            pps_dom *dom;
            require(pps_dom_create(&medium, &opts, &dom));
            for (int t = 0; t < N_THICKNESS; t++) {
                sweep_slab(s, dom, thickness[t], &radiance, &flux);
            }
            pps_dom_free(dom);
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

static void row(const char *work, int streams, double ours, double target,
                double cdisort) {
    printf("%-36s %4d %11.4g %11.4g %7.2f %11.4g\n", work, streams, 1e6 * ours,
           1e6 * target, target / ours, 1e6 * cdisort);
    if (csv) {
        fprintf(csv, "%s,%d,%.17g,%.17g,%.17g\n", work, streams, ours, target, cdisort);
    }
}

/* cdisort 2.1.3 and the targets, seconds: figures of the machine they were set on. */
static void targets(void) {
    static const struct {
        int streams;
        bool radiances;
        double cdisort, times;
    } cases[] = {{16, false, 18.6e-6, 4}, {32, false, 75e-6, 4},
                 {64, false, 370e-6, 7},  {16, true, 1.89e-3, 20},
                 {32, true, 5.3e-3, 10},  {64, true, 22e-3, 10}};
    printf("%-36s %4s %11s %11s %7s %11s\n", "work (us)", "n", "ours", "target",
           "ratio", "cdisort");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        one_case *c = case_of(cases[i].streams, cases[i].radiances);
        row(cases[i].radiances ? "one case: radiances 10 x 16 x 19"
                               : "one case: fluxes at 10 depths",
            cases[i].streams, seconds(run_case, c), cases[i].cdisort / cases[i].times,
            cases[i].cdisort);
        free(c);
    }
    for (int radiances = 0; radiances < 2; radiances++) {
        sweep *s = sweep_of(radiances);
        double cdisort = radiances ? 690e-6 : 14.8e-6;
        row(radiances ? "2400 cases: radiances 5 x 16 x 19" : "2400 cases: fluxes",
            SWEEP_STREAMS, seconds(run_sweep, s) / N_CASES,
            cdisort / (radiances ? 60 : 40), cdisort);
        free(s->radiance);
        free(s->flux);
        free(s);
    }
    closed_form *c = hemispheric();
    row("hemispheric fluence, one depth", 0, seconds(run_closed, c) / N_FLUENCES, 5e-9,
        (double)NAN);
    free(c);
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
    if (argc > 2) {
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
        fprintf(csv, "work,streams,seconds,target_seconds,cdisort_seconds\n");
    }
    targets();
    eigenproblems();
    return csv && fclose(csv) ? 1 : 0;
}
