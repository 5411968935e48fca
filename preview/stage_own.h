/* What the files of the stage share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_STAGE_OWN_H
#define PREVIEW_STAGE_OWN_H

#include "preview/stage.h"

/* Units that textures are bound to. */
enum {
    UNIT_IMAGE,
    UNIT_SPANS,
    UNIT_NEAR,
    UNIT_FAR,
    UNIT_CASTERS,
    UNIT_POSES,
    UNIT_SHADE,
    UNIT_CELLS,
    UNIT_SCATTERED,
    UNIT_SKY,
    UNIT_LEAVES,
    UNIT_OPEN
};

bool stage_cells_known(const stage *s); /* light is by cells, not by leaf */
bool stage_counts(const stage *s);      /* light is e^-count */
bool stage_by_point(const stage *s);    /* the sun's scattered light is by pixels */

/* Tables of what does not move, of cells' light, and of the sun. MEMORY. */
pps_status stage_fill_static(stage *s);
pps_status stage_fill_light(stage *s);

/* Maps that a light takes: one for all plants of a prototype and yaw. MEMORY. */
pps_status stage_count_poses(const pps_scene *scene, size_t *out);

/* Draw the maps of all poses towards a light, and its tables; shade lists for the ground
 * alone where `ground_only`. */
pps_status stage_fill_sun(const stage *s, const double to[3], bool ground_only,
                          stage_sun *out);
void stage_sun_free(stage_sun *sun);

/* Tell a program of maps and tables. */
void stage_use_sun(const stage_sun *sun, GLuint program);

/* How open to the sky the ground is. */
bool stage_open_ground(stage *s, pps_problem *problem);

#endif
