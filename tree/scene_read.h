/* What the parts of the scene reader share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SCENE_READ_H
#define PPS_TREE_SCENE_READ_H

#include <ppscat/tree/scene.h>

#include "tree/json.h"

/* Ranges that several values share. */
#define PPS_ANY ((pps_json_range){-INFINITY, INFINITY, false})
#define PPS_POSITIVE ((pps_json_range){0, INFINITY, true})
#define PPS_NOT_NEGATIVE ((pps_json_range){0, INFINITY, false})
#define PPS_SHARE ((pps_json_range){0, 1, false})

/* /prototypes, after the bands. */
pps_status pps_scene_read_prototypes(const pps_json *root, pps_scene *scene);

/* /instances, after the prototypes. */
pps_status pps_scene_read_instances(const pps_json *root, pps_scene *scene);

/* Whether the bands are red, green and blue, in which colours are known. */
bool pps_scene_in_color(const pps_scene *scene);

#endif
