/* A plant's triangles on the GPU, in groups of one material.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_GPU_MESH_H
#define PREVIEW_GPU_MESH_H

#include "preview/gl.h"

/* Attributes of a vertex in every shader. */
enum {
    AT_POSITION,
    AT_NORMAL, /* of its leaf's face, smooth across wood */
    AT_TEXTURE,
    AT_LEAF,  /* number within the mesh; none for wood */
    AT_PLACE, /* of an instance: translation, scale */
    AT_TURN,  /* cosine and sine of its yaw */
    AT_OWN,   /* its number, and its first leaf's */
    AT_CENTER /* of its leaf; of wood: the vertex itself */
};

/* Levels of detail: level k has one leaf in 2^k, each made so much larger about its center
 * that their area is the same. */
enum { GPU_LEVELS = 6 };

typedef struct {
    const pps_material *material;
    GLuint texture;            /* 0: none */
    float mean[3];             /* of the texture, linear */
    GLintptr first;            /* byte in the buffer of indices */
    GLsizei count[GPU_LEVELS]; /* indices; a level's are the first of those before */
    double grow[GPU_LEVELS];
    bool leaf;
} gpu_group;

typedef struct {
    const pps_mesh *mesh;
    GLuint vertices, buffer, indices, *texture;
    double leaf_size; /* square root of the mean area, metres */
    gpu_group *group; /* leaves before wood */
    size_t n_groups;
} gpu_mesh;

/* MEMORY. The mesh must outlive it. */
pps_status gpu_mesh_create(const pps_mesh *mesh, gpu_mesh *out);
void gpu_mesh_free(gpu_mesh *mesh); /* zeros are fine */

/* Draw a group of the mesh whose vertices are bound, n instances of it. */
void gpu_group_draw(const gpu_group *group, int level, GLsizei n);

#endif
