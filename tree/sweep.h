/* Sweeps: light carried through the grid along its directions, all colour bands at once.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SWEEP_H
#define PPS_TREE_SWEEP_H

#include <stdbool.h>
#include <stddef.h>

#include <ppscat/status.h>

/* Four colour bands in a vector register. */
typedef float pps_bands __attribute__((vector_size(16)));

typedef int pps_bands_mask __attribute__((vector_size(16)));

static inline pps_bands pps_bands_all(float x) { return (pps_bands){x, x, x, x}; }
static inline pps_bands pps_bands_at_least_0(pps_bands a) {
    return (pps_bands)((a > 0) & (pps_bands_mask)a);
}

enum { PPS_SWEEP_WIDTH = 4, PPS_SWEEP_DIRECTIONS_MAX = 64 };

/* Up to four directions of travel in one octant: swept together, so that one's arithmetic
 * fills the other's waiting. */
typedef struct pps_sweep_group {
    int n, direction[PPS_SWEEP_WIDTH], sign[3];
    float twice[3][PPS_SWEEP_WIDTH]; /* 2 |cosine| */
    float weight[PPS_SWEEP_WIDTH];   /* share of the sphere */
    float net[3][PPS_SWEEP_WIDTH];   /* weight times where the light comes from */
    int shift[2][PPS_SWEEP_WIDTH];   /* cells travelled between grid and ground */
    pps_bands *x_face, *y_face;      /* what enters by the sides; periodic: kept */
    pps_bands *z_face;               /* the plane that moves through the grid */
} pps_sweep_group;

typedef struct pps_sweeper {
    int n[3];
    bool periodic;
    const float *depth;   /* per cell: sigma times its side */
    int n_groups, n_down; /* the first n_down carry light downwards */
    pps_sweep_group group[PPS_SWEEP_DIRECTIONS_MAX];
    pps_bands *faces;
    size_t n_sides; /* how many of faces, from the first on, are those of the sides */
} pps_sweeper;

/* n directions to where light comes from, with their shares of the sphere; gap: from the
 * grid to the ground, in cells. */
pps_status pps_sweeper_init(pps_sweeper *sweeper, const int n_cells[3], bool periodic,
                            const float *depth, int n, const double (*to)[3],
                            const double *weight, double gap);
void pps_sweeper_clear(pps_sweeper *sweeper);

/* What one half of the directions, downward or upward, carries. */
typedef struct pps_sweep {
    const pps_bands *source; /* per cell: depth times what is scattered */
    pps_bands top, side;     /* enters there (side: open grids) */
    const pps_bands *ground; /* per column, enters from below; NULL: `side` */
    pps_bands *sum;          /* per cell: + mean of I_j */
    pps_bands *flux;         /* [3 * cell + axis]: + mean of I_j omega_j, or NULL */
    pps_bands *fall;         /* per column of ground: + mean of |cos| I_j, or NULL */
} pps_sweep;

/* From the plane that the last sweep ended in, first band: what of direction d of a
 * downward group reaches each column of ground; 1 where it passes by an open grid. */
void pps_sweep_clear(const pps_sweeper *sweeper, const pps_sweep_group *group, int d,
                     float *clear);

void pps_sweep_down(pps_sweeper *sweeper, const pps_sweep *sweep);
void pps_sweep_up(pps_sweeper *sweeper, const pps_sweep *sweep);

#endif
