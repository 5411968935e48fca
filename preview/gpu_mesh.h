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
    AT_OWN    /* its number, and its first leaf's */
};

typedef struct {
    const pps_material *material;
    GLuint texture; /* 0: none */
    float mean[3];  /* of the texture, linear */
    GLint first;
    GLsizei count;
    bool leaf;
} gpu_group;

typedef struct {
    const pps_mesh *mesh;
    GLuint vertices, buffer, *texture;
    gpu_group *group; /* leaves before wood */
    size_t n_groups;
} gpu_mesh;

/* MEMORY. The mesh must outlive it. */
pps_status gpu_mesh_create(const pps_mesh *mesh, gpu_mesh *out);
void gpu_mesh_free(gpu_mesh *mesh); /* zeros are fine */

#endif
