/* The scene on a grid of cells: how much leaf each holds, and how deep it lies.
 *
 * All light models but the per-leaf one read these. Lengths along rays are optical: a unit
 * is a mean free path. Leaves of random orientation have the extinction sigma = one-sided
 * leaf area / (2 volume).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_CELLS_H
#define PPSCAT_TREE_CELLS_H

#include <ppscat/tree/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Directions in antipodal pairs: j and j ^ 1 are opposite. They point to where light comes
 * from; each stands for 4 pi/n of the sphere. data/directions-22.csv. */
typedef struct pps_directions {
    int n;
    const double (*to)[3];
} pps_directions;
PPS_API pps_directions pps_directions_22(void);

typedef struct pps_cells_options {
    int across;  /* cells across the longest side of the leaves' box, of the largest
                    plant in a scene of many; 0: 16. Repeating scenes: as near to it as
                    divides the periods */
    int samples; /* points a leaf that depths are averaged over; 0: 8 */
    uint64_t seed;
    int threads;     /* 0: all cores; never changes the answer */
    int most_points; /* of a cell, for depths and visibilities towards the directions (a
                        forest has many leaves a cell); 0: 64. The sun's use them all */
    int sun_samples; /* points a leaf that its own sunlight is averaged over; 0: 32, in
                        scenes of many leaves as many as make a million, at least
                        `samples` */
} pps_cells_options;

/* Per cell: c = (z * n[1] + y) * n[0] + x. Arrays along directions: [c * directions.n + j].
 * Means over points on the cell's leaves, without the triangle that a point is on: depths
 * by leaf area, visibilities by the area that leaves turn that way, as light falls on
 * them. Where area is 0 there are none: depths and visibilities are 0 and mean nothing.
 * Depths count branches as leaves, one for all a ray meets; visibilities are 0 behind one.
 * A leaf's points may lie in several cells; cell_of has the most of them. */
typedef struct pps_cells {
    int n[3];
    double low[3], size; /* corner of the grid, side of a cell, metres */
    bool periodic;       /* repeats along x and y, with n * size the period */
    size_t n_cells;
    pps_directions directions;
    double *area;       /* one-sided alpha-weighted leaf area, m^2 */
    double *wood;       /* surface of branches, m^2 */
    uint32_t *cell_of;  /* per scene leaf */
    uint32_t *n_leaves; /* per cell */
    uint32_t *n_points; /* per cell: points that the means are over */
    /* Towards the sun and on along its light: mean counts n+ and n- of leaves crossed
     * (SPP Eq. 29), and the mean visibility of the sun over points on leaves, and that of
     * the way on (sun_clear, "nothing behind"). */
    double *sun_depth, *sun_behind, *sun_visibility, *sun_clear;
    /* Per scene leaf, [0] front and [1] back: mean over points on the leaf of the cosine
     * to the sun where it is seen, 0 where it is not; NULL: not measured. */
    float (*leaf_sun)[2];
    /* The same towards every direction. */
    float *depth, *visibility;
    /* Mean over pairs of directions of both being clear from the same point: above the
     * product of their visibilities where some leaves of a cell are open and others
     * hidden. */
    double *both_clear;
} pps_cells;

/* Build the static part: the grid, leaf areas, and depths and visibilities towards the
 * directions. NULL options: defaults. The scene must outlive the cells and keep its
 * instances and meshes. ARGUMENT: no leaves; UNSUPPORTED: no cell divides both periods. */
PPS_API pps_status pps_cells_create(const pps_scene *scene,
                                    const pps_cells_options *options, pps_cells **out);

/* The part that moves with the sun, for the sun of the scene as it stands; the points are
 * those the cells were created with, of options only `threads` and `sun_samples` count. */
PPS_API pps_status pps_cells_set_sun(pps_cells *cells, const pps_scene *scene,
                                     const pps_cells_options *options);
PPS_API void pps_cells_free(pps_cells *cells); /* NULL is fine */

#ifdef __cplusplus
}
#endif
#endif
