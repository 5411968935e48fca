/* A plant as triangles: leaves, wood, and the materials that tell them apart.
 *
 * Lengths are metres, z points up. A leaf is a connected piece of leaf triangles, the unit
 * that irradiance is given for; its front is the side its normal points to (the triangles
 * run counter-clockwise seen from there). Both faces exist: leaves are thin.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_MESH_H
#define PPSCAT_TREE_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <ppscat/status.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PPS_NO_LEAF UINT32_MAX

/* What went wrong, for a person: the file, the place in it, what was expected. Functions
 * that take one fill it when they fail; NULL is fine. */
typedef struct pps_problem {
    char text[512];
} pps_problem;

/* An image of 8-bit sRGB colour and linear alpha; rgba[4 * (y * width + x)], y down. */
typedef struct pps_texture {
    int width, height;
    uint8_t *rgba;
} pps_texture;

typedef struct pps_material {
    char *name;
    bool leaf;
    double color[3];  /* linear, for pictures; multiplies the texture */
    int texture;      /* index into the mesh's textures, -1: none */
    double alpha_min; /* the surface is there where alpha >= this; 0: everywhere */
} pps_material;

typedef struct pps_leaf {
    double center[3], normal[3]; /* area-weighted; the normal has length 1 */
    double area; /* one-sided, only where the surface is there (alpha) */
    uint32_t first, n_triangles; /* its triangles, consecutive */
    uint32_t material;
} pps_leaf;

/* Owns its arrays. Triangles of leaf i are leaf[i].first .. first + n_triangles - 1;
 * those of wood come last. */
typedef struct pps_mesh {
    size_t n_vertices, n_triangles, n_leaves, n_materials, n_textures;
    double (*position)[3];   /* n_vertices */
    float (*uv)[2];          /* n_vertices, v up; NULL: no texture coordinates */
    uint32_t (*triangle)[3]; /* n_triangles */
    uint32_t *leaf_of;       /* n_triangles: its leaf, or PPS_NO_LEAF for wood */
    uint32_t *material_of;   /* n_triangles */
    pps_leaf *leaf;          /* n_leaves */
    pps_material *material;  /* n_materials */
    pps_texture *texture;    /* n_textures */
    size_t n_doubled; /* triangles that pps_mesh_read left out, as they lay on others */
} pps_mesh;

/* Size in numbers. `center` and `radius` bound the leaves: the middle of their box and
 * half its mean horizontal extent (the unit of periods). */
typedef struct pps_mesh_size {
    double low[3], high[3]; /* of everything */
    double leaf_low[3], leaf_high[3];
    double center[3], radius;
    double leaf_area; /* one-sided, alpha-weighted, m^2 */
    double
        leaf_area_index; /* leaf_area over the convex hull of the leaves seen from above */
} pps_mesh_size;

/* From raw triangles to a mesh: `position`, `triangle`, `material_of` and `material` (and
 * uv, texture) are set; groups the triangles into leaves, puts them in order, and fills
 * leaf_of and leaf. Vertices at the same place are one for what is connected; where more
 * than two triangles meet at an edge, those within 30 degrees are (crossed cards are two
 * leaves). A piece of
 * more than PPS_LEAF_TRIANGLES triangles is foliage without leaves of its own: each of its
 * triangles is then a leaf. MEMORY; ARGUMENT: an index out of range, or no triangle. */
enum { PPS_LEAF_TRIANGLES = 64 };
PPS_API pps_status pps_mesh_finish(pps_mesh *mesh);

PPS_API void pps_mesh_free(pps_mesh *mesh); /* NULL is fine */
PPS_API void pps_mesh_measure(const pps_mesh *mesh, pps_mesh_size *size);

/* Which way is up in a file. */
typedef enum {
    PPS_UP_OF_FORMAT, /* what the format says: z in PLY and STL, what an FBX file states,
                         y in all others */
    PPS_UP_X,
    PPS_UP_Y,
    PPS_UP_Z
} pps_up;

typedef struct pps_mesh_read_options {
    const char *leaf; /* POSIX extended regular expression, case ignored; NULL:
                         "leaf|leaves|foliage" */
    pps_up up;
    const char
        *leaf_image; /* PNG or JPEG for leaf materials that have no image of their
                               own, cut where its alpha is below 0.5; NULL: none */
    double
        unit; /* metres that the file's unit is; 0: 1 (FBX and Collada tell their own,
                    which are honoured before) */
} pps_mesh_read_options;

/* Read what Assimp reads: OBJ, glTF, PLY, FBX ... A triangle is leaf if the name of its
 * material matches `leaf`; if no material's name does, if the name of its object (node or
 * mesh) does; the rest is wood. PLY and STL files have no names: all is leaf.
 *
 * Where leaves are cut out by alpha: glTF as its alphaMode says (BLEND is cut at 0.5),
 * other formats by the opacity image (its alpha channel, else its luminance) or else by
 * the colour image's alpha channel, cut at 0.5. Textures are PNG or JPEG.
 *
 * Of triangles on the same three places one is kept, and of a flat quadrangle that is
 * covered from both sides the first two: double-sided cards are one leaf (n_doubled says
 * how many triangles went). Triangles without area are left out.
 *
 * FILE: this file, or one it names, cannot be read; FORMAT: not a mesh, or empty;
 * ARGUMENT: nothing matches `leaf` (the problem lists the names), or a bad option.
 * NULL options: defaults. */
PPS_API pps_status pps_mesh_read(const char *path, const pps_mesh_read_options *options,
                                 pps_mesh **out, pps_problem *problem);

/* Write by the name's ending. .obj: y up, with .mtl and the textures as PNG beside it;
 * reading it gives the same mesh. .ply: binary, z up; geometry, texture coordinates and
 * colours alone. color: NULL or linear rgb of each vertex, [3 * vertex], clipped to 0..1,
 * written as sRGB. FILE: cannot be written (nothing is left under the name);
 * ARGUMENT: another ending. */
PPS_API pps_status pps_mesh_write(const pps_mesh *mesh, const char *path,
                                  const float *color, pps_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
