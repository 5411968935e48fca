/* One scattering of a path that carries all bands.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/bounce.h"

#include <math.h>

#include "tree/vec.h"

static const double PI = 3.14159265358979323846;

/* Roulette: paths that are down to this share survive to carry SURVIVOR on. */
static const double FAINT = 0.05, SURVIVOR = 0.1;

/* Paths that live on between leaves and ground that hardly absorb are thinned whenever
 * their bounces double, so that none goes on for ever. */
enum { LONG = 1024 };
static const double LONG_SURVIVAL = 0.5;

static double sum(int n, const double *q) {
    double s = 0;
    for (int b = 0; b < n; b++) {
        s += q[b];
    }
    return s;
}

bool pps_bounce_choose(int n, double *q, const double *reflectance,
                       const double *transmittance, double u) {
    double r[PPS_BANDS_MAX], t[PPS_BANDS_MAX];
    for (int b = 0; b < n; b++) {
        r[b] = q[b] * reflectance[b];
        t[b] = q[b] * transmittance[b];
    }
    double way_r = sum(n, r), way_t = sum(n, t), both = way_r + way_t;
    bool reflected = u * both < way_r;
    double pay = both > 0 ? both / (reflected ? way_r : way_t) : 0;
    for (int b = 0; b < n; b++) {
        q[b] = pay * (reflected ? r : t)[b];
    }
    return reflected;
}

bool pps_bounce_lives(int n, double *q, uint64_t bounces, double u) {
    double mean = sum(n, q) / n, survival = 1;
    if (mean <= 0) {
        return false;
    }
    if (mean < FAINT) {
        survival = mean / SURVIVOR;
    } else if (bounces >= LONG && (bounces & (bounces - 1)) == 0) {
        survival = LONG_SURVIVAL;
    }
    for (int b = 0; b < n; b++) {
        q[b] /= survival;
    }
    return u < survival;
}

void pps_bounce_lambert(const double normal[3], double side, double u, double v,
                        double out[3]) {
    double x[3], y[3], mu = sqrt(u), sine = sqrt(1 - u), c = cos(2 * PI * v),
                       s = sin(2 * PI * v);
    vec_frame(normal, x, y);
    for (int i = 0; i < 3; i++) {
        out[i] = side * mu * normal[i] + sine * (c * x[i] + s * y[i]);
    }
}

bool pps_bounce_ground(const pps_scene *scene, pps_line *line) {
    double height = line->origin[2] - scene->ground.height;
    if (!scene->ground.present || line->direction[2] >= 0 || height < 0) {
        return false;
    }
    line->far = -height / line->direction[2];
    return true;
}

uint64_t pps_bounce_most(const pps_trace_options *o) {
    const unsigned indirect = PPS_SUN_INDIRECT | PPS_SKY_INDIRECT;
    if (o->sources && !(o->sources & indirect)) {
        return 0;
    }
    return o->bounces ? (uint64_t)o->bounces : UINT64_MAX;
}
