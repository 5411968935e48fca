/* False colours and their key.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_BAR_H
#define PPS_TREE_BAR_H

#include <ppscat/tree/picture.h>

/* Linear rgb of a value; grey where it is no number. */
void pps_bar_color(const pps_false_color *color, double value, double rgb[3]);

/* The columns at a picture's right that the key takes. */
int pps_bar_width(const pps_picture *picture);

/* The key in those columns, over a white ground, and the title across the top. */
void pps_bar_draw(const pps_false_color *color, pps_picture *picture);

#endif
