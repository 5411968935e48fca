/* Bark and petals, drawn by numbers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/grow_textures.h"

#include <math.h>
#include <stdlib.h>

#include "tree/random.h"

enum { BARK = 20 << 8 }; /* event of the random numbers */

static pps_texture blank(int width, int height) {
    uint8_t *rgba = malloc((size_t)4 * (size_t)width * (size_t)height);
    return rgba ? (pps_texture){width, height, rgba} : (pps_texture){0, 0, NULL};
}

static void set_texel(pps_texture *t, size_t i, double red, double green, double blue) {
    const double rgb[3] = {red, green, blue};
    for (size_t c = 0; c < 3; c++) {
        t->rgba[4 * i + c] = (uint8_t)(255 * fmin(1, fmax(0, rgb[c])) + 0.5);
    }
    t->rgba[4 * i + 3] = 255;
}

pps_texture pps_grow_bark(const pps_species *species, uint64_t seed) {
    enum { WIDTH = 256, HEIGHT = 128, DASHES = 260 };
    double *light = malloc((size_t)WIDTH * HEIGHT * sizeof *light);
    pps_texture texture = blank(WIDTH, HEIGHT);
    if (!light || !texture.rgba) {
        free(light);
        free(texture.rgba);
        return (pps_texture){0, 0, NULL};
    }
    for (uint64_t i = 0; i < (uint64_t)WIDTH * HEIGHT; i++) {
        light[i] = 0.7 + 0.1 * pps_random(seed, PPS_RANDOM_SPECIES, i, BARK).u[0];
    }
    for (uint64_t i = 0; i < DASHES; i++) {
        pps_uniforms r = pps_random(seed, PPS_RANDOM_SPECIES, i, BARK + 1);
        int x = (int)(r.u[0] * WIDTH), y = (int)(r.u[1] * HEIGHT);
        int length = 4 + (int)(r.u[2] * r.u[2] * 44), thick = r.u[3] > 0.7 ? 2 : 1;
        for (int p = 0; p < length * thick; p++) {
            int row = (y + p / length) % HEIGHT, column = (x + p % length) % WIDTH;
            light[row * WIDTH + column] +=
                species->wood.lenticels * (0.15 + 0.25 * r.u[3]);
        }
    }
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        set_texel(&texture, i, 1.02 * light[i], light[i], 0.98 * light[i]);
    }
    free(light);
    return texture;
}

pps_texture pps_grow_petal(const pps_species *species) {
    enum { SIDE = 32 };
    pps_texture texture = blank(SIDE, SIDE);
    for (size_t i = 0; texture.rgba && i < (size_t)SIDE * SIDE; i++) {
        size_t row = i / SIDE;
        double down = ((double)row + 0.5) / SIDE; /* 0 at the petal's end */
        double dark = species->leaves.heart * down * down;
        set_texel(&texture, i, 1 - 0.15 * dark, 1 - 0.7 * dark, 1 - 0.45 * dark);
    }
    return texture;
}
