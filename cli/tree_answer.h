/* Light models and Monte Carlo under one roof: what --model names, run on a scene.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TREE_ANSWER_H
#define PPSCAT_CLI_TREE_ANSWER_H

#include <ppscat/tree/field.h>

#include "tree_scene.h"

/* A model to be asked: a row of the library's table, or one of the two references. */
typedef enum { TREE_MODEL, TREE_TRACE, TREE_GATHER } tree_method_kind;
typedef struct {
    tree_method_kind kind;
    char name[32];
    const char *summary, *source;
    unsigned sources;
    bool compensates;
    pps_compensation compensate;  /* the G-factor named with it; NONE: --compensate's */
    const pps_light_model *model; /* NULL but for TREE_MODEL */
} tree_method;

size_t tree_method_count(void);
tree_method tree_method_at(size_t i);
size_t tree_method_find(const char *name); /* tree_method_count() if there is none */

/* The methods of --model and the components of --component; split ones are for pictures.
 * Free with tree_asked_free. */
typedef struct {
    size_t n_methods, n_components;
    tree_method *method;
    const tree_component **component;
} tree_asked;
int tree_asked_read(const invocation *call, bool split, tree_asked *out);
void tree_asked_free(tree_asked *asked);

/* A scene made ready: what methods need of it and one making serves. */
typedef struct {
    const pps_scene *scene;
    const tree_settings *settings;
    pps_cells *cells; /* NULL until needed */
    float *att;       /* of pps_leaf_attenuation; NULL until needed */
} tree_work;
void tree_work_free(tree_work *work);

/* What one method says of one component. */
typedef struct {
    pps_irradiance *light;
    pps_light_field *field; /* NULL: the method has no cells */
} tree_answer;

/* CLI_REFUSED, with the reason in *why: the method does not know this light. */
int tree_answer_find(tree_work *work, const tree_method *method,
                     const tree_component *component, tree_answer *out,
                     const char **why);
void tree_answer_free(tree_answer *answer);

/* Numbers of a leaf that the model took; NAN where it has none. */
typedef struct {
    double depth, thickness, visibility, g_factor;
} tree_place;
tree_place tree_answer_place(const tree_work *work, const tree_answer *answer,
                             size_t leaf);

#endif
