/* The panels of a picture: what each model says of each component, in the same colours.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_TREE_PANELS_H
#define PPSCAT_CLI_TREE_PANELS_H

#include <ppscat/tree/picture.h>

#include "tree_answer.h"

/* In the order of --false-color's words; those up to SHOW_G are numbers of cells. */
typedef enum {
    SHOW_DEPTH,
    SHOW_THICKNESS,
    SHOW_VISIBILITY,
    SHOW_G,
    SHOW_IRRADIANCE,
    SHOW_ERROR,
    SHOW_LIGHT /* no false colour */
} shown;

/* What the options ask of the picture. */
typedef struct {
    const char *path, *title; /* title: the word of --false-color */
    int width, height;        /* of a panel */
    double view[2], exposure; /* exposure 0: automatic */
    shown what;
    bool ranged;
    double range[2];
} picture_wish;

/* Draw every model's answer to every component, and write the file: one as it is, several
 * as a sheet, models down and components across, or the models across where there is one
 * component. All are exposed, or coloured, alike; those that are split are so among
 * themselves. CLI_REFUSED: some panels are blank, for a model does not know a component;
 * CLI_USAGE: nothing can be shown. */
int tree_panels_draw(picture_wish *wish, tree_work *work, const tree_asked *asked);

/* Panels of this width across and down: a row that is too wide for screens is folded. */
void tree_panels_count(const tree_asked *asked, int width, int *across, int *down);

#endif
