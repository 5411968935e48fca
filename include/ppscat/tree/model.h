/* Light models of the crown: a table of them, as for the slab.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_MODEL_H
#define PPSCAT_TREE_MODEL_H

#include <ppscat/tree/cells.h>
#include <ppscat/tree/leaf_light.h>
#include <ppscat/tree/light.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The G-factor that takes the slab's infinite plane back (SPP section 4). */
typedef enum {
    PPS_COMPENSATE_NONE,
    PPS_COMPENSATE_DERIVED, /* Eqs. 23-28 and A.3 derived anew, docs/theory.md */
    PPS_COMPENSATE_PRINTED  /* the printed shape, upper half sphere */
} pps_compensation;

/* The same by the names that the programs use: X(name, pps_compensation). */
#define PPS_COMPENSATION_LIST(X)                                                       \
    X("none", PPS_COMPENSATE_NONE)                                                     \
    X("derived", PPS_COMPENSATE_DERIVED)                                               \
    X("printed", PPS_COMPENSATE_PRINTED)

typedef struct pps_light_options {
    pps_compensation compensate;
    unsigned sources;      /* pps_light_source, added; 0: all that the model has */
    double kappa;          /* `lattice`: escape factor; 0: measured */
    pps_sun_mean sun_mean; /* `leaf`: how it averages over its octants */
    int threads;           /* 0: all cores */
    /* Models with takes_attenuations: the scene's pps_leaf_attenuation; NULL: they are found
     * anew, which takes far longer than the rest. */
    const float *att;
} pps_light_options;

typedef struct pps_light_model {
    const char *name, *summary, *source;
    unsigned sources;        /* pps_light_source that it has */
    bool compensates;        /* takes the G-factor */
    bool without_cells;      /* needs none: cells may be NULL */
    bool without_field;      /* lights leaves, not cells: no pps_light_field */
    bool takes_attenuations; /* of the leaves' octants */
    const struct pps_light_model_ops *ops;
} pps_light_model;

/* The table, and a name's row or NULL. */
PPS_API size_t pps_light_model_count(void);
PPS_API const pps_light_model *pps_light_model_at(size_t i);
PPS_API const pps_light_model *pps_light_model_find(const char *name);

/* Irradiance of every leaf. cells have the sun set. UNSUPPORTED: sources the model lacks. */
PPS_API pps_status pps_light_model_run(const pps_light_model *model,
                                       const pps_scene *scene, const pps_cells *cells,
                                       const pps_light_options *options,
                                       pps_irradiance **out);

#ifdef __cplusplus
}
#endif
#endif
