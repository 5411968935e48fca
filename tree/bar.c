/* False colours: the map "viridis" (Smith and van der Walt 2015, CC0) by nine of its
 * colours, even to the eye and for the colour-blind.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/bar.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tree/font.h"
#include "tree/srgb.h"

static const double MAP[][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
enum { MAP_STEPS = sizeof MAP / sizeof *MAP - 1 };

void pps_bar_color(const pps_false_color *color, double value, double rgb[3]) {
    if (isnan(value)) {
        rgb[0] = rgb[1] = rgb[2] = 0.35;
        return;
    }
    double share = (value - color->low) / (color->high - color->low);
    double at = MAP_STEPS * fmin(1, fmax(0, share));
    int i = (int)fmin(MAP_STEPS - 1, floor(at));
    for (int c = 0; c < 3; c++) {
        rgb[c] =
            srgb_decode((MAP[i][c] + (at - i) * (MAP[i + 1][c] - MAP[i][c])) / 255);
    }
}

/* ---- the key ---- */

/* Pixels a dot: letters are legible in a small picture and not tiny in a large one. */
static int scale_of(const pps_picture *picture) {
    int scale = picture->height / 300;
    return scale > 1 ? scale : 1;
}

int pps_bar_width(const pps_picture *picture) {
    int wanted = 12 * PPS_FONT_WIDTH * scale_of(picture);
    return wanted < picture->width / 2 ? wanted : 0; /* too narrow: no key */
}

/* The tick distance out of 1, 2, 5 x 10^k that gives at most eight of them. */
static double tick_step(double range) {
    double power = pow(10, floor(log10(range / 8)));
    for (int i = 0;; i++) {
        double step = power * (i % 3 == 0 ? 1 : i % 3 == 1 ? 2 : 5);
        if (range / step <= 8) {
            return step;
        }
        power *= i % 3 == 2 ? 10 : 1;
    }
}

static void fill(pps_picture *picture, int x0, int x1, int y, const double rgb[3]) {
    for (int x = x0 > 0 ? x0 : 0; x < x1 && x < picture->width; x++) {
        for (int c = 0; c < 3 && y >= 0 && y < picture->height; c++) {
            picture->rgb[3 * (y * picture->width + x) + c] = (float)rgb[c];
        }
    }
}

static void draw_ticks(const pps_false_color *color, int x, int top, int bottom,
                       int scale, pps_picture *picture) {
    static const double black[3] = {0, 0, 0};
    double range = color->high - color->low, step = tick_step(range);
    double first = ceil(color->low / step - 1e-9);
    for (double k = first; k * step <= color->high + 1e-9 * range; k++) {
        double share = (k * step - color->low) / range;
        int y = (int)lround(bottom - 1 - share * (bottom - 1 - top));
        char label[32];
        for (int i = 0; i < scale; i++) {
            fill(picture, x, x + 3 * scale, y + i - scale / 2, black);
        }
        snprintf(label, sizeof label, "%.4g", fabs(k) < 0.5 ? 0 : k * step);
        pps_font_write(picture, x + 5 * scale, y - 4 * scale, scale, label);
    }
}

void pps_bar_draw(const pps_false_color *color, pps_picture *picture) {
    static const double white[3] = {1, 1, 1}, black[3] = {0, 0, 0};
    int scale = scale_of(picture), width = pps_bar_width(picture);
    int left = picture->width - width, right = left + 3 * PPS_FONT_WIDTH * scale;
    int top = 3 * PPS_FONT_HEIGHT * scale,
        bottom = picture->height - 2 * PPS_FONT_HEIGHT * scale;
    for (int y = 0; y < picture->height && width > 0; y++) {
        fill(picture, left, picture->width, y, white);
    }
    for (int y = top - scale; y < bottom + scale && width > 0; y++) {
        double share = (double)(bottom - 1 - y) / (bottom - 1 - top), rgb[3];
        bool frame = y < top || y >= bottom;
        pps_bar_color(color, color->low + share * (color->high - color->low), rgb);
        fill(picture, left - scale, right + scale, y, black);
        fill(picture, left, right, y, frame ? black : rgb);
    }
    if (width > 0) {
        draw_ticks(color, right + scale, top, bottom, scale, picture);
    }
    if (color->title) {
        while (scale > 1 && pps_font_width(color->title, scale) > picture->width) {
            scale--;
        }
        int wide = pps_font_width(color->title, scale);
        int x = (picture->width - wide) / 2;
        for (int y = 0; y < (PPS_FONT_HEIGHT + 5) * scale; y++) {
            fill(picture, x - 4 * scale, x + wide + 4 * scale, y, white);
        }
        pps_font_write(picture, x > 0 ? x : 0, 4 * scale, scale, color->title);
    }
}
