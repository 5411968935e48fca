/* The sRGB curve (IEC 61966-2-1) between linear light and what a screen is sent.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SRGB_H
#define PPS_TREE_SRGB_H

#include <math.h>
#include <stdint.h>

static inline double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static inline double srgb_decode(double shown) {
    return shown <= 0.04045 ? shown / 12.92 : pow((shown + 0.055) / 1.055, 2.4);
}

/* 0..255, clipped; what is no number is black. */
static inline uint8_t srgb_byte(double linear) {
    return linear > 0 ? (uint8_t)(255 * srgb_encode(fmin(1, linear)) + 0.5) : 0;
}

#endif
