/* The command line of ppscat-preview.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_OPTIONS_H
#define PREVIEW_OPTIONS_H

#include <stdio.h>

#include "preview/stage.h"

/* Exit codes, as those of ppscat. */
enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

typedef struct {
    const char *scene;    /* NULL: a grove of cherries */
    const char *snapshot; /* NULL: a window */
    bool bench, help, version;
    int width, height, samples;
    double view[2]; /* azimuth and elevation, degrees */
    double zoom;
    double sun[2];  /* azimuth and elevation; */
    bool sun_given; /* else the scene's */
    double latitude;
    double albedo[PPS_BANDS_MAX]; /* of leaves; NaN: the scene's */
    double exposure;              /* times that of a white plane */
    stage_look look;
    stage_options stage;
    bool split;           /* a second model, in the right half */
    stage_options second; /* of which only the model is its own */
} preview_options;

/* A row of the table; metavar NULL: a flag. The last has no name. */
typedef struct {
    const char *name, *metavar, *help;
} preview_option;
extern const preview_option options_table[];

/* Words that options and settings share, and what they stand for; a table ends with a row
 * without a word. */
typedef struct {
    const char *word;
    unsigned value; /* of the enumeration, or sources */
} option_word;
extern const option_word component_words[], compensation_words[], show_words[],
    scattered_words[];

size_t words_count(const option_word *table);

/* The row that has the value; words_count() if there is none. */
size_t words_find(const option_word *table, unsigned value);

/* False, with one line that names option, value and what is allowed. */
bool options_read(int argc, char **argv, preview_options *out, pps_problem *problem);

/* Print --help. */
void options_help(FILE *out);

/* "lattice", "leaf", ..., "sppg" or "mc"; false: none of these. */
bool options_model(const char *name, stage_options *out);
const char *options_model_name(const stage_options *o);

/* Whether the model knows any of the light asked for. */
bool options_lit(const stage_options *o);

/* The names that options_model knows, with commas between them. */
void options_model_names(char *out, size_t size);

/* Of a second stage, whose model is set: everything else as for the first. */
void options_second(const preview_options *o, stage_options *second);

#endif
