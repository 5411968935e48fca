/* Pictures: linear light in floats, PNG by libpng.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include <ppscat/tree/picture.h>

#include "tree/srgb.h"

enum { MOST_PIXELS = 1 << 16 }; /* along a side */

pps_status pps_picture_create(int width, int height, pps_picture **out) {
    *out = NULL;
    if (width < 1 || height < 1 || width > MOST_PIXELS || height > MOST_PIXELS) {
        return PPS_ERR_ARGUMENT;
    }
    pps_picture *picture = calloc(1, sizeof *picture);
    float *rgb = calloc((size_t)width * (size_t)height, 3 * sizeof *rgb);
    if (!picture || !rgb) {
        free(picture);
        free(rgb);
        return PPS_ERR_MEMORY;
    }
    *picture = (pps_picture){width, height, rgb};
    *out = picture;
    return PPS_OK;
}

void pps_picture_free(pps_picture *picture) {
    if (picture) {
        free(picture->rgb);
        free(picture);
    }
}

static int by_size(const void *a, const void *b) {
    const float *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static size_t pixels(const pps_picture *picture) {
    return picture ? (size_t)picture->width * (size_t)picture->height : 0;
}

/* The largest of red, green and blue of every pixel; returns behind the last. */
static float *largest_parts(const pps_picture *picture, float *out) {
    for (size_t i = 0; i < pixels(picture); i++) {
        const float *p = &picture->rgb[3 * i];
        float most = p[0] > p[1] ? p[0] : p[1];
        most = p[2] > most ? p[2] : most;
        *out++ = isfinite(most) ? most : 0;
    }
    return out;
}

pps_status pps_picture_exposure(size_t n, pps_picture *const *picture,
                                double *exposure) {
    size_t all = 0;
    *exposure = 1;
    for (size_t i = 0; i < n; i++) {
        all += pixels(picture[i]);
    }
    float *largest = malloc((all + 1) * sizeof *largest), *end = largest;
    if (!largest) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        end = largest_parts(picture[i], end);
    }
    qsort(largest, all, sizeof *largest, by_size);
    if (all > 0) {
        double white = (double)largest[all - (all >= 100 ? all / 100 : 1)];
        white = white > 0 ? white : (double)largest[all - 1];
        *exposure = white > 0 ? 1 / white : 1;
    }
    free(largest);
    return PPS_OK;
}

void pps_picture_expose(pps_picture *picture, double exposure) {
    for (size_t i = 0; i < 3 * pixels(picture); i++) {
        picture->rgb[i] = (float)(exposure * (double)picture->rgb[i]);
    }
}

static pps_status fail(pps_problem *problem, const char *path, const char *why) {
    if (problem) {
        snprintf(problem->text, sizeof problem->text, "cannot write %.300s: %.150s",
                 path, why);
    }
    return PPS_ERR_FILE;
}

/* Under another name until it is whole, so no broken picture is left behind. */
static pps_status write_png(const uint8_t *byte, const pps_picture *picture,
                            const char *path, pps_problem *problem) {
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)picture->width,
                       .height = (png_uint_32)picture->height,
                       .format = PNG_FORMAT_RGB};
    size_t room = strlen(path) + sizeof ".part";
    char *part = malloc(room);
    if (!part) {
        return PPS_ERR_MEMORY;
    }
    snprintf(part, room, "%s.part", path);
    pps_status status = PPS_OK;
    if (!png_image_write_to_file(&image, part, 0, byte, 0, NULL)) {
        remove(part);
        status = fail(problem, path, image.message);
    } else if (rename(part, path) != 0) {
        remove(part);
        status = fail(problem, path, "it cannot be renamed to that");
    }
    free(part);
    return status;
}

pps_status pps_picture_write(const pps_picture *picture, double exposure,
                             const char *path, pps_problem *problem) {
    if (!(exposure >= 0) || !isfinite(exposure)) {
        return PPS_ERR_ARGUMENT;
    }
    size_t n = 3 * pixels(picture);
    uint8_t *byte = malloc(n);
    pps_status status = byte ? PPS_OK : PPS_ERR_MEMORY;
    if (!status && exposure == 0) {
        pps_picture copy = *picture, *one = &copy;
        status = pps_picture_exposure(1, &one, &exposure);
    }
    if (!status) {
        for (size_t i = 0; i < n; i++) {
            byte[i] = srgb_byte(exposure * (double)picture->rgb[i]);
        }
        status = write_png(byte, picture, path, problem);
    }
    free(byte);
    return status;
}
