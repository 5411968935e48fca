/* Deep opacity maps made by the GPU: the same texels as pps_opacity_map_create.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_GPU_MAP_H
#define PREVIEW_GPU_MAP_H

#include <ppscat/tree/opacity.h>

#include "preview/gpu_mesh.h"

/* A stack of maps of one size. span holds (-first, last), below -1e37 where a texel meets
 * nothing; count, where there is one, layers 0-3 in [0] and 4-7 in [1]. */
typedef struct {
    int texels, n;
    GLuint span, count[2]; /* 2D array textures; RG32F, RGBA16F */
    GLuint frame_buffer, sampler;
    GLuint span_program, count_program;
} gpu_maps;

/* counts: with layers of counts, or the spans alone. */
bool gpu_maps_create(int texels, int n, bool counts, gpu_maps *out,
                     pps_problem *problem);
void gpu_maps_free(gpu_maps *maps);

/* Draw map number i of a mesh in the frame of pps_opacity_frame, which has the texels of
 * these maps; wood as in pps_opacity_options (0: 1). Changes the viewport. */
void gpu_maps_draw(const gpu_maps *maps, int i, const gpu_mesh *mesh,
                   const pps_opacity_map *frame, int wood);

/* Read map i back into one that has room for it (first, last, count). */
void gpu_maps_read(const gpu_maps *maps, int i, pps_opacity_map *out);

#endif
