/* A picture of linear radiance on the GPU, with several samples a pixel.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_FRAME_H
#define PREVIEW_FRAME_H

#include <ppscat/tree/picture.h>

#include "preview/gl.h"

typedef struct {
    int width, height, samples; /* samples: as many as there are */
    GLuint drawn, color, depth; /* what is drawn into, of many samples */
    GLuint shown, texture;      /* their means */
} frame;

/* samples: 1 .. 8, or as many as the driver has. */
bool frame_create(int width, int height, int samples, frame *out, pps_problem *problem);
void frame_free(frame *f);

void frame_begin(const frame *f);  /* draw into it from now on */
void frame_finish(const frame *f); /* take the means */

/* Read the means into a picture of the same size. */
void frame_read(const frame *f, pps_picture *out);

#endif
