/* What leaves do with light, told by their colour.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/scene.h>

#include "tree/srgb.h"

/* About the shares that a green broad leaf does not absorb; for files that give leaves no
 * colour, which then are white. */
static const double GREEN_LEAF[3] = {0.12, 0.24, 0.06};

/* The mean of a texture in linear light where the surface is; white if it is nowhere. */
static void texture_color(const pps_texture *texture, double alpha_min, double rgb[3]) {
    size_t n = (size_t)texture->width * (size_t)texture->height, there = 0;
    double linear[256], sum[3] = {0};
    for (int i = 0; i < 256; i++) {
        linear[i] = srgb_decode(i / 255.0);
    }
    for (size_t t = 0; t < n; t++) {
        const uint8_t *texel = texture->rgba + 4 * t;
        bool here = texel[3] / 255.0 >= alpha_min;
        there += here;
        for (int i = 0; here && i < 3; i++) {
            sum[i] += linear[texel[i]];
        }
    }
    for (int i = 0; i < 3; i++) {
        rgb[i] = there ? sum[i] / (double)there : 1;
    }
}

static double area_of(const pps_mesh *mesh, uint32_t material) {
    double area = 0;
    for (size_t i = 0; i < mesh->n_leaves; i++) {
        area += mesh->leaf[i].material == material ? mesh->leaf[i].area : 0;
    }
    return area;
}

void pps_mesh_optics(const pps_mesh *mesh, pps_leaf_optics *optics) {
    double area = 0, sum[3] = {0};
    for (uint32_t m = 0; m < mesh->n_materials; m++) {
        const pps_material *material = &mesh->material[m];
        const double *c = material->color;
        bool white = material->texture < 0 && c[0] >= 1 && c[1] >= 1 && c[2] >= 1;
        double own = area_of(mesh, m), rgb[3] = {1, 1, 1};
        if (own > 0 && material->texture >= 0) {
            texture_color(&mesh->texture[material->texture], material->alpha_min, rgb);
        }
        area += own;
        for (int i = 0; i < 3; i++) {
            double color = white ? GREEN_LEAF[i] : rgb[i] * c[i];
            sum[i] += own * fmin(fmax(color, 0), 1);
        }
    }
    *optics = (pps_leaf_optics){{{0}}, {{0}}};
    for (int face = 0; face < 2; face++) {
        for (int b = 0; b < 3 && area > 0; b++) {
            optics->reflectance[face][b] = optics->transmittance[face][b] =
                sum[b] / area / 2;
        }
    }
}

double pps_leaf_albedo(const pps_leaf_optics *optics, int band) {
    return (optics->reflectance[PPS_FRONT][band] +
            optics->transmittance[PPS_FRONT][band] +
            optics->reflectance[PPS_BACK][band] +
            optics->transmittance[PPS_BACK][band]) /
           2;
}
