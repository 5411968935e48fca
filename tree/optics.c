/* What leaves do with light, told by their colour.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/scene.h>

/* IEC 61966-2-1, of 0..255. */
static double linear(uint8_t value) {
    double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

/* The mean of a texture where the surface is; white if it is nowhere. */
static void texture_color(const pps_texture *texture, double alpha_min, double rgb[3]) {
    size_t n = (size_t)texture->width * (size_t)texture->height, there = 0;
    double table[256], sum[3] = {0};
    for (int i = 0; i < 256; i++) {
        table[i] = linear((uint8_t)i);
    }
    for (size_t t = 0; t < n; t++) {
        const uint8_t *texel = texture->rgba + 4 * t;
        bool here = texel[3] / 255.0 >= alpha_min;
        there += here;
        for (int i = 0; here && i < 3; i++) {
            sum[i] += table[texel[i]];
        }
    }
    for (int i = 0; i < 3; i++) {
        rgb[i] = there ? sum[i] / (double)there : 1;
    }
}

void pps_mesh_optics(const pps_mesh *mesh, pps_leaf_optics *optics) {
    double area = 0, sum[3] = {0};
    for (uint32_t m = 0; m < mesh->n_materials; m++) {
        const pps_material *material = &mesh->material[m];
        double own = 0, rgb[3] = {1, 1, 1};
        for (size_t i = 0; i < mesh->n_leaves; i++) {
            own += mesh->leaf[i].material == m ? mesh->leaf[i].area : 0;
        }
        if (own > 0 && material->texture >= 0) {
            texture_color(&mesh->texture[material->texture], material->alpha_min, rgb);
        }
        area += own;
        for (int i = 0; i < 3; i++) {
            sum[i] += own * fmin(fmax(rgb[i] * material->color[i], 0), 1);
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
