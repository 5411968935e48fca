/* Textures looked up in linear light.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_TEXTURE_H
#define PPS_TREE_TEXTURE_H

#include <ppscat/tree/mesh.h>

/* A texture's colours in linear light, rgb[3 * (y * width + x)]; NULL: no memory. */
float *pps_texture_linear(const pps_texture *texture);

/* Their mean over the texels that are there (alpha >= alpha_min). */
void pps_texture_mean(const pps_texture *texture, const float *linear, double alpha_min,
                      double rgb[3]);

/* At (u, v), v up: between texels in proportion, repeated with period 1. */
void pps_texture_at(const pps_texture *texture, const float *linear, double u, double v,
                    double rgb[3]);

#endif
