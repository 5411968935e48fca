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
 * leaf_of and leaf. Vertices at the same place are one for what is connected. A piece of
 * more than PPS_LEAF_TRIANGLES triangles is foliage without leaves of its own: each of its
 * triangles is then a leaf. MEMORY; ARGUMENT: an index out of range, or no triangle. */
enum { PPS_LEAF_TRIANGLES = 64 };
PPS_API pps_status pps_mesh_finish(pps_mesh *mesh);

PPS_API void pps_mesh_free(pps_mesh *mesh); /* NULL is fine */
PPS_API void pps_mesh_measure(const pps_mesh *mesh, pps_mesh_size *size);

/* Read what Assimp reads (OBJ, glTF, PLY, FBX ...). A material whose name matches the
 * extended regular expression `leaf` (NULL: "leaf|leaves|foliage", case ignored) is leaf,
 * the rest is wood; without any material name that matches, ARGUMENT. y-up formats are
 * turned to z up. FILE: cannot be read; FORMAT: not a mesh, or empty. */
PPS_API pps_status pps_mesh_read(const char *path, const char *leaf, pps_mesh **out,
                                 pps_problem *problem);

/* Write by the name's ending: .obj (and .mtl, and the textures beside it) or .ply.
 * color: NULL or linear rgb of each vertex, [3 * vertex], clipped to 0..1. */
PPS_API pps_status pps_mesh_write(const pps_mesh *mesh, const char *path,
                                  const float *color, pps_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
