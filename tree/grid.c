/* Neighbours on the grid of cells.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/grid.h"

#include <math.h>

#include <omp.h>

int pps_thread_count(int threads) {
    return threads > 0 ? threads : omp_get_max_threads();
}

/* The neighbour's place along an axis, -1 outside. */
static int neighbour(const pps_cells *cells, int axis, int at, int step) {
    int n = cells->n[axis], to = at + step;
    if (cells->periodic && axis < 2) {
        return (to + n) % n;
    }
    return to >= 0 && to < n ? to : -1;
}

static double mean_about(const pps_cells *cells, const double *in, const int at[3]) {
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 27; k++) {
        int to[3], step[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        bool inside = true;
        for (int axis = 0; axis < 3; axis++) {
            to[axis] = neighbour(cells, axis, at[axis], step[axis]);
            inside = inside && to[axis] >= 0;
        }
        size_t c = inside ? ((size_t)to[2] * (size_t)cells->n[1] + (size_t)to[1]) *
                                    (size_t)cells->n[0] +
                                (size_t)to[0]
                          : 0;
        if (inside && cells->area[c] > 0) {
            sum += in[c];
            count++;
        }
    }
    return count > 0 ? sum / count : 0;
}

void pps_grid_smooth(const pps_cells *cells, const double *in, double *out) {
    size_t c = 0;
    for (int z = 0; z < cells->n[2]; z++) {
        for (int y = 0; y < cells->n[1]; y++) {
            for (int x = 0; x < cells->n[0]; x++, c++) {
                out[c] =
                    cells->area[c] > 0 ? mean_about(cells, in, (int[]){x, y, z}) : 0;
            }
        }
    }
}

long pps_grid_cell(const pps_cells *cells, const double at[3]) {
    long c = 0;
    for (int axis = 2; axis >= 0; axis--) {
        double n = cells->n[axis],
               k = floor((at[axis] - cells->low[axis]) / cells->size);
        if (cells->periodic && axis < 2) {
            k -= n * floor(k / n);
        }
        if (!(k >= 0 && k < n)) {
            return -1;
        }
        c = c * cells->n[axis] + (long)k;
    }
    return c;
}
