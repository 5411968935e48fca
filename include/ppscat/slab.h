/* The problem and its answers as plain values: slab, directions, fluxes.
 *
 * Conventions (the whole library): see ppscat.h.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_SLAB_H
#define PPSCAT_SLAB_H

#include <stddef.h>

#include <ppscat/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A homogeneous plane-parallel slab with a Henyey-Greenstein phase function. */
typedef struct pps_slab {
    double albedo;    /* single-scattering albedo, 0..1, both ends in */
    double g;         /* asymmetry parameter, -1 < g < 1 */
    double thickness; /* optical thickness, > 0, or INFINITY for a half-space */
} pps_slab;

/* Where a radiance is wanted: every depth with every cosine with every azimuth. */
typedef struct pps_grid {
    size_t n_tau, n_mu, n_phi;
    const double *tau; /* optical depths, 0..thickness */
    const double *mu;  /* direction cosines, -1..1 but not 0; mu > 0 goes down */
    const double *phi; /* azimuths in degrees, 0 = the beam's own */
} pps_grid;

/* Fluxes through a horizontal surface and mean intensities at one depth, for a beam
 * of unit irradiance normal to itself. */
typedef struct pps_flux {
    double up;           /* diffuse, upward */
    double down;         /* diffuse, downward */
    double direct;       /* of the beam: mu0 exp(-tau/mu0) */
    double mean_diffuse; /* (1/4pi) integral of the diffuse radiance */
    double mean;         /* the same with the beam: + exp(-tau/mu0) / 4pi */
} pps_flux;

/* PPS_OK when every field of the slab is in range, else PPS_ERR_ARGUMENT. */
PPS_API pps_status pps_slab_check(const pps_slab *slab);

/* PPS_OK when mu0 is in (0, 1], else PPS_ERR_ARGUMENT. */
PPS_API pps_status pps_mu0_check(double mu0);

/* PPS_OK when every depth is in [0, thickness] and every direction in range. */
PPS_API pps_status pps_grid_check(const pps_grid *grid, double thickness);

/* PPS_OK when each of the n depths is in [0, thickness]. */
PPS_API pps_status pps_tau_check(size_t n, const double *tau, double thickness);

#ifdef __cplusplus
}
#endif
#endif
