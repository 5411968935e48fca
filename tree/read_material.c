/* Materials of a mesh file: names, colours, and the images that cut leaves out.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include "tree/image.h"
#include "tree/path.h"
#include "tree/problem.h"
#include "tree/read.h"
#include "tree/text.h"

static const double CUT = 0.5; /* where formats do not say */

struct aiString pps_read_material_name(const struct aiMaterial *material) {
    struct aiString name = {0, ""};
    aiGetMaterialString(material, AI_MATKEY_NAME, &name);
    return name;
}

/* ---- images ---- */

/* The path of the material's image of a kind, as its file has it; false: none. */
static bool image_name(const struct aiMaterial *material, enum aiTextureType kind,
                       struct aiString *name) {
    return aiGetMaterialTexture(material, kind, 0, name, NULL, NULL, NULL, NULL, NULL,
                                NULL) == aiReturn_SUCCESS &&
           name->length > 0;
}

static bool color_image(const struct aiMaterial *material, struct aiString *name) {
    return image_name(material, aiTextureType_BASE_COLOR, name) ||
           image_name(material, aiTextureType_DIFFUSE, name);
}

unsigned pps_read_uv_channel(const struct aiMaterial *material) {
    int channel = 0;
    aiGetMaterialIntegerArray(material, AI_MATKEY_UVWSRC(aiTextureType_DIFFUSE, 0),
                              &channel, NULL);
    return channel >= 0 && channel < AI_MAX_NUMBER_OF_TEXTURECOORDS ? (unsigned)channel
                                                                    : 0;
}

/* An image inside the file: by number ("*3"), or by its name. */
static const struct aiTexture *embedded(const reader *r, const char *name) {
    for (unsigned i = 0; i < r->scene->mNumTextures; i++) {
        const struct aiTexture *t = r->scene->mTextures[i];
        if (name[0] == '*' ? strtoul(name + 1, NULL, 10) == i
                           : strcmp(t->mFilename.data, name) == 0) {
            return t;
        }
    }
    return NULL;
}

/* Texels that the file holds bare. */
static pps_status copy_texels(const struct aiTexture *from, pps_texture *out,
                              bool *alpha) {
    size_t n = (size_t)from->mWidth * from->mHeight;
    *out = (pps_texture){(int)from->mWidth, (int)from->mHeight, malloc(4 * n + 1)};
    *alpha = false;
    for (size_t i = 0; out->rgba && i < n; i++) {
        const struct aiTexel *t = &from->pcData[i];
        uint8_t rgba[4] = {t->r, t->g, t->b, t->a};
        memcpy(out->rgba + 4 * i, rgba, sizeof rgba);
        *alpha = *alpha || t->a < 255;
    }
    return out->rgba ? PPS_OK : PPS_ERR_MEMORY;
}

/* "%20" and its like become what they stand for, "\" becomes "/". */
static void plain_name(char *name, bool percent) {
    char *to = name;
    for (const char *c = name; *c; c++) {
        unsigned code;
        int used = 0;
        if (percent && *c == '%' && sscanf(c + 1, "%2x%n", &code, &used) == 1 &&
            used == 2 && code) {
            *to++ = (char)code;
            c += 2;
        } else {
            *to++ = *c == '\\' ? '/' : *c;
        }
    }
    *to = '\0';
}

/* The bytes of an image beside the mesh: under its name, its name with escapes undone, or
 * (the folders of another machine) its last part alone. */
static pps_status load_beside(const reader *r, const char *as_written,
                              unsigned char **bytes, size_t *n) {
    pps_status status = PPS_ERR_FILE;
    int reason = 0;
    for (int attempt = 0; status == PPS_ERR_FILE && attempt < 3; attempt++) {
        char name[MAXLEN];
        snprintf(name, sizeof name, "%s", as_written);
        plain_name(name, attempt > 0);
        char *path = pps_path_beside(r->path, attempt < 2 ? name : pps_path_base(name));
        status = path ? pps_path_load(path, bytes, n) : PPS_ERR_MEMORY;
        reason = attempt ? reason : errno;
        free(path);
    }
    errno = reason;
    return status;
}

/* The image of an option is named as seen from here, the file's own from beside it. */
static pps_status load_bytes(const reader *r, const char *name, unsigned char **bytes,
                             size_t *n) {
    return name == r->leaf_image ? pps_path_load(name, bytes, n)
                                 : load_beside(r, name, bytes, n);
}

static pps_status load_image(const reader *r, const char *name, pps_texture *out,
                             bool *alpha) {
    const struct aiTexture *inside = name == r->leaf_image ? NULL : embedded(r, name);
    char reason[64] = "";
    pps_status status;
    if (inside && inside->mHeight > 0) {
        return copy_texels(inside, out, alpha);
    }
    if (inside) {
        status = pps_image_decode((const unsigned char *)inside->pcData, inside->mWidth,
                                  out, alpha, reason);
    } else {
        unsigned char *bytes = NULL;
        size_t n = 0;
        status = load_bytes(r, name, &bytes, &n);
        if (status == PPS_ERR_FILE) {
            snprintf(reason, sizeof reason, "%.60s", strerror(errno));
        } else if (!status) {
            status = pps_image_decode(bytes, n, out, alpha, reason);
        }
        free(bytes);
    }
    if (status && status != PPS_ERR_MEMORY) {
        pps_complain(r->problem, status, "%s: its image '%.150s': %s", r->path, name,
                     reason);
    }
    return status;
}

/* ---- textures: a colour image, an opacity image, or both in one ---- */

static const uint8_t *texel_of(const pps_texture *t, int x, int y, int width,
                               int height) {
    size_t column = (size_t)x * (size_t)t->width / (size_t)width;
    size_t row = (size_t)y * (size_t)t->height / (size_t)height;
    return t->rgba + 4 * (row * (size_t)t->width + column);
}

/* The opacity image's alpha channel or else its luminance becomes the alpha of `color`,
 * which may be empty (white). The finer of both gives the size. */
static pps_status put_opacity(pps_texture *color, const pps_texture *opacity,
                              bool opacity_alpha) {
    pps_texture out = *opacity;
    if (color->rgba && color->width > out.width) {
        out.width = color->width;
        out.height = color->height;
    }
    out.rgba = malloc(4 * (size_t)out.width * (size_t)out.height);
    if (!out.rgba) {
        return PPS_ERR_MEMORY;
    }
    for (int y = 0; y < out.height; y++) {
        for (int x = 0; x < out.width; x++) {
            static const uint8_t WHITE[3] = {255, 255, 255};
            uint8_t *to = out.rgba + 4 * ((size_t)y * (size_t)out.width + (size_t)x);
            const uint8_t *a = texel_of(opacity, x, y, out.width, out.height);
            memcpy(to,
                   color->rgba ? texel_of(color, x, y, out.width, out.height) : WHITE,
                   3);
            /* Rec. 709 luma of the values as stored. */
            to[3] =
                opacity_alpha
                    ? a[3]
                    : (uint8_t)lround(0.2126 * a[0] + 0.7152 * a[1] + 0.0722 * a[2]);
        }
    }
    free(color->rgba);
    *color = out;
    return PPS_OK;
}

/* `color` and `opacity` are names or "". *cuts: alpha says where the surface is. */
static pps_status make_texture(const reader *r, const char *color, const char *opacity,
                               pps_texture *out, bool *cuts) {
    bool alpha = false;
    pps_texture mask = {0, 0, NULL};
    pps_status status = *color ? load_image(r, color, out, &alpha) : PPS_OK;
    *cuts = alpha;
    if (!status && *opacity && !(alpha && strcmp(color, opacity) == 0)) {
        status = load_image(r, opacity, &mask, &alpha);
        if (!status) {
            status = put_opacity(out, &mask, alpha);
        }
        *cuts = true;
        free(mask.rgba);
    }
    if (status) {
        free(out->rgba);
        *out = (pps_texture){0, 0, NULL};
    }
    return status;
}

/* The number of the texture made of these images; each pair is read once. The source
 * starts with whether its alpha cuts. */
static pps_status find_texture(reader *r, const char *color, const char *opacity,
                               int *number, bool *cuts) {
    pps_mesh *mesh = r->mesh;
    char key[2 * MAXLEN + 8];
    snprintf(key, sizeof key, "%.*s\n%s", MAXLEN, color, opacity);
    for (size_t i = 0; i < mesh->n_textures; i++) {
        if (strcmp(r->source[i] + 1, key) == 0) {
            *number = (int)i;
            *cuts = r->source[i][0] == 'c';
            return PPS_OK;
        }
    }
    pps_status status =
        make_texture(r, color, opacity, &mesh->texture[mesh->n_textures], cuts);
    if (status) {
        return status;
    }
    char *source = text_join(*cuts ? "c" : " ", 1, key);
    r->source[mesh->n_textures] = source;
    *number = (int)mesh->n_textures++;
    return source ? PPS_OK : PPS_ERR_MEMORY;
}

/* ---- the material ---- */

/* glTF says what alpha means: -1 if this is no glTF, 0 opaque, else the value to cut at. */
static double gltf_cut(const struct aiMaterial *material) {
    struct aiString mode = {0, ""};
    ai_real cutoff = 0;
    if (aiGetMaterialString(material, AI_MATKEY_GLTF_ALPHAMODE, &mode)) {
        return -1;
    }
    if (strcmp(mode.data, "MASK") == 0) {
        return aiGetMaterialFloatArray(material, AI_MATKEY_GLTF_ALPHACUTOFF, &cutoff,
                                       NULL)
                   ? CUT
                   : (double)cutoff;
    }
    return strcmp(mode.data, "BLEND") == 0 ? CUT : 0;
}

static void read_color(const struct aiMaterial *material, double rgb[3],
                       double *alpha) {
    struct aiColor4D color = {1, 1, 1, 1};
    if (aiGetMaterialColor(material, AI_MATKEY_BASE_COLOR, &color)) {
        aiGetMaterialColor(material, AI_MATKEY_COLOR_DIFFUSE, &color);
    }
    const double value[3] = {(double)color.r, (double)color.g, (double)color.b};
    for (int i = 0; i < 3; i++) {
        rgb[i] = fmin(fmax(value[i], 0), 1);
    }
    *alpha = (double)color.a;
}

/* Whether any texel's alpha is below the value. */
static bool any_below(const pps_texture *texture, double alpha) {
    size_t n = (size_t)texture->width * (size_t)texture->height;
    for (size_t i = 0; i < n; i++) {
        if (texture->rgba[4 * i + 3] / 255.0 < alpha) {
            return true;
        }
    }
    return false;
}

/* Where alpha times `factor` reaches `cut`. A colour image that lacks matters to pictures
 * alone, unless it may cut leaves. */
static pps_status read_texture(reader *r, const struct aiMaterial *material,
                               double factor, pps_material *out) {
    struct aiString color = {0, ""}, opacity = {0, ""};
    double cut = gltf_cut(material);
    bool cuts = false;
    color_image(material, &color);
    if (cut < 0) {
        image_name(material, aiTextureType_OPACITY, &opacity);
    }
    const char *image = color.data;
    if (!color.length && !opacity.length) {
        if (!out->leaf || !r->leaf_image) {
            return PPS_OK;
        }
        image = r->leaf_image;
        cut = CUT;
    }
    pps_status status = find_texture(r, image, opacity.data, &out->texture, &cuts);
    if (status && status != PPS_ERR_MEMORY && !out->leaf) {
        return PPS_OK;
    }
    if (!status && cuts && cut != 0) {
        double least = cut < 0 ? CUT : factor > 0 ? cut / factor : 2;
        out->alpha_min = any_below(&r->mesh->texture[out->texture], least) ? least : 0;
    }
    return status;
}

pps_status pps_read_material(reader *r, unsigned number, int use) {
    const struct aiMaterial *material = r->scene->mMaterials[number];
    pps_material *out = &r->mesh->material[r->mesh->n_materials];
    struct aiString name = pps_read_material_name(material);
    double factor;
    *out = (pps_material){.leaf = (use & USE_LEAF) != 0, .texture = -1};
    out->name = text_copy(name.data);
    if (!out->name) {
        return PPS_ERR_MEMORY;
    }
    r->mesh->n_materials++;
    read_color(material, out->color, &factor);
    return use & USE_UV ? read_texture(r, material, factor, out) : PPS_OK;
}
