/* Lines of text on the screen.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_PANEL_H
#define PREVIEW_PANEL_H

#include "preview/gl.h"

typedef struct {
    GLuint program, texture, vertices;
} panel;

bool panel_create(panel *out, pps_problem *problem);
void panel_free(panel *p);

/* Draw lines, "\n" between them, into the upper left (or lower left) corner of the bound
 * frame buffer of that size; a dot of a letter is `scale` pixels. */
void panel_draw(const panel *p, int width, int height, int scale, bool low,
                const char *text);

#endif
