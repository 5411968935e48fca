/* How much wood lies in each cell.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/wood.h"

#include <math.h>

#include "tree/grid.h"
#include "tree/vec.h"

/* Triangles larger than half a cell are split. */
static void add_triangle(pps_cells *cells, const double corner[3][3]) {
    double a[3], b[3], cross[3], edge = 0;
    vec_sub(corner[1], corner[0], a);
    vec_sub(corner[2], corner[0], b);
    vec_cross(a, b, cross);
    edge = fmax(vec_length(a), vec_length(b));
    int n = (int)fmin(fmax(ceil(2 * edge / cells->size), 1), 64);
    double part = vec_length(cross) / 2 / (n * n);
    for (int i = 0; i < n * n; i++) { /* row r has 2 r + 1 small triangles */
        int r = (int)sqrt(i + 0.5), k = i - r * r;
        double u = (r + (k % 2 ? 1 : 2) / 3.0) / n,
               v = (k / 2 + (k % 2 ? 2 : 1) / 3.0) / n;
        double at[3];
        vec_along(corner[0], u - v, a, at);
        vec_along(at, v, b, at);
        long c = pps_grid_cell(cells, at);
        if (c >= 0) {
            cells->wood[c] += part;
        }
    }
}

void pps_wood_measure(const pps_scene *scene, pps_cells *cells) {
    for (size_t k = 0; k < scene->n_instances; k++) {
        const pps_instance *instance = &scene->instance[k];
        const pps_mesh *mesh = scene->prototype[instance->prototype].mesh;
        for (size_t t = 0; t < mesh->n_triangles; t++) {
            double corner[3][3];
            if (mesh->leaf_of[t] != PPS_NO_LEAF) {
                continue;
            }
            for (int i = 0; i < 3; i++) {
                pps_instance_point(instance, mesh->position[mesh->triangle[t][i]],
                                   corner[i]);
            }
            add_triangle(cells, (const double(*)[3])corner);
        }
    }
}

double pps_wood_depth(const pps_cells *cells, size_t c) {
    return cells->wood[c] / (4 * cells->size * cells->size);
}
