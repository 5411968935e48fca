/* The light model `lattice`: discrete ordinates on the crown's own cells.
 *
 *   phi = direct + phi_d,  phi_d = sum_j w_j I_j,   I_j = 4 pi times the radiance,
 *   omega_j.grad I_j = -sigma (albedo (kappa_0 direct + kappa_1 phi_d) - I_j),
 *
 * with sigma = one-sided leaf area / (2 volume), the measured mean visibility for the
 * direct light of sun and sky, and nothing diffuse from outside but what a Lambertian
 * ground sends back. Reference: docs/theory.md section 9.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_LATTICE_H
#define PPS_TREE_LATTICE_H

#include "tree/light_model.h"
#include "tree/sweep.h"

typedef struct pps_lattice pps_lattice;

/* All that does not move with sun and sky: extinction, escape factors, plan of sweeps.
 * kappa 0: measured. */
pps_status pps_lattice_create(const pps_scene *scene, const pps_cells *cells,
                              double kappa, int threads, pps_lattice **out);
void pps_lattice_free(pps_lattice *lattice); /* NULL is fine */

/* Whether ground and options are still those it was made for. */
bool pps_lattice_fits(const pps_lattice *lattice, const pps_lit_scene *lit);

/* Solve for the sun, sky and ground of lit, from the last answer on; fills diffuse, flux
 * and sweeps of the field. CONVERGENCE: not within `tolerance` after 200 sweeps. */
pps_status pps_lattice_solve(pps_lattice *lattice, const pps_lit_scene *lit,
                             double tolerance, pps_light_field *field);

/* What the ground sends up, of the last solve: 4 times its exitance, a column of cells
 * each (y * n[0] + x), and last that of the open ground beside the grid. NULL: no ground. */
const pps_bands *pps_lattice_ground(const pps_lattice *lattice);

/* Start the next solve from no light. */
void pps_lattice_forget(pps_lattice *lattice);

/* Scatter the sun's light evenly from now on, as the slab library does at g = 0. */
void pps_lattice_set_isotropic(pps_lattice *lattice);

/* The escape factor kappa_1 of a cell. */
double pps_lattice_kappa(const pps_lattice *lattice, size_t c);

#endif
