/* The grid and the candidates of the error table behind the method `auto`; shared by the
 * program that makes the table, the one that compiles it and the method that reads it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_METHODS_AUTO_GRID_H
#define PPS_METHODS_AUTO_GRID_H

/* Candidates: name, streams (of `exact`; 0 elsewhere) and cost, that is the time of one
 * more evaluation of many radiances, hemispheric = 1. It is what `ppscat chart` measures,
 * to about a factor of 1.5 over its regimes; that of `exact` grows as 0.9 streams^1.43, by
 * which those of 12, 24, 48, 96 and 128 are. The table has them in this order; costs may
 * change without it. */
#define PPS_AUTO_CANDIDATES(X)                                                         \
    X("hemispheric", 0, 1)                                                             \
    X("single", 0, 6)                                                                  \
    X("eddington", 0, 12)                                                              \
    X("spp-refined", 0, 29)                                                            \
    X("fourstream", 0, 63)                                                             \
    X("exact", 4, 10)                                                                  \
    X("exact", 8, 19)                                                                  \
    X("exact", 12, 31)                                                                 \
    X("exact", 16, 46)                                                                 \
    X("exact", 24, 85)                                                                 \
    X("exact", 32, 124)                                                                \
    X("exact", 48, 228)                                                                \
    X("exact", 64, 330)                                                                \
    X("exact", 96, 615)                                                                \
    X("exact", 128, 930)

/* What is kept of an error. */
enum { PPS_AUTO_FIELD, PPS_AUTO_REFLECTANCE, PPS_AUTO_TRANSMITTANCE, PPS_AUTO_METRICS };

/* Grid lines, ascending; the last thickness also stands for all above and a half-space.
 * At thickness 0.1 and 1 `exact` takes other nodes and its errors jump: a line either side. */
static const double pps_auto_albedo[] = {0, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999, 1};
static const double pps_auto_g[] = {-0.8, -0.5, 0, 0.3, 0.5, 0.65, 0.8, 0.9};
static const double pps_auto_thickness[] = {0.01, 0.05, 0.0999, 0.1, 0.3, 0.999,
                                            1,    2.5,  5,      10,  30,  200};
static const double pps_auto_mu0[] = {0.05, 0.12, 0.25, 0.5, 0.75, 1};

enum {
    PPS_AUTO_N_ALBEDO = sizeof pps_auto_albedo / sizeof pps_auto_albedo[0],
    PPS_AUTO_N_G = sizeof pps_auto_g / sizeof pps_auto_g[0],
    PPS_AUTO_N_THICKNESS = sizeof pps_auto_thickness / sizeof pps_auto_thickness[0],
    PPS_AUTO_N_MU0 = sizeof pps_auto_mu0 / sizeof pps_auto_mu0[0],
#define PPS_AUTO_COUNT(name, streams, cost) +1
    PPS_AUTO_N_CANDIDATES = 0 PPS_AUTO_CANDIDATES(PPS_AUTO_COUNT),
#undef PPS_AUTO_COUNT
    PPS_AUTO_N_CELLS =
        PPS_AUTO_N_ALBEDO * PPS_AUTO_N_G * PPS_AUTO_N_THICKNESS * PPS_AUTO_N_MU0
};

/* An error as one character: fifths of a decade, rounded up, from 1e-12 ('0') to 1e3;
 * '~' where the candidate cannot do the case. */
enum { PPS_AUTO_PER_DECADE = 5, PPS_AUTO_LOWEST = -60, PPS_AUTO_HIGHEST = 15 };
static inline char pps_auto_code(int level) {
    return (char)('0' + level - PPS_AUTO_LOWEST);
}
static inline int pps_auto_level(char code) { return code - '0' + PPS_AUTO_LOWEST; }

#endif
