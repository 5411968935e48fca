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

/* Where a panel lies, pixels from the upper left corner. */
typedef struct {
    int x, y, width, height;
} panel_place;

/* Draw lines, "\n" between them, into the bound frame buffer of that size, their corner at
 * (x, y) from the left and top, or where negative from the right and bottom; a dot of a
 * letter is `scale` pixels. */
panel_place panel_draw(const panel *p, int width, int height, int scale, int x, int y,
                       const char *text);

/* Whether a place is on a panel, and at which line and letter. */
bool panel_at(const panel_place *place, int scale, double x, double y, int *line,
              int *column);

#endif
