/* Four numbers at a time, by the vector types of GCC and Clang. Inside a function marked
 * PPS_CLONES they are registers of AVX2; elsewhere the compiler takes them apart.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_CORE_LANES_H
#define PPS_CORE_LANES_H

#include <stdint.h>

#include "core/vector.h"

/* Functions of such numbers are always inlined: how a vector is passed to a function
 * differs between CPU levels. */
#define PPS_LANE static inline __attribute__((always_inline))

typedef double four __attribute__((vector_size(32)));
typedef int64_t four_int __attribute__((vector_size(32)));
typedef int64_t two_int __attribute__((vector_size(16)));
typedef uint64_t four_bits __attribute__((vector_size(32)));
/* The same in memory, at any address. */
typedef double four_there __attribute__((vector_size(32), aligned(8), may_alias));

enum { FOUR = 4 };

PPS_LANE four four_at(const double *x) { return *(const four_there *)x; }
PPS_LANE void four_to(double *x, four value) { *(four_there *)x = value; }
PPS_LANE four four_of(double x) { return (four){x, x, x, x}; }

/* Lane by lane yes where the mask is -1, no where it is 0. */
PPS_LANE four four_choose(four_int mask, four yes, four no) {
    return (four)((mask & (four_int)yes) | (~mask & (four_int)no));
}
PPS_LANE int four_any(four_int mask) {
    two_int half = __builtin_shufflevector(mask, mask, 0, 1) |
                   __builtin_shufflevector(mask, mask, 2, 3);
    return (half[0] | half[1]) != 0;
}
PPS_LANE four four_abs(four x) {
    return (four)((four_int)x & (four_int){INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX});
}

/* e^x = 2^n e^r, n the integer nearest x / ln 2: |r| <= ln 2 / 2, and Taylor's series to
 * r^13 is good to 4e-18. ln 2 comes in two parts, the first with 21 bits to spare, so
 * that n times it is exact. Not libmvec, whose results differ between CPU levels. */
PPS_LANE four four_exp(four x) {
    const double SHIFT = 0x1.8p52; /* adding it rounds to an integer in the low bits */
    const double INVERSE_LN2 = 0x1.71547652b82fep0;
    const double LN2_HIGH = 0x1.62e42feep-1, LN2_LOW = 0x1.a39ef35793c76p-33;
    four shifted = x * INVERSE_LN2 + SHIFT, n = shifted - SHIFT;
    four r = (x - n * LN2_HIGH) - n * LN2_LOW;
    /* Powers in pairs, pairs in pairs: a third of the wait of one after the other. */
    four r2 = r * r, r4 = r2 * r2, r8 = r4 * r4;
    four low = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
    four middle =
        (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
    four high = (1.0 / 3628800 + r * (1.0 / 39916800)) +
                r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
    four p = 1 + (r + r2 * (low + (r4 * middle + r8 * high)));
    four result = (four)((four_bits)p + ((four_bits)shifted << 52)); /* times 2^n */
    return four_choose(x < -708, four_of(0), result);
}

/* sinh(y)/y for 0 <= y <= 1/2, from y^2. */
PPS_LANE four four_sinh_over(four y2) {
    four p = four_of(1.0 / 1307674368000);
    p = p * y2 + 1.0 / 6227020800;
    p = p * y2 + 1.0 / 39916800;
    p = p * y2 + 1.0 / 362880;
    p = p * y2 + 1.0 / 5040;
    p = p * y2 + 1.0 / 120;
    p = p * y2 + 1.0 / 6;
    return 1 + y2 * p;
}

PPS_LANE four_int four_within_one(four z) { return (z < 1) & (z > -1); }

/* E1(t; a, b) of expdiff.h from e^(-a t), e^(-b t) and their square roots. Rates close
 * together: t e^(-(a+b)t/2) sinh(y)/y, y = (b - a)t/2; rates apart: the quotient. */
PPS_LANE four four_exp1(double t, four a, four b, four ea, four eb, four root_a,
                        four root_b) {
    four z = (b - a) * t, apart = (ea - eb) / (b - a);
    if (!four_any(four_within_one(z))) {
        return apart;
    }
    four near = t * (root_a * root_b) * four_sinh_over(z * z / 4);
    return four_choose(four_within_one(z), near, apart);
}

/* (1 - e^(-z))/z for z >= 0 from e^(-z/2). */
PPS_LANE four four_decay_mean(four z, four root) {
    return four_choose(z < 1, root * four_sinh_over(z * z / 4), (1 - root * root) / z);
}

/* E2 of expdiff.h over t^2 e^(-low t) from the differences x <= y of the other two rates
 * from the lowest, times t; y < 1: the sum over i of (-1)^i h_i / (i + 2)!,
 * h_i = x^i + y h_(i-1). */
PPS_LANE four four_exp2_series(four x, four y) {
    static const double over_factorial[] = {
        1.0 / 2,
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
        1.0 / 2432902008176640000,
    };
    four power = four_of(1), h = power, sum = four_of(over_factorial[0]);
    for (size_t i = 1; i < sizeof over_factorial / sizeof *over_factorial; i++) {
        power = -x * power;
        h = power - y * h;
        sum += h * over_factorial[i];
    }
    return sum;
}

/* The same where y >= 1. */
PPS_LANE four four_exp2_apart(four x, four y) {
    four root_x = four_exp(-x / 2), root_rest = four_exp((x - y) / 2);
    return (four_decay_mean(x, root_x) -
            root_x * root_x * four_decay_mean(y - x, root_rest)) /
           y;
}

/* E2(t; a, b, c) of expdiff.h, rates in any order, none negative, t finite. */
PPS_LANE four four_exp2(double t, four a, four b, four c) {
    four low = four_choose(a < b, a, b), high = four_choose(a < b, b, a);
    four middle = four_choose(c < low, low, four_choose(c > high, high, c));
    low = four_choose(c < low, c, low);
    high = four_choose(c > high, c, high);
    four x = (middle - low) * t, y = (high - low) * t, part = {0};
    four_int close = y < 1;
    if (four_any(close)) {
        part = four_exp2_series(x, y);
    }
    if (four_any(~close)) {
        part = four_choose(close, part, four_exp2_apart(x, y));
    }
    return t * t * four_exp(-low * t) * part;
}

#endif
