/* Light from leaf to leaf: radiosity, its form factors sampled by rays.
 *
 *   E(face) = E_sun + E_sky + mean over the face's rays of M(what the ray meets),
 *   M = rho E(face that is seen) + tau E(the other face)
 *
 * A leaf is cut into elements, each with the same light all over. Rays leave from points
 * that are spread over the leaf, by the cosine; what each of them meets is kept, so that
 * new light takes no new rays, but for the sun's when it moves. Reference: GTGB84; docs/theory.md
 * section 9.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_RADIOSITY_H
#define PPS_TREE_RADIOSITY_H

#include "tree/light_model.h"
#include "tree/sweep.h"

typedef struct pps_radiosity pps_radiosity;

/* All that does not move with sun and sky: elements, and what their rays meet. The scene
 * must outlive it and keep its instances, meshes and ground. */
pps_status pps_radiosity_create(const pps_scene *scene, const pps_cells *cells,
                                int threads, pps_radiosity **out);
void pps_radiosity_free(pps_radiosity *radiosity); /* NULL is fine */

/* Solve for the sun, sky and ground of lit, from the last answer on, at first from that of
 * the cells in `field`, to a change of `tolerance`; fills leaf_scattered, leaf_sky and
 * leaf_sun of the field. ground: of pps_lattice_ground. CONVERGENCE: not within 200 rounds. */
pps_status pps_radiosity_solve(pps_radiosity *radiosity, const pps_lit_scene *lit,
                               const pps_bands *ground, double tolerance,
                               pps_light_field *field);

/* Start the next solve from the cells again. */
void pps_radiosity_forget(pps_radiosity *radiosity);

#endif
