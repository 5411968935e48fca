/* The convex hull by Andrew's monotone chain, after a sieve for points well inside.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/hull.h"

#include <stdlib.h>
#include <string.h>

static int by_xy(const void *a, const void *b) {
    const double *p = a, *q = b;
    if (p[0] != q[0]) {
        return p[0] < q[0] ? -1 : 1;
    }
    return (p[1] > q[1]) - (p[1] < q[1]);
}

static double turn(const double o[2], const double a[2], const double b[2]) {
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/* Drop what lies inside the octagon of the points that are farthest in eight directions
 * (AT78): the rest, few, keep their order. Returns how many. */
static size_t sieve(size_t n, double (*point)[2]) {
    static const double way[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                     {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    double far[8][2];
    for (int k = 0; k < 8; k++) {
        size_t best = 0;
        for (size_t i = 1; i < n; i++) {
            double there = way[k][0] * point[i][0] + way[k][1] * point[i][1];
            double most = way[k][0] * point[best][0] + way[k][1] * point[best][1];
            best = there > most ? i : best;
        }
        memcpy(far[k], point[best], sizeof far[k]);
    }
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        int inside = 1;
        for (int k = 0; k < 8 && inside; k++) {
            const double *a = far[k], *b = far[(k + 1) % 8];
            inside = (a[0] == b[0] && a[1] == b[1]) || turn(a, b, point[i]) > 0;
        }
        if (!inside) {
            memmove(point[kept++], point[i], sizeof *point);
        }
    }
    return kept;
}

double pps_hull_area(size_t n, double (*point)[2]) {
    n = n >= 3 ? sieve(n, point) : 0;
    double(*hull)[2] = malloc((2 * n + 1) * sizeof *hull), area = 0;
    size_t m = 0;
    if (!hull || n < 3) {
        free(hull);
        return 0;
    }
    qsort(point, n, sizeof *point, by_xy);
    for (size_t i = 0; i < n; i++) { /* lower side */
        for (; m >= 2 && turn(hull[m - 2], hull[m - 1], point[i]) <= 0; m--) {
        }
        memcpy(hull[m++], point[i], sizeof *hull);
    }
    for (size_t i = n - 1, lower = m + 1; i-- > 0;) { /* and back along the upper */
        for (; m >= lower && turn(hull[m - 2], hull[m - 1], point[i]) <= 0; m--) {
        }
        memcpy(hull[m++], point[i], sizeof *hull);
    }
    for (size_t i = 1; i + 1 < m; i++) {
        area += turn(hull[0], hull[i], hull[i + 1]) / 2;
    }
    free(hull);
    return area;
}
