/* Image files to and from 8-bit RGBA.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_IMAGE_H
#define PPS_TREE_IMAGE_H

#include <stdio.h>

#include <ppscat/tree/mesh.h>

/* sRGB colour and alpha (255 where the image has none) of a PNG or JPEG file in memory;
 * `alpha` says whether the image has an alpha channel. FORMAT: `reason` names why. The
 * caller frees rgba. */
pps_status pps_image_decode(const unsigned char *bytes, size_t n, pps_texture *out,
                            bool *alpha, char reason[64]);

/* As a PNG file, to an open file; the texels are used up. FILE. */
pps_status pps_image_write(pps_texture *image, bool alpha, FILE *file);

#endif
