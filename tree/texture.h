/* Textures looked up in linear light.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_TEXTURE_H
#define PPS_TREE_TEXTURE_H

#include <ppscat/tree/mesh.h>

/* Linear rgb of a mesh's surface at barycentric (u, v) of a triangle, between texels in
 * proportion, repeated; white where the material has no texture. */
void pps_texture_at(const pps_mesh *mesh, size_t triangle, double u, double v,
                    double rgb[3]);

/* Its mean over the texels that are there (alpha >= alpha_min). */
void pps_texture_mean(const pps_mesh *mesh, const pps_material *material,
                      double rgb[3]);

#endif
