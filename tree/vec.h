/* Three numbers: the few operations the tree library needs on them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_VEC_H
#define PPS_TREE_VEC_H

#include <math.h>

static inline double vec_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vec_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void vec_sub(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] - b[i];
    }
}

/* out = a + s b */
static inline void vec_along(const double a[3], double s, const double b[3],
                             double out[3]) {
    for (int i = 0; i < 3; i++) {
        out[i] = a[i] + s * b[i];
    }
}

static inline double vec_length(const double a[3]) { return sqrt(vec_dot(a, a)); }

/* To length 1; 0 becomes straight up. */
static inline void vec_normalize(double a[3]) {
    double length = vec_length(a);
    for (int i = 0; i < 3; i++) {
        a[i] = length > 0 ? a[i] / length : i == 2;
    }
}

/* Two unit vectors that make a right-handed frame with the unit vector n. */
static inline void vec_frame(const double n[3], double x[3], double y[3]) {
    double sign = copysign(1, n[2]), a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
    x[0] = 1 + sign * n[0] * n[0] * a;
    x[1] = sign * b;
    x[2] = -sign * n[0];
    y[0] = b;
    y[1] = sign + n[1] * n[1] * a;
    y[2] = -n[1];
}

#endif
