/* The scene and the settings that the subcommands of `tree` share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TREE_SCENE_H
#define PPSCAT_CLI_TREE_SCENE_H

#include <ppscat/tree/cells.h>
#include <ppscat/tree/light.h>
#include <ppscat/tree/model.h>

#include "options.h"

/* What the options say of the work on a scene. */
typedef struct {
    uint64_t seed;
    int threads;
    bool progress;
    pps_cells_options cells;
    pps_trace_options trace;
    pps_light_options light;
    int gather_samples;
} tree_settings;

int tree_settings_read(const invocation *call, tree_settings *out);

/* The scene that the operand names, with its sun where --sun puts it; CLI_USAGE when there
 * is none or it cannot be read. */
int tree_scene_open(const invocation *call, pps_scene **out);

/* Components by name; behind the plain ones the same, split for the eye. */
typedef struct {
    const char *name;
    unsigned sources; /* pps_light_source, added */
    bool split;       /* a picture sorts it by what leaves reflect and let through */
} tree_component;
enum { TREE_COMPONENTS = 5, TREE_COMPONENTS_SPLIT = 2 * TREE_COMPONENTS };
extern const tree_component tree_components[TREE_COMPONENTS_SPLIT];

#endif
