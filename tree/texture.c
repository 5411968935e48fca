/* Textures: bilinear, in linear light, repeated with period 1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/texture.h"

#include <math.h>

#include "tree/srgb.h"

static const uint8_t *texel(const pps_texture *t, long x, long y) {
    long w = t->width, h = t->height;
    x = (x % w + w) % w;
    y = (y % h + h) % h;
    return &t->rgba[4 * (y * w + x)];
}

static void look_up(const pps_texture *t, double u, double v, double rgb[3]) {
    double x = (u - floor(u)) * t->width - 0.5;
    double y = (1 - (v - floor(v))) * t->height - 0.5;
    long left = (long)floor(x), up = (long)floor(y);
    double right = x - (double)left, down = y - (double)up;
    for (int c = 0; c < 3; c++) {
        rgb[c] = 0;
        for (int k = 0; k < 4; k++) {
            double share = (k & 1 ? right : 1 - right) * (k & 2 ? down : 1 - down);
            rgb[c] +=
                share * srgb_decode(texel(t, left + (k & 1), up + (k >> 1))[c] / 255.0);
        }
    }
}

void pps_texture_at(const pps_mesh *mesh, size_t triangle, double u, double v,
                    double rgb[3]) {
    const pps_material *m = &mesh->material[mesh->material_of[triangle]];
    if (!mesh->uv || m->texture < 0) {
        rgb[0] = rgb[1] = rgb[2] = 1;
        return;
    }
    const uint32_t *corner = mesh->triangle[triangle];
    double at[2];
    for (int i = 0; i < 2; i++) {
        double a = (double)mesh->uv[corner[0]][i], b = (double)mesh->uv[corner[1]][i],
               c = (double)mesh->uv[corner[2]][i];
        at[i] = a + u * (b - a) + v * (c - a);
    }
    look_up(&mesh->texture[m->texture], at[0], at[1], rgb);
}

void pps_texture_mean(const pps_mesh *mesh, const pps_material *material,
                      double rgb[3]) {
    rgb[0] = rgb[1] = rgb[2] = 1;
    if (!mesh->uv || material->texture < 0) {
        return;
    }
    const pps_texture *t = &mesh->texture[material->texture];
    double sum[3] = {0, 0, 0}, n = 0;
    for (size_t i = 0; i < (size_t)t->width * (size_t)t->height; i++) {
        if (t->rgba[4 * i + 3] / 255.0 >= material->alpha_min) {
            for (int c = 0; c < 3; c++) {
                sum[c] += srgb_decode(t->rgba[4 * i + (size_t)c] / 255.0);
            }
            n++;
        }
    }
    for (int c = 0; c < 3 && n > 0; c++) {
        rgb[c] = sum[c] / n;
    }
}
