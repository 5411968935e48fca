/* Monte Carlo of the slab, with a standard error on every number.
 *
 * No binning: every flight of a photon adds to every wanted radiance or flux what its
 * next scattering is expected to send there (next-event estimation, averaged over the
 * place of that scattering, which keeps the variance finite at grazing angles). Random
 * numbers are a function of (seed, photon, event), so that an answer depends on seed and
 * photon count alone.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_MC_H
#define PPSCAT_MC_H

#include <stdint.h>

#include <ppscat/method.h>
#include <ppscat/slab.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Zero means default throughout. */
typedef struct pps_mc_opts {
    pps_light light;  /* beam and sky both 0: a beam of 1 */
    uint64_t photons; /* 0 = 1e5 */
    uint64_t seed;
} pps_mc_opts;

/* Diffuse radiance, 1/sr for a beam of 1, and its standard error, both indexed
 * [(k * n_mu + j) * n_phi + i] at depth k, cosine j, azimuth i. Light of the sky and the
 * ground that has not collided is diffuse and in both exact.
 *   slab            thickness may be INFINITY (then there is no ground)
 *   opts            may be NULL
 *   standard_error  may be NULL. 0 where a number is exact; INFINITY where so few
 *                   photons carry it that their spread says nothing, as deep in an
 *                   absorbing slab, or radiances where photons (1 - |g|)^2 < 30 leave
 *                   the peak unseen: such a value may be wrong by any factor
 * Status: ARGUMENT, MEMORY.
 * Accuracy: that of a sum over photons in fixed blocks; the answer is the same however
 * the blocks are computed. Time grows with photons, scatterings and wanted numbers; in
 * very thick conservative slabs as photons^(4/3), as long histories are thinned. */
PPS_API pps_status pps_mc_radiance(const pps_slab *slab, double mu0,
                                   const pps_mc_opts *opts, const pps_grid *at,
                                   double *radiance, double *standard_error);

/* Fluxes and mean intensities at n depths and, field by field, their standard errors
 * (0 for the direct beam). standard_error may be NULL. */
PPS_API pps_status pps_mc_flux(const pps_slab *slab, double mu0,
                               const pps_mc_opts *opts, size_t n, const double *tau,
                               pps_flux *flux, pps_flux *standard_error);

#ifdef __cplusplus
}
#endif
#endif
