/* Letters of dots.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_FONT_H
#define PPS_TREE_FONT_H

#include <ppscat/tree/picture.h>

enum { PPS_FONT_WIDTH = 6, PPS_FONT_HEIGHT = 9 }; /* dots a letter, with the gap */

/* Columns that a text takes, a dot being `scale` pixels. */
int pps_font_width(const char *text, int scale);

/* Black, its upper left corner at (x, y); what is outside the picture is left out. */
void pps_font_write(pps_picture *picture, int x, int y, int scale, const char *text);

#endif
