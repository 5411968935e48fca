/* Every method behind one interface, and the table of them.
 *
 *     const pps_method *method = pps_method_find("spp-refined");
 *     pps_model *model;
 *     pps_model_create(method, &slab, NULL, &model);
 *     pps_model_solve(model, slab.thickness, mu0);
 *     pps_model_radiance(model, &grid, radiance);
 *     pps_model_free(model);
 *
 * Sweep with the slow parameters outside: a model is made for one (albedo, g); a new
 * thickness is cheap and a new mu0 at the same thickness cheaper.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_METHOD_H
#define PPSCAT_METHOD_H

#include <stdbool.h>
#include <stdint.h>

#include <ppscat/dom.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What falls in from above and what lies below. */
typedef struct pps_light {
    double beam;   /* irradiance of the beam through a surface normal to it, >= 0 */
    double sky;    /* isotropic diffuse radiance falling on the lit side, >= 0 */
    double ground; /* Lambertian reflectance below the slab, 0..1; 0 is black */
} pps_light;

/* Which error `auto` holds to the tolerance. */
typedef enum {
    PPS_TOLERANCE_OF_FIELD, /* rms_rel of the radiance, as `ppscat error` has it */
    PPS_TOLERANCE_OF_REFLECTANCE, /* relative, of the diffuse flux at the top */
    PPS_TOLERANCE_OF_TRANSMITTANCE
} pps_tolerance_of;

/* Zero means default throughout; a method ignores what does not concern it. */
typedef struct pps_options {
    int streams; /* of `exact`; 0 = as many as `tolerance` asks for */
    pps_nodes nodes;
    pps_delta_m delta_m;
    double tolerance; /* 0 = 1e-6. For a radiance relative to max(its value, 1e-3 of
                         the largest of its case); for fluxes relative */
    pps_tolerance_of tolerance_of; /* of `auto` */
    pps_light light;               /* beam and sky both 0: a beam of 1 */
    uint64_t photons;              /* of `mc`; 0 = 1e5 */
    uint64_t seed;                 /* of `mc` */
} pps_options;

/* What a method used for the last output. */
typedef struct pps_info {
    int streams, orders; /* 0 where it has none, or needs none (albedo 0) */
    pps_nodes nodes;
    bool delta_m;          /* the forward peak was scaled */
    double error_estimate; /* relative, as `tolerance`; NAN where the method has none */
    const struct pps_method *used; /* what `auto` picked; else NULL */
    bool by_table; /* ... with error_estimate a bound from its table of errors */
} pps_info;

typedef struct pps_method_ops pps_method_ops;

typedef struct pps_method {
    const char *name;
    const char *cost;    /* what one more case costs, in words */
    const char *summary; /* one line */
    const char *limits;  /* where it is wrong or refuses */
    bool fields, fluxes, half_space;
    bool shares_beams; /* with given streams, many beams cost little more than one */
    const pps_method_ops *ops; /* private */
} pps_method;

/* The table, in the order it is shown; *n methods. */
PPS_API const pps_method *const *pps_method_table(size_t *n);

/* The method of that name, or NULL. */
PPS_API const pps_method *pps_method_find(const char *name);

typedef struct pps_model pps_model;

/* A model of (albedo, g); slab->thickness is only a hint. opts may be NULL.
 * *out is NULL on failure. */
PPS_API pps_status pps_model_create(const pps_method *method, const pps_slab *slab,
                                    const pps_options *opts, pps_model **out);

/* Set thickness and beam. UNSUPPORTED where the method does not cover them. */
PPS_API pps_status pps_model_solve(pps_model *model, double thickness, double mu0);

/* The same for n beams at once, mu0[n]; outputs then hold one block a beam, one after the
 * other. To the last bit what beam by beam gives, and faster where the method shares work
 * (`exact` with given streams). Where an output fails for one of the beams it fails. */
PPS_API pps_status pps_model_solve_beams(pps_model *model, double thickness, size_t n,
                                         const double *mu0);

/* Diffuse radiance under the light of the options (for a beam of 1: per unit irradiance,
 * 1/sr); uncollided sky light is diffuse. Index as pps_dom_radiance.
 * Not const: a method may refine itself until it meets the tolerance. */
PPS_API pps_status pps_model_radiance(pps_model *model, const pps_grid *at,
                                      double *radiance);

/* Fluxes and mean intensities at n depths, flux[b * n + k] of beam b at depth k. */
PPS_API pps_status pps_model_flux(pps_model *model, size_t n, const double *tau,
                                  pps_flux *flux);

/* What the last output used; of several beams, for the first. */
PPS_API void pps_model_query(const pps_model *model, pps_info *info);

/* What it used for beam b, b < n of the last solve. */
PPS_API void pps_model_query_beam(const pps_model *model, size_t b, pps_info *info);

PPS_API void pps_model_free(pps_model *model);

#ifdef __cplusplus
}
#endif
#endif
