/* Textures: decoded once, then bilinear in linear light.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/texture.h"

#include <math.h>
#include <stdlib.h>

#include "tree/srgb.h"

float *pps_texture_linear(const pps_texture *texture) {
    size_t n = (size_t)texture->width * (size_t)texture->height;
    float *rgb = malloc((3 * n + 1) * sizeof *rgb), light[256];
    for (int i = 0; i < 256; i++) {
        light[i] = (float)srgb_decode(i / 255.0);
    }
    for (size_t i = 0; rgb && i < n; i++) {
        for (size_t c = 0; c < 3; c++) {
            rgb[3 * i + c] = light[texture->rgba[4 * i + c]];
        }
    }
    return rgb;
}

void pps_texture_mean(const pps_texture *texture, const float *linear, double alpha_min,
                      double rgb[3]) {
    double n = 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (size_t i = 0; i < (size_t)texture->width * (size_t)texture->height; i++) {
        if (texture->rgba[4 * i + 3] / 255.0 >= alpha_min) {
            for (size_t c = 0; c < 3; c++) {
                rgb[c] += (double)linear[3 * i + c];
            }
            n++;
        }
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] = n > 0 ? rgb[c] / n : 0;
    }
}

static long wrap(long i, long n) { return (i % n + n) % n; }

void pps_texture_at(const pps_texture *texture, const float *linear, double u, double v,
                    double rgb[3]) {
    long width = texture->width, height = texture->height;
    double x = (u - floor(u)) * (double)width - 0.5;
    double y = (1 - (v - floor(v))) * (double)height - 0.5;
    long left = (long)floor(x), up = (long)floor(y);
    double right = x - (double)left, down = y - (double)up;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < 4; k++) {
        double share = (k & 1 ? right : 1 - right) * (k & 2 ? down : 1 - down);
        long at = wrap(up + (k >> 1), height) * width + wrap(left + (k & 1), width);
        for (int c = 0; c < 3; c++) {
            rgb[c] += share * (double)linear[3 * at + c];
        }
    }
}
