/* What the parts of the mesh reader share.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_READ_H
#define PPS_TREE_READ_H

#include <regex.h>

#include <assimp/scene.h>

#include <ppscat/tree/mesh.h>

/* How a triangle's material is used; each way that occurs is a material of its own. */
enum { USE_LEAF = 1, USE_UV = 2, USES = 4 };

typedef struct reader {
    const char *path;
    const struct aiScene *scene;
    const char *leaf_image; /* for leaves without an image, or NULL */
    pps_problem *problem;
    regex_t leaf;
    enum { BY_MATERIAL, BY_OBJECT, ALL_LEAVES } told_by; /* leaves from wood */
    pps_mesh *mesh;
    int *slot;     /* [USES * material + use]: number in the mesh, -1: not there */
    char **source; /* per texture of the mesh: the images it was made of */
} reader;

/* The name of a material; "" if it has none. */
struct aiString pps_read_material_name(const struct aiMaterial *material);

/* Fill the mesh's next material, and its texture if that is new. */
pps_status pps_read_material(reader *r, unsigned material, int use);

/* The texture coordinates that the material's images are laid by. */
unsigned pps_read_uv_channel(const struct aiMaterial *material);

#endif
