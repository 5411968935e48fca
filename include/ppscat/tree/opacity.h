/* Deep opacity maps: how many surfaces of a plant light has crossed on its way to a point.
 *
 * A map looks at one mesh, in the mesh's own space, from a distant light. Its texels keep
 * where light first and last meets a surface, and how many it has crossed at the ends of
 * layers in between. A plant that stands in a scene many times has one map for each
 * direction; depths of scenes are sums over their plants (SPP Eq. 31).
 *
 * Reference: Yuksel & Keyser 2008, as SPP section 5.1 uses it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_OPACITY_H
#define PPSCAT_TREE_OPACITY_H

#include <ppscat/tree/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PPS_OPACITY_LAYERS = 8 };

typedef struct pps_opacity_options {
    int texels; /* along each side, 4 to 4096; 0: 128. More than 256 only resolves
                   single leaves: good for a sun's shadows, no better for depths */
    int wood;   /* what a branch counts, in leaves; 0: 1 */
} pps_opacity_options;

/* Texel (i, j) is number t = j * texels + i; its middle is the line of the points p with
 * dot(p, axis[0]) = low[0] + (i + 1/2) size[0], and axis[1], j, low[1] and size[1]. Lengths
 * along the light, first and last, are dot(p, axis[2]) and grow away from where it is
 * from, in metres. A texel that meets nothing has first > last. */
typedef struct pps_opacity_map {
    int texels;
    double axis[3][3]; /* right-handed and orthonormal; axis[2] = -to */
    double low[2], size[2];
    float *first, *last; /* [t] */
    float *count; /* [t * PPS_OPACITY_LAYERS + k]: surfaces met down to the end of
                            layer k, of equal layers from first to last */
} pps_opacity_map;

/* The map towards the unit vector `to`. Every leaf triangle counts one where its surface
 * is (alpha); of wood only the sides that face the light, so that a branch counts once.
 * Texels are covered as by OpenGL with 1/256 of a texel: the GPU makes the same map.
 * NULL options: defaults. MEMORY; ARGUMENT: options, or `to` is not of length 1. */
PPS_API pps_status pps_opacity_map_create(const pps_mesh *mesh, const double to[3],
                                          const pps_opacity_options *options,
                                          pps_opacity_map **out);
PPS_API void pps_opacity_map_free(pps_opacity_map *map); /* NULL is fine */

/* The frame alone, without texels: axes, low and size as the map would have them. Where a
 * GPU is to fill the texels. */
PPS_API pps_status pps_opacity_frame(const pps_mesh *mesh, const double to[3],
                                     const pps_opacity_options *options,
                                     pps_opacity_map *frame);

/* Surfaces that light crosses down to a point of the mesh's space: linear between layers
 * and between texels, 0 before the first and off the map. On a surface half of its own
 * layer is counted. */
PPS_API double pps_opacity_depth(const pps_opacity_map *map, const double point[3]);

/* The share of light that reaches a point where every surface is opaque: texels whose
 * first surface is not nearer to the light by more than `bias` metres, in proportion. */
PPS_API double pps_opacity_visibility(const pps_opacity_map *map, const double point[3],
                                      double bias);

#ifdef __cplusplus
}
#endif
#endif
