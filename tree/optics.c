/* What leaves do with light, told by their colour.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include <ppscat/tree/scene.h>

#include "tree/texture.h"

/* About the shares that a green broad leaf does not absorb; for files that give leaves no
 * colour, which then are white. */
static const double GREEN_LEAF[3] = {0.12, 0.24, 0.06};

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
        double own = area_of(mesh, m), rgb[3];
        pps_texture_mean(mesh, material, rgb);
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
