/* Shortest decimal text by Schubfach (Giulietti 2020, "The Schubfach way to render
 * doubles"; docs/references.bib).
 *
 * x = c 2^q. Every decimal between the middles to the neighbours of x reads back as x;
 * the interval holds a multiple of 10^k, but at most one of 10^(k+1), where k is
 * floor(log10 of its width). So four candidates decide: the multiples of 10^(k+1) below
 * and above x, then those of 10^k. The products with 10^-k keep two bits below the unit
 * and a sticky one, with which every comparison is exact (section 9 there).
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "number.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

__extension__ typedef unsigned __int128 uint128;

enum {
    FRACTION_BITS = 52,
    BIAS = 1023 + FRACTION_BITS,
    LEAST_POWER = -292,
    FIRST_FIXED = -4, /* exponents that are not written out */
    LAST_FIXED = 15
};

static const struct {
    uint64_t high, low;
} power_of_ten[] = {
#include "powers_of_ten.inc"
};

/* digits * 10^exponent */
typedef struct {
    uint64_t digits;
    int exponent;
} decimal;

/* floor(e log10 2), less log10(4/3) where the lower neighbour is nearer. */
static int floor_log10_pow2(int e, bool nearer) {
    return (e * 1262611 - (nearer ? 524031 : 0)) >> 22;
}

static int floor_log2_pow10(int e) { return (e * 1741647) >> 19; }

/* g c / 2^128, rounded down but for the last bit, which is set when a bit is lost. */
static uint64_t product_to_odd(int power, uint64_t c) {
    uint64_t high = power_of_ten[power - LEAST_POWER].high;
    uint64_t low = power_of_ten[power - LEAST_POWER].low;
    uint128 product = (uint128)high * c + ((uint128)low * c >> 64);

    return (uint64_t)(product >> 64) | ((uint64_t)product > 1);
}

/* x = c 2^q > 0; nearer: the neighbour below is half as far as the one above. */
static decimal shortest(uint64_t c, int q, bool nearer) {
    int k = floor_log10_pow2(q, nearer);
    int h = q + floor_log2_pow10(-k) + 1;
    uint64_t odd = c & 1; /* reading rounds ties to even: then the ends belong to x */
    uint64_t lower = product_to_odd(-k, (4 * c - 2 + nearer) << h) + odd;
    uint64_t upper = product_to_odd(-k, (4 * c + 2) << h) - odd;
    uint64_t x = product_to_odd(-k, (4 * c) << h); /* in units of 10^k / 4 */
    uint64_t s = x / 4, tens = s / 10;
    bool below, above;

    if (s >= 10) {
        below = lower <= 40 * tens;
        above = 40 * tens + 40 <= upper;
        if (below != above)
            return (decimal){tens + above, k + 1};
    }
    below = lower <= 4 * s;
    above = 4 * s + 4 <= upper;
    if (below == above) /* the nearer one, of two as near the even */
        above = x > 4 * s + 2 || (x == 4 * s + 2 && (s & 1));
    return (decimal){s + above, k};
}

static decimal decimal_of(double x) {
    uint64_t bits, fraction, c;
    int exponent, q;

    memcpy(&bits, &x, sizeof bits);
    fraction = bits & ((UINT64_C(1) << FRACTION_BITS) - 1);
    exponent = (int)(bits >> FRACTION_BITS & 0x7ff);
    c = exponent ? fraction | UINT64_C(1) << FRACTION_BITS : fraction;
    q = (exponent ? exponent : 1) - BIAS;
    if (q <= 0 && -q <= FRACTION_BITS && (c & ((UINT64_C(1) << -q) - 1)) == 0)
        return (decimal){c >> -q, 0}; /* a whole number below 2^53 */
    return shortest(c, q, fraction == 0 && exponent > 1);
}

static void drop_trailing_zeros(decimal *d) {
    while (d->digits % 10000 == 0) {
        d->digits /= 10000;
        d->exponent += 4;
    }
    while (d->digits % 10 == 0) {
        d->digits /= 10;
        d->exponent++;
    }
}

static void two_digits(unsigned n, char *text) {
    static const char all[] = "00010203040506070809101112131415161718192021222324"
                              "25262728293031323334353637383940414243444546474849"
                              "50515253545556575859606162636465666768697071727374"
                              "75767778798081828384858687888990919293949596979899";

    memcpy(text, all + 2 * (size_t)n, 2);
}

/* The digits of n > 0, in the end of a field of 20; returns how many. Eight at a time:
 * divisions of 32 bits are quicker. */
static size_t digits_of(uint64_t n, char field[20]) {
    size_t at = 20;

    while (n >= 100000000) {
        uint32_t low = (uint32_t)(n % 100000000);
        n /= 100000000;
        for (int i = 0; i < 4; i++, low /= 100)
            two_digits(low % 100, field + (at -= 2));
    }
    for (uint32_t rest = (uint32_t)n; rest; rest /= 100) {
        if (rest < 10)
            field[--at] = (char)('0' + rest);
        else
            two_digits(rest % 100, field + (at -= 2));
    }
    return 20 - at;
}

/* d.ddde-05: at least two digits of exponent, as printf has them. */
static char *with_exponent(char *text, const char *digits, size_t n, int exponent) {
    unsigned size = (unsigned)(exponent < 0 ? -exponent : exponent);

    *text++ = digits[0];
    if (n > 1) {
        *text++ = '.';
        memcpy(text, digits + 1, n - 1);
        text += n - 1;
    }
    *text++ = 'e';
    *text++ = exponent < 0 ? '-' : '+';
    if (size >= 100)
        *text++ = (char)('0' + size / 100);
    two_digits(size % 100, text);
    return text + 2;
}

/* The digits with a point before or among them, or zeros behind. */
static char *without_exponent(char *text, const char *digits, size_t n, int exponent) {
    size_t whole = exponent < 0 ? 0 : (size_t)exponent + 1;

    if (exponent < 0) {
        memcpy(text, "0.0000", 6);
        text += 1 - exponent;
    } else if (n <= whole) {
        memcpy(text, digits, n);
        memset(text + n, '0', whole - n);
        return text + whole;
    } else {
        memcpy(text, digits, whole);
        text += whole;
        *text++ = '.';
    }
    memcpy(text, digits + whole, n - whole);
    return text + n - whole;
}

size_t number_format(double x, char text[NUMBER_SIZE]) {
    char field[20], *end = text;
    decimal d;
    size_t n;
    int exponent;

    if (isnan(x))
        return 0;
    if (signbit(x))
        *end++ = '-';
    if (isinf(x) || x == 0) {
        size_t length = x == 0 ? 1 : 3;
        memcpy(end, x == 0 ? "0" : "inf", length);
        return (size_t)(end - text) + length;
    }
    d = decimal_of(fabs(x));
    drop_trailing_zeros(&d);
    n = digits_of(d.digits, field);
    exponent = d.exponent + (int)n - 1; /* of the first digit */
    end = exponent < FIRST_FIXED || exponent > LAST_FIXED
              ? with_exponent(end, field + 20 - n, n, exponent)
              : without_exponent(end, field + 20 - n, n, exponent);
    return (size_t)(end - text);
}
