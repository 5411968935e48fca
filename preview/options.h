/* The command line of ppscat-preview.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_OPTIONS_H
#define PREVIEW_OPTIONS_H

#include "preview/stage.h"

/* Exit codes, as those of ppscat. */
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

typedef struct {
    const char *scene;    /* NULL: a grove of cherries */
    const char *snapshot; /* NULL: a window */
    bool bench, help, version;
    int width, height, samples;
    double view[2];  /* azimuth and elevation, degrees */
    double sun[2];   /* the same; */
    bool sun_given;  /* else the scene's */
    double exposure; /* times that of a white plane */
    stage_look look;
    stage_options stage;
} preview_options;

/* False, with one line that names option, value and what is allowed. */
bool options_read(int argc, char **argv, preview_options *out, pps_problem *problem);

/* The text of --help. */
const char *options_help(void);

/* "lattice", "leaf", ..., "sppg" or "mc"; false: none of these. */
bool options_model(const char *name, stage_options *out);

/* The names that options_model knows, with commas between them. */
void options_model_names(char *out, size_t size);

#endif
