/* Scenes for the stage: from a file, or the grove it opens on.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_STAGE_OPEN_H
#define PREVIEW_STAGE_OPEN_H

#include "preview/options.h"

/* The scene that the options ask for, its sun turned; NULL: the problem, that of a model
 * which does not take it too. */
pps_scene *scene_for(const preview_options *options, pps_problem *problem);

/* Turn a scene's sun: degrees from +x towards +y, and above the horizon. */
void turn_sun(pps_scene *scene, double azimuth, double elevation);

/* Let leaves scatter this share of a band's light, 0 to 1, in all their ways. */
void set_albedo(pps_scene *scene, int band, double albedo);

/* Whether leaves are larger than cells, and what to tell the user. */
bool leaves_too_large(const stage *s, char *out, size_t size);

#endif
