/* Image files to and from 8-bit RGBA: libpng and libjpeg-turbo do the work.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/image.h"

#include <stdlib.h>
#include <string.h>

#include <png.h>
#include <turbojpeg.h>

/* Larger images are refused: a few bytes can promise gigabytes. */
enum { LARGEST_SIDE = 16384 };

static pps_status fail(char reason[64], const char *why) {
    snprintf(reason, 64, "%s", why);
    return PPS_ERR_FORMAT;
}

/* Memory for the texels of an image of that size. */
static pps_status make_room(pps_texture *out, long width, long height,
                            char reason[64]) {
    if (width < 1 || height < 1 || width > LARGEST_SIDE || height > LARGEST_SIDE) {
        return fail(reason, "its sides must be 1 to 16384 pixels");
    }
    out->width = (int)width;
    out->height = (int)height;
    out->rgba = malloc(4 * (size_t)width * (size_t)height);
    return out->rgba ? PPS_OK : PPS_ERR_MEMORY;
}

static pps_status decode_png(const unsigned char *bytes, size_t n, pps_texture *out,
                             bool *alpha, char reason[64]) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_memory(&image, bytes, n)) {
        return fail(reason, image.message);
    }
    *alpha = (image.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    image.format = PNG_FORMAT_RGBA;
    pps_status status = make_room(out, image.width, image.height, reason);
    if (!status && !png_image_finish_read(&image, NULL, out->rgba, 0, NULL)) {
        status = fail(reason, image.message);
    }
    png_image_free(&image);
    return status;
}

static pps_status decode_jpeg(const unsigned char *bytes, size_t n, pps_texture *out,
                              bool *alpha, char reason[64]) {
    tjhandle jpeg = tjInitDecompress();
    int width, height, sampling, space;
    if (!jpeg) {
        return PPS_ERR_MEMORY;
    }
    *alpha = false;
    pps_status status = PPS_OK;
    if (tjDecompressHeader3(jpeg, bytes, n, &width, &height, &sampling, &space)) {
        status = fail(reason, tjGetErrorStr2(jpeg));
    }
    if (!status) {
        status = make_room(out, width, height, reason);
    }
    if (!status &&
        tjDecompress2(jpeg, bytes, n, out->rgba, width, 0, height, TJPF_RGBA, 0)) {
        status = fail(reason, tjGetErrorStr2(jpeg));
    }
    tjDestroy(jpeg);
    return status;
}

pps_status pps_image_decode(const unsigned char *bytes, size_t n, pps_texture *out,
                            bool *alpha, char reason[64]) {
    static const unsigned char PNG[] = {0x89, 'P', 'N', 'G'}, JPEG[] = {0xff, 0xd8};
    pps_status status;
    *out = (pps_texture){0, 0, NULL};
    if (n >= sizeof PNG && memcmp(bytes, PNG, sizeof PNG) == 0) {
        status = decode_png(bytes, n, out, alpha, reason);
    } else if (n >= sizeof JPEG && memcmp(bytes, JPEG, sizeof JPEG) == 0) {
        status = decode_jpeg(bytes, n, out, alpha, reason);
    } else {
        status = fail(reason, "it is neither PNG nor JPEG");
    }
    if (status) {
        free(out->rgba);
        out->rgba = NULL;
    }
    return status;
}

pps_status pps_image_write(pps_texture *image, bool alpha, FILE *file) {
    size_t n = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; !alpha && i < n; i++) {
        memmove(image->rgba + 3 * i, image->rgba + 4 * i, 3);
    }
    png_image png = {.version = PNG_IMAGE_VERSION,
                     .width = (png_uint_32)image->width,
                     .height = (png_uint_32)image->height,
                     .format = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB};
    return png_image_write_to_stdio(&png, file, 0, image->rgba, 0, NULL) ? PPS_OK
                                                                         : PPS_ERR_FILE;
}
