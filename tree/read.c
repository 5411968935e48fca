/* Reading meshes: Assimp opens the file; nodes become one list of triangles, z up.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <assimp/cimport.h>
#include <assimp/postprocess.h>

#include "tree/doubled.h"
#include "tree/path.h"
#include "tree/problem.h"
#include "tree/read.h"

static const char DEFAULT_LEAF[] = "leaf|leaves|foliage";

/* More than numbers of 32 bits hold, with room for what is made of them. */
static const size_t MOST_TRIANGLES = UINT32_MAX / 8;

/* Rows of [A | t]: p -> A p + t. */
typedef struct {
    double row[3][4];
} affine;

static affine compose(const affine *outer, const struct aiMatrix4x4 *m) {
    double inner[3][4] = {{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
                          {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
                          {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}};
    affine out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            out.row[i][j] = j == 3 ? outer->row[i][3] : 0;
            for (int k = 0; k < 3; k++) {
                out.row[i][j] += outer->row[i][k] * inner[k][j];
            }
        }
    }
    return out;
}

/* Mirrors turn triangles inside out. */
static bool mirrors(const affine *a) {
    const double(*m)[4] = a->row;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]) <
           0;
}

/* ---- what is up ---- */

static pps_up up_of_format(const reader *r) {
    if (pps_path_ends(r->path, ".ply") || pps_path_ends(r->path, ".stl")) {
        return PPS_UP_Z;
    }
    const struct aiMetadata *meta = r->scene->mMetaData;
    for (unsigned i = 0; meta && i < meta->mNumProperties; i++) {
        if (strcmp(meta->mKeys[i].data, "UpAxis") == 0 &&
            meta->mValues[i].mType == AI_INT32) {
            static const pps_up AXIS[] = {PPS_UP_X, PPS_UP_Y, PPS_UP_Z};
            int32_t axis = *(const int32_t *)meta->mValues[i].mData;
            return axis >= 0 && axis < 3 ? AXIS[axis] : PPS_UP_Y;
        }
    }
    return PPS_UP_Y;
}

/* A cyclic exchange of the axes (or a quarter turn) that brings `up` to z, in metres. */
static affine to_metres_z_up(pps_up up, double unit) {
    switch (up) {
    case PPS_UP_X: /* y, z, x */
        return (affine){{{0, unit, 0, 0}, {0, 0, unit, 0}, {unit, 0, 0, 0}}};
    case PPS_UP_Z:
        return (affine){{{unit, 0, 0, 0}, {0, unit, 0, 0}, {0, 0, unit, 0}}};
    default: /* x, -z, y: x stays to the right, the front of the plant faces -y */
        return (affine){{{unit, 0, 0, 0}, {0, 0, -unit, 0}, {0, unit, 0, 0}}};
    }
}

/* ---- what is leaf ---- */

static bool matches(const reader *r, const char *name) {
    return regexec(&r->leaf, name, 0, NULL, 0) == 0;
}

static bool material_matches(const reader *r, unsigned material) {
    struct aiString name = pps_read_material_name(r->scene->mMaterials[material]);
    return matches(r, name.data);
}

static bool is_leaf(const reader *r, const struct aiMesh *part, bool object) {
    return r->told_by == ALL_LEAVES ||
           (r->told_by == BY_MATERIAL ? material_matches(r, part->mMaterialIndex)
                                      : object || matches(r, part->mName.data));
}

/* ---- the walk over the nodes ---- */

typedef pps_status visitor(reader *r, const struct aiMesh *part, const affine *at,
                           bool object);

/* `object`: a node above matches. The root often has the file's name, which says nothing. */
static pps_status walk(reader *r, const struct aiNode *node, const affine *above,
                       bool object, visitor *visit) {
    affine at = compose(above, &node->mTransformation);
    pps_status status = PPS_OK;
    object = object || (node != r->scene->mRootNode && matches(r, node->mName.data));
    for (unsigned i = 0; !status && i < node->mNumMeshes; i++) {
        status = visit(r, r->scene->mMeshes[node->mMeshes[i]], &at, object);
    }
    for (unsigned i = 0; !status && i < node->mNumChildren; i++) {
        status = walk(r, node->mChildren[i], &at, object, visit);
    }
    return status;
}

static int slot_of(const struct aiMesh *part, bool leaf) {
    int use = (leaf ? USE_LEAF : 0) | (part->mTextureCoords[0] ? USE_UV : 0);
    return USES * (int)part->mMaterialIndex + use;
}

/* Lines and points are no surface. */
static size_t count_triangles(const struct aiMesh *part) {
    size_t n = 0;
    for (unsigned i = 0; i < part->mNumFaces; i++) {
        n += part->mFaces[i].mNumIndices == 3;
    }
    return n;
}

static pps_status count(reader *r, const struct aiMesh *part, const affine *at,
                        bool object) {
    (void)at;
    size_t n = count_triangles(part);
    if (n == 0) {
        return PPS_OK;
    }
    r->mesh->n_vertices += part->mNumVertices;
    r->mesh->n_triangles += n;
    r->slot[slot_of(part, is_leaf(r, part, object))] = 0;
    if (r->mesh->n_vertices > MOST_TRIANGLES || r->mesh->n_triangles > MOST_TRIANGLES) {
        return pps_complain(r->problem, PPS_ERR_FORMAT, "%s: more than %zu triangles",
                            r->path, MOST_TRIANGLES);
    }
    return PPS_OK;
}

/* The vertices of a part behind those that are there. */
static pps_status add_vertices(reader *r, const struct aiMesh *part, const affine *at) {
    pps_mesh *mesh = r->mesh;
    unsigned channel = pps_read_uv_channel(r->scene->mMaterials[part->mMaterialIndex]);
    const struct aiVector3D *uv = part->mTextureCoords[channel]
                                      ? part->mTextureCoords[channel]
                                      : part->mTextureCoords[0];
    for (unsigned v = 0; v < part->mNumVertices; v++) {
        const struct aiVector3D *p = &part->mVertices[v];
        double *position = mesh->position[mesh->n_vertices];
        bool finite = true;
        for (int i = 0; i < 3; i++) {
            const double *row = at->row[i];
            position[i] = row[0] * (double)p->x + row[1] * (double)p->y +
                          row[2] * (double)p->z + row[3];
            finite = finite && isfinite(position[i]);
        }
        if (mesh->uv && uv) {
            float *to = mesh->uv[mesh->n_vertices];
            to[0] = uv[v].x;
            to[1] = uv[v].y;
            finite = finite && isfinite(to[0]) && isfinite(to[1]);
        }
        if (!finite) {
            return pps_complain(r->problem, PPS_ERR_FORMAT,
                                "%s: vertex %u of '%s' is not a finite number", r->path,
                                v + 1, part->mName.data);
        }
        mesh->n_vertices++;
    }
    return PPS_OK;
}

static pps_status add_part(reader *r, const struct aiMesh *part, const affine *at,
                           bool object) {
    pps_mesh *mesh = r->mesh;
    if (count_triangles(part) == 0) {
        return PPS_OK;
    }
    uint32_t first = (uint32_t)mesh->n_vertices;
    uint32_t material = (uint32_t)r->slot[slot_of(part, is_leaf(r, part, object))];
    bool swap = mirrors(at);
    for (unsigned f = 0; f < part->mNumFaces; f++) {
        const struct aiFace *face = &part->mFaces[f];
        for (unsigned i = 0; face->mNumIndices == 3 && i < 3; i++) {
            if (face->mIndices[i] >= part->mNumVertices) {
                return pps_complain(r->problem, PPS_ERR_FORMAT,
                                    "%s: face %u of '%s' has no vertex %u", r->path,
                                    f + 1, part->mName.data, face->mIndices[i] + 1);
            }
            unsigned corner = swap && i ? 3 - i : i;
            mesh->triangle[mesh->n_triangles][corner] = first + face->mIndices[i];
        }
        if (face->mNumIndices == 3) {
            mesh->material_of[mesh->n_triangles++] = material;
        }
    }
    return add_vertices(r, part, at);
}

/* ---- the parts together ---- */

/* The names that `leaf` was held against, for the problem's text. */
static void list_names(const reader *r, char *text, size_t size) {
    size_t at = 0;
    for (unsigned m = 0; m < r->scene->mNumMaterials && at < size; m++) {
        bool used = false;
        for (int use = 0; use < USES; use++) {
            used = used || r->slot[USES * (int)m + use] >= 0;
        }
        if (used) {
            struct aiString name = pps_read_material_name(r->scene->mMaterials[m]);
            at += (size_t)snprintf(text + at, size - at, "%s'%s'", at ? ", " : "",
                                   name.data);
        }
    }
}

static bool any_leaf(const reader *r) {
    for (unsigned i = 0; i < USES * r->scene->mNumMaterials; i++) {
        if (r->slot[i] >= 0 && (i & USE_LEAF)) {
            return true;
        }
    }
    return false;
}

/* Count with what tells leaves from wood: material names, or else those of objects. */
static pps_status count_all(reader *r, const affine *at, const char *leaf) {
    bool nameless = pps_path_ends(r->path, ".ply") || pps_path_ends(r->path, ".stl");
    r->told_by = nameless ? ALL_LEAVES : BY_MATERIAL;
    for (;;) {
        memset(r->slot, -1, USES * r->scene->mNumMaterials * sizeof *r->slot);
        r->mesh->n_vertices = r->mesh->n_triangles = 0;
        pps_status status = walk(r, r->scene->mRootNode, at, false, count);
        if (status) {
            return status;
        }
        if (r->mesh->n_triangles == 0) {
            return pps_complain(r->problem, PPS_ERR_FORMAT,
                                "%s: there is no triangle in it", r->path);
        }
        if (any_leaf(r)) {
            return PPS_OK;
        }
        if (r->told_by == BY_OBJECT) {
            char names[300] = "";
            list_names(r, names, sizeof names);
            return pps_complain(r->problem, PPS_ERR_ARGUMENT,
                                "%s: no material or object name matches '%s', so there "
                                "are no leaves; its materials are %s",
                                r->path, leaf, names);
        }
        r->told_by = BY_OBJECT;
    }
}

static pps_status allocate(reader *r) {
    pps_mesh *mesh = r->mesh;
    size_t slots = USES * (size_t)r->scene->mNumMaterials;
    bool uv = false;
    for (size_t i = 0; i < slots; i++) {
        uv = uv || (r->slot[i] >= 0 && (i & USE_UV));
    }
    mesh->position = malloc(mesh->n_vertices * sizeof *mesh->position);
    mesh->uv = uv ? calloc(mesh->n_vertices, sizeof *mesh->uv) : NULL;
    mesh->triangle = malloc(mesh->n_triangles * sizeof *mesh->triangle);
    mesh->material_of = malloc(mesh->n_triangles * sizeof *mesh->material_of);
    mesh->material = calloc(slots + 1, sizeof *mesh->material);
    mesh->texture = calloc(slots + 1, sizeof *mesh->texture);
    r->source = calloc(slots + 1, sizeof *r->source);
    bool good = mesh->position && (mesh->uv || !uv) && mesh->triangle &&
                mesh->material_of && mesh->material && mesh->texture && r->source;
    return good ? PPS_OK : PPS_ERR_MEMORY;
}

static pps_status read_materials(reader *r) {
    pps_status status = PPS_OK;
    for (unsigned i = 0; !status && i < USES * r->scene->mNumMaterials; i++) {
        if (r->slot[i] >= 0) {
            r->slot[i] = (int)r->mesh->n_materials;
            status = pps_read_material(r, i / USES, (int)(i % USES));
        }
    }
    return status;
}

static pps_status convert(reader *r, const pps_mesh_read_options *options,
                          const char *leaf) {
    pps_up up = options->up ? options->up : up_of_format(r);
    affine at = to_metres_z_up(up, options->unit > 0 ? options->unit : 1);
    r->slot = malloc((USES * r->scene->mNumMaterials + 1) * sizeof *r->slot);
    r->mesh = calloc(1, sizeof *r->mesh);
    if (!r->slot || !r->mesh) {
        return PPS_ERR_MEMORY;
    }
    pps_status status = count_all(r, &at, leaf);
    if (!status) {
        status = allocate(r);
    }
    if (!status) {
        status = read_materials(r);
    }
    if (!status) {
        r->mesh->n_vertices = r->mesh->n_triangles = 0;
        status = walk(r, r->scene->mRootNode, &at, false, add_part);
    }
    if (!status) {
        status = pps_mesh_drop_doubled(r->mesh);
    }
    if (!status && r->mesh->n_triangles == 0) {
        status = pps_complain(r->problem, PPS_ERR_FORMAT,
                              "%s: no triangle in it has an area", r->path);
    }
    return status ? status : pps_mesh_finish(r->mesh);
}

/* ---- the file ---- */

/* Whether the file is there and holds something: Assimp does not tell why it failed. */
static pps_status probe(const char *path, pps_problem *problem) {
    errno = 0;
    FILE *file = fopen(path, "rb");
    int first = file ? fgetc(file) : EOF, reason = errno;
    bool failed = !file || ferror(file);
    if (file) {
        fclose(file);
    }
    if (failed) {
        return pps_complain(problem, PPS_ERR_FILE, "%s: %s", path, strerror(reason));
    }
    return first == EOF ? pps_complain(problem, PPS_ERR_FORMAT, "%s: is empty", path)
                        : PPS_OK;
}

/* An OBJ file whose material library is missing reads as if it had none: say so. */
static pps_status probe_library(const char *path, pps_problem *problem) {
    unsigned char *bytes;
    size_t n;
    pps_status status = pps_path_load(path, &bytes, &n);
    if (status) {
        return status;
    }
    for (char *line = (char *)bytes; line && !status;) {
        char *end = strchr(line, '\n'), name[1024];
        if (strncmp(line, "mtllib ", 7) == 0) {
            int length = (int)strcspn(line + 7, "\r\n");
            snprintf(name, sizeof name, "%.*s", length, line + 7);
            char *library = pps_path_beside(path, name);
            FILE *file = library ? fopen(library, "rb") : NULL;
            status = !library ? PPS_ERR_MEMORY
                     : !file  ? pps_complain(problem, PPS_ERR_FILE,
                                             "%s: its material library '%s': %s", path,
                                             name, strerror(errno))
                              : PPS_OK;
            if (file) {
                fclose(file);
            }
            free(library);
        }
        line = end ? end + 1 : NULL;
    }
    free(bytes);
    return status;
}

static pps_status import(reader *r) {
    pps_status status = probe(r->path, r->problem);
    if (!status && pps_path_ends(r->path, ".obj")) {
        status = probe_library(r->path, r->problem);
    }
    if (status) {
        return status;
    }
    r->scene = aiImportFile(r->path, aiProcess_Triangulate | aiProcess_GlobalScale |
                                         aiProcess_TransformUVCoords);
    if (!r->scene) {
        const char *why = aiGetErrorString();
        bool unknown = strncmp(why, "No suitable reader", 18) == 0;
        return pps_complain(r->problem, PPS_ERR_FORMAT, "%s: %.200s", r->path,
                            unknown ? "not a mesh, or of a format that is not read"
                                    : why);
    }
    return r->scene->mRootNode && r->scene->mNumMeshes && r->scene->mNumMaterials
               ? PPS_OK
               : pps_complain(r->problem, PPS_ERR_FORMAT,
                              "%s: there is no triangle in it", r->path);
}

static void release(reader *r) {
    for (size_t i = 0; r->source && i < r->mesh->n_textures; i++) {
        free(r->source[i]);
    }
    free(r->source);
    free(r->slot);
    if (r->scene) {
        aiReleaseImport(r->scene);
    }
    regfree(&r->leaf);
}

pps_status pps_mesh_read(const char *path, const pps_mesh_read_options *options,
                         pps_mesh **out, pps_problem *problem) {
    static const pps_mesh_read_options DEFAULTS = {NULL, PPS_UP_OF_FORMAT, NULL, 0};
    *out = NULL;
    options = options ? options : &DEFAULTS;
    const char *leaf = options->leaf ? options->leaf : DEFAULT_LEAF;
    if (!(options->unit >= 0) || !isfinite(options->unit)) {
        return pps_complain(problem, PPS_ERR_ARGUMENT,
                            "unit is %g; it must be a number of metres > 0",
                            options->unit);
    }
    reader r = {.path = path, .leaf_image = options->leaf_image, .problem = problem};
    int bad = regcomp(&r.leaf, leaf, REG_EXTENDED | REG_ICASE | REG_NOSUB);
    if (bad) {
        char why[100];
        regerror(bad, &r.leaf, why, sizeof why);
        return pps_complain(problem, PPS_ERR_ARGUMENT,
                            "'%s' is not a regular expression: %s", leaf, why);
    }
    pps_status status = import(&r);
    if (!status) {
        status = convert(&r, options, leaf);
    }
    if (status == PPS_ERR_MEMORY) {
        pps_complain(problem, status, "%s: out of memory", path);
    }
    release(&r);
    if (status) {
        pps_mesh_free(r.mesh);
        return status;
    }
    *out = r.mesh;
    return PPS_OK;
}
