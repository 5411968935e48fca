/* What the vector loops do to one block of PPS_LANES numbers: plain C that the compiler
 * turns into vector instructions inside functions marked PPS_CLONES.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_LANES_H
#define PPS_CORE_LANES_H

#include <stdint.h>
#include <string.h>

#include "core/vector.h"

/* e^x = 2^n e^r, n the integer nearest x / ln 2: |r| <= ln 2 / 2, and Taylor's series to
 * r^13 is good to 4e-18. ln 2 comes in two parts, the first with 21 bits to spare, so
 * that n times it is exact. Not libmvec, whose results differ between CPU levels. */
static inline double lane_exp(double x) {
    const double SHIFT = 0x1.8p52; /* adding it rounds to an integer in the low bits */
    const double INVERSE_LN2 = 0x1.71547652b82fep0;
    const double LN2_HIGH = 0x1.62e42feep-1, LN2_LOW = 0x1.a39ef35793c76p-33;
    double shifted = x * INVERSE_LN2 + SHIFT, n = shifted - SHIFT;
    double r = (x - n * LN2_HIGH) - n * LN2_LOW;
    double p = 1.0 / 6227020800;
    p = p * r + 1.0 / 479001600;
    p = p * r + 1.0 / 39916800;
    p = p * r + 1.0 / 3628800;
    p = p * r + 1.0 / 362880;
    p = p * r + 1.0 / 40320;
    p = p * r + 1.0 / 5040;
    p = p * r + 1.0 / 720;
    p = p * r + 1.0 / 120;
    p = p * r + 1.0 / 24;
    p = p * r + 1.0 / 6;
    p = p * r + 0.5;
    p = 1 + (r + r * r * p);
    uint64_t bits, power;
    memcpy(&bits, &p, sizeof bits);
    memcpy(&power, &shifted, sizeof power);
    bits += power << 52; /* times 2^n */
    memcpy(&p, &bits, sizeof p);
    return x < -708 ? 0 : p;
}

/* y may be x. */
static inline void lanes_exp(const double *x, double *y) {
    double in[PPS_LANES], out[PPS_LANES];
    for (int l = 0; l < PPS_LANES; l++) {
        in[l] = x[l];
    }
    for (int l = 0; l < PPS_LANES; l++) {
        out[l] = lane_exp(in[l]);
    }
    for (int l = 0; l < PPS_LANES; l++) {
        y[l] = out[l];
    }
}

/* sinh(y)/y for 0 <= y <= 1/2, from y^2. */
static inline double lane_sinh_over(double y2) {
    double p = 1.0 / 1307674368000;
    p = p * y2 + 1.0 / 6227020800;
    p = p * y2 + 1.0 / 39916800;
    p = p * y2 + 1.0 / 362880;
    p = p * y2 + 1.0 / 5040;
    p = p * y2 + 1.0 / 120;
    p = p * y2 + 1.0 / 6;
    return 1 + y2 * p;
}

/* E1(t; a, b) of expdiff.h from e^(-a t), e^(-b t) and their square roots. Rates close
 * together: t e^(-(a+b)t/2) sinh(y)/y, y = (b - a)t/2; rates apart: the quotient. */
static inline double lane_exp1(double t, double a, double b, double ea, double eb,
                               double root_a, double root_b) {
    double z = (b - a) * t, y2 = z * z / 4;
    double near = t * (root_a * root_b) * lane_sinh_over(y2);
    double apart = (ea - eb) / (b - a);
    return z < 1 && z > -1 ? near : apart;
}

/* (1 - e^(-z))/z for z >= 0 from e^(-z/2). */
static inline double lane_decay_mean(double z, double root) {
    return z < 1 ? root * lane_sinh_over(z * z / 4) : (1 - root * root) / z;
}

/* E2(t; a, b, c) of expdiff.h, rates in any order, none negative, t finite. */
static inline double lane_exp2(double t, double a, double b, double c) {
    double low = a < b ? a : b, high = a < b ? b : a;
    double middle = c < low ? low : (c > high ? high : c);
    low = c < low ? c : low;
    high = c > high ? c : high;
    double x = (middle - low) * t, y = (high - low) * t;
    double scale = t * t * lane_exp(-low * t);
    /* sum over i of (-1)^i h_i / (i + 2)!, h_i = x^i + y h_(i-1) */
    static const double over[19] = {0x1p-1,
                                    1.0 / 6,
                                    1.0 / 24,
                                    1.0 / 120,
                                    1.0 / 720,
                                    1.0 / 5040,
                                    1.0 / 40320,
                                    1.0 / 362880,
                                    1.0 / 3628800,
                                    1.0 / 39916800,
                                    1.0 / 479001600,
                                    1.0 / 6227020800,
                                    1.0 / 87178291200,
                                    1.0 / 1307674368000,
                                    1.0 / 20922789888000,
                                    1.0 / 355687428096000,
                                    1.0 / 6402373705728000,
                                    1.0 / 121645100408832000,
                                    1.0 / 2432902008176640000};
    double power = 1, h = 1, series = over[0];
    for (int i = 1; i < 19; i++) {
        power *= -x;
        h = power - y * h;
        series += h * over[i];
    }
    double root_x = lane_exp(-x / 2), root_rest = lane_exp((x - y) / 2);
    double apart = (lane_decay_mean(x, root_x) -
                    root_x * root_x * lane_decay_mean(y - x, root_rest)) /
                   y;
    return scale * (y < 1 ? series : apart);
}

#endif
