/* Layers that double: reflection and transmission of a homogeneous slab for one
 * azimuthal order, from a very thin layer up, and the field at any depth by halving the
 * slab again.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_REFERENCE_LAYERS_H
#define PPS_REFERENCE_LAYERS_H

#include <ppscat/slab.h>

/* Directions of a hemisphere: n nodes with weights, then n_all - n without. Those take no
 * part in the scattering of others, so they may lie anywhere. */
typedef struct pps_directions {
    int n, n_all;
    double *mu;     /* n_all, in (0, 1] */
    double *weight; /* n, summing to 1 */
} pps_directions;

typedef struct pps_stack pps_stack;

pps_stack *pps_stack_new(void); /* NULL: no memory */
void pps_stack_free(pps_stack *stack);

/* What to double: up to slab.thickness (INFINITY: until no light from below could be seen
 * at `deepest`) for azimuthal order m, with n_moments moments of the phase function and a
 * beam of that irradiance along mu0. */
typedef struct pps_stack_problem {
    pps_slab slab;
    double mu0, beam;
    double deepest;
    double accuracy; /* relative, of the thin layer at the start */
    int m, n_moments;
} pps_stack_problem;

/* The directions are not copied. Memory is kept for the next problem. */
pps_status pps_stack_build(pps_stack *stack, const pps_stack_problem *problem,
                           const pps_directions *directions);

/* Component m of the diffuse radiance, downward and upward (n_all each), at depth tau
 * in [0, thickness], where the beam and `from_above`, `from_below` (n_all each) fall on
 * the two sides. */
void pps_stack_at(pps_stack *stack, double tau, const double *from_above,
                  const double *from_below, double *down, double *up);

/* 1 - the spherical reflectance of the slab, to full relative accuracy; m = 0. */
double pps_stack_not_reflected(pps_stack *stack);

#endif
