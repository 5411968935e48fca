/* Makes data/auto_errors.csv, the errors of every candidate of the method `auto` over a
 * grid of slabs, against `exact` at 1e-7, or with 192 streams where it refuses:
 *
 *     cmake --build build/release --target auto-table      (2 minutes on one core)
 *
 * One row a slab: albedo,g,thickness,mu0,rms_rel,reflectance,transmittance, the last three
 * with one character a candidate (methods/auto_grid.h says which and how). rms_rel is that
 * of `ppscat error`: mean over depths (0, 5, .. 100 % of min(thickness, 10)) of the rms
 * over directions of the difference, divided by the mean exact radiance; the others are
 * relative errors of the diffuse fluxes at the edges.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <ppscat/method.h>

#include "core/quadrature.h"
#include "methods/auto_grid.h"

void openblas_set_num_threads(int n);

enum { N_TAU = 11, N_NODE = 6, N_MU = 2 * N_NODE, N_PHI = 6 };
enum { N_RAY = N_MU * N_PHI, N_BLOCK = N_TAU * N_RAY };

static const struct {
    const char *name;
    int streams;
} candidate[] = {
#define ROW(name, streams, cost) {name, streams},
    PPS_AUTO_CANDIDATES(ROW)
#undef ROW
};

typedef struct {
    double mu[N_MU], weight[N_MU], phi[N_PHI];
} directions;

static directions make_directions(void) {
    directions d;
    double node[N_NODE], weight[N_NODE];
    pps_gauss_unit(N_NODE, node, weight);
    for (int j = 0; j < N_NODE; j++) {
        d.mu[j] = -node[j];
        d.mu[N_NODE + j] = node[j];
        d.weight[j] = d.weight[N_NODE + j] = weight[j] / (2 * N_PHI);
    }
    for (int i = 0; i < N_PHI; i++) {
        d.phi[i] = 180 * (i + 0.5) / N_PHI;
    }
    return d;
}

/* Radiances and edge fluxes of one case; false where the method cannot. */
typedef struct {
    double radiance[N_BLOCK];
    pps_flux edge[2];
} answer;

static int evaluate(pps_model *model, double w, double mu0, const directions *d,
                    answer *out) {
    static const double share[N_TAU] = {0,   0.05, 0.1,  0.2, 0.3, 0.4,
                                        0.5, 0.6,  0.75, 0.9, 1};
    double tau[N_TAU], edges[2] = {0, w};
    for (int k = 0; k < N_TAU; k++) {
        tau[k] = share[k] * fmin(w, 10);
    }
    pps_grid at = {N_TAU, N_MU, N_PHI, tau, d->mu, d->phi};
    return model && !pps_model_solve(model, w, mu0) &&
           !pps_model_radiance(model, &at, out->radiance) &&
           !pps_model_flux(model, 2, edges, out->edge);
}

static double rms_rel(const answer *got, const answer *want, const directions *d) {
    double sum = 0;
    for (int k = 0; k < N_TAU; k++) {
        double square = 0, mean = 0;
        for (int i = 0; i < N_RAY; i++) {
            double exact = want->radiance[k * N_RAY + i];
            double off = got->radiance[k * N_RAY + i] - exact;
            square += d->weight[i / N_PHI] * off * off;
            mean += d->weight[i / N_PHI] * exact;
        }
        sum += mean > 0 ? sqrt(square) / mean : square > 0 ? HUGE_VAL : 0;
    }
    return sum / N_TAU;
}

static double relative(double got, double want) {
    return got == want ? 0 : fabs(got - want) / fabs(want);
}

static char encode(double error) {
    double level = ceil(PPS_AUTO_PER_DECADE * log10(fmax(error, 1e-300)));
    level = fmax(PPS_AUTO_LOWEST, fmin(PPS_AUTO_HIGHEST, level));
    return pps_auto_code((int)level);
}

static pps_model *make(const char *name, int streams, double tolerance,
                       const pps_slab *slab) {
    pps_model *model = NULL;
    pps_options opts = {.streams = streams, .tolerance = tolerance};
    const pps_method *method = pps_method_find(name);
    if (method && pps_model_create(method, slab, &opts, &model)) {
        model = NULL;
    }
    return model;
}

/* All candidates on all thicknesses and beams of one (albedo, g), into text. */
static void medium(double albedo, double g, const directions *d, FILE *out) {
    static answer want, got;
    pps_slab slab = {albedo, g, 1};
    pps_model *exact = make("exact", 0, 1e-7, &slab), *model[PPS_AUTO_N_CANDIDATES];
    pps_model *fallback = make("exact", 192, 0, &slab);
    for (int c = 0; c < PPS_AUTO_N_CANDIDATES; c++) {
        model[c] = make(candidate[c].name, candidate[c].streams, 0, &slab);
    }
    for (int i = 0; i < PPS_AUTO_N_THICKNESS * PPS_AUTO_N_MU0; i++) {
        double w = pps_auto_thickness[i / PPS_AUTO_N_MU0];
        double mu0 = pps_auto_mu0[i % PPS_AUTO_N_MU0];
        if (!evaluate(exact, w, mu0, d, &want) &&
            !evaluate(fallback, w, mu0, d, &want)) {
            fprintf(stderr, "no reference: %g %g %g %g\n", albedo, g, w, mu0);
            exit(1);
        }
        char code[PPS_AUTO_METRICS][PPS_AUTO_N_CANDIDATES + 1] = {{0}};
        for (int c = 0; c < PPS_AUTO_N_CANDIDATES; c++) {
            int can = evaluate(model[c], w, mu0, d, &got);
            double error[PPS_AUTO_METRICS] = {
                rms_rel(&got, &want, d),
                relative(got.edge[0].up, want.edge[0].up),
                relative(got.edge[1].down, want.edge[1].down),
            };
            for (int m = 0; m < PPS_AUTO_METRICS; m++) {
                code[m][c] = can ? encode(error[m]) : '~';
            }
        }
        fprintf(out, "%g,%g,%g,%g,%s,%s,%s\n", albedo, g, w, mu0, code[0], code[1],
                code[2]);
    }
    for (int c = 0; c < PPS_AUTO_N_CANDIDATES; c++) {
        pps_model_free(model[c]);
    }
    pps_model_free(fallback);
    pps_model_free(exact);
}

int main(void) {
    directions d = make_directions();
    openblas_set_num_threads(1);
    printf("albedo,g,thickness,mu0,rms_rel,reflectance,transmittance\n");
    for (int i = 0; i < PPS_AUTO_N_ALBEDO * PPS_AUTO_N_G; i++) {
        medium(pps_auto_albedo[i / PPS_AUTO_N_G], pps_auto_g[i % PPS_AUTO_N_G], &d,
               stdout);
        fprintf(stderr, "\r%d of %d media", i + 1, PPS_AUTO_N_ALBEDO * PPS_AUTO_N_G);
    }
    fprintf(stderr, "\n");
    return fflush(stdout) ? 1 : 0;
}
