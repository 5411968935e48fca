/* Meshes to vertex and index buffers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/gpu_mesh.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    float position[3], normal[3], place[2], center[3];
    uint32_t leaf;
} vertex;

/* What is filled: vertices, indices, and which vertex was last made of each of the mesh's. */
typedef struct {
    const pps_mesh *mesh;
    double (*sum)[3]; /* of normals about each of the mesh's vertices */
    vertex *vertex;
    uint32_t *index, *made; /* made: plus 1 */
    size_t n_vertices, n_indices;
} filling;

static const double CREASE = 0.4; /* cosine: sharper edges than this stay sharp */

/* ---- normals ---- */

static void triangle_normal(const pps_mesh *mesh, size_t t, double n[3]) {
    const double *a = mesh->position[mesh->triangle[t][0]];
    double ab[3], ac[3];
    for (int i = 0; i < 3; i++) {
        ab[i] = mesh->position[mesh->triangle[t][1]][i] - a[i];
        ac[i] = mesh->position[mesh->triangle[t][2]][i] - a[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = ab[j] * ac[k] - ab[k] * ac[j];
    }
}

static double normalize(double n[3]) {
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3 && length > 0; i++) {
        n[i] /= length;
    }
    return length;
}

/* Sums of the normals of the triangles that share a vertex, by area. */
static double (*vertex_normals(const pps_mesh *mesh))[3] {
    double(*sum)[3] = calloc(mesh->n_vertices + 1, sizeof *sum);
    for (size_t t = 0; sum && t < mesh->n_triangles; t++) {
        double n[3];
        triangle_normal(mesh, t, n);
        for (int i = 0; i < 9; i++) {
            sum[mesh->triangle[t][i / 3]][i % 3] += n[i % 3];
        }
    }
    return sum;
}

/* The smooth normal at a corner, or the triangle's own across an edge. */
static void corner_normal(const double own[3], const double sum[3], float out[3]) {
    double smooth[3];
    memcpy(smooth, sum, sizeof smooth);
    double length = normalize(smooth);
    double along = smooth[0] * own[0] + smooth[1] * own[1] + smooth[2] * own[2];
    for (int i = 0; i < 3; i++) {
        out[i] = (float)(length > 0 && along > CREASE ? smooth[i] : own[i]);
    }
}

/* ---- vertices ---- */

static void put_vertex(const filling *f, size_t t, int corner, const double own[3],
                       vertex *out) {
    const pps_mesh *mesh = f->mesh;
    uint32_t v = mesh->triangle[t][corner], leaf = mesh->leaf_of[t];
    const double *center =
        leaf == PPS_NO_LEAF ? mesh->position[v] : mesh->leaf[leaf].center;
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 3; k++) {
        out->position[k] = (float)mesh->position[v][k];
        out->center[k] = (float)center[k];
    }
    corner_normal(own, f->sum[v], out->normal);
    out->place[0] = mesh->uv ? mesh->uv[v][0] : 0;
    out->place[1] = mesh->uv ? mesh->uv[v][1] : 0;
    out->leaf = leaf;
}

/* A corner that is as the last one made of its vertex is the same. */
static void add_triangle(filling *f, size_t t) {
    double own[3];
    triangle_normal(f->mesh, t, own);
    normalize(own);
    for (int i = 0; i < 3; i++) {
        uint32_t v = f->mesh->triangle[t][i];
        vertex *fresh = &f->vertex[f->n_vertices];
        put_vertex(f, t, i, own, fresh);
        if (!f->made[v] ||
            memcmp(fresh, &f->vertex[f->made[v] - 1], sizeof *fresh) != 0) {
            f->made[v] = (uint32_t)++f->n_vertices;
        }
        f->index[f->n_indices++] = f->made[v] - 1;
    }
}

/* A step through n leaves that meets each once, and after any number of steps has met them
 * evenly: about the golden ratio of n, without a factor in common. */
static size_t even_step(size_t n) {
    size_t step = (size_t)(0.6180339887 * (double)n) | 1;
    for (;; step++) {
        size_t a = n, b = step;
        while (b) {
            size_t rest = a % b;
            a = b;
            b = rest;
        }
        if (a == 1) {
            return step;
        }
    }
}

/* Leaves of a material, in an even order; where each level ends. */
static void add_leaves(filling *f, size_t material, gpu_group *group) {
    const pps_mesh *mesh = f->mesh;
    size_t step = even_step(mesh->n_leaves), first = f->n_indices, n = 0, m = 0;
    double area = 0, part = 0;
    for (size_t i = 0; i < mesh->n_leaves; i++) {
        bool here = mesh->leaf[i].material == material;
        n += here;
        area += here ? mesh->leaf[i].area : 0;
    }
    for (size_t k = 0, i = 0; k < mesh->n_leaves;
         k++, i = (i + step) % mesh->n_leaves) {
        const pps_leaf *leaf = &mesh->leaf[i];
        if (leaf->material != material) {
            continue;
        }
        for (uint32_t t = 0; t < leaf->n_triangles; t++) {
            add_triangle(f, leaf->first + t);
        }
        part += leaf->area;
        m++;
        for (int level = 0; level < GPU_LEVELS; level++) {
            if (m == (n + ((size_t)1 << level) - 1) >> level) {
                group->count[level] = (GLsizei)(f->n_indices - first);
                group->grow[level] = part > 0 ? sqrt(area / part) : 1;
            }
        }
    }
}

static void add_wood(filling *f, size_t material, gpu_group *group) {
    size_t first = f->n_indices;
    for (size_t t = 0; t < f->mesh->n_triangles; t++) {
        if (f->mesh->material_of[t] == material && f->mesh->leaf_of[t] == PPS_NO_LEAF) {
            add_triangle(f, t);
        }
    }
    for (int level = 0; level < GPU_LEVELS; level++) {
        group->count[level] = (GLsizei)(f->n_indices - first);
        group->grow[level] = 1;
    }
}

/* Triangles in groups of leaf or wood and of one material. */
static void group_triangles(gpu_mesh *out, filling *f) {
    const pps_mesh *mesh = out->mesh;
    for (size_t g = 0; g < 2 * mesh->n_materials; g++) {
        bool leaf = g < mesh->n_materials;
        const pps_material *material = &mesh->material[g % mesh->n_materials];
        gpu_group *group = &out->group[out->n_groups];
        *group = (gpu_group){
            .material = material,
            .texture = material->texture >= 0 ? out->texture[material->texture] : 0,
            .mean = {1, 1, 1},
            .first = (GLintptr)(f->n_indices * sizeof *f->index),
            .leaf = leaf};
        (leaf ? add_leaves : add_wood)(f, g % mesh->n_materials, group);
        out->n_groups += group->count[0] > 0;
    }
}

static void describe_vertices(void) {
    static const struct {
        GLuint at;
        GLint n;
        size_t offset;
    } row[] = {{AT_POSITION, 3, offsetof(vertex, position)},
               {AT_NORMAL, 3, offsetof(vertex, normal)},
               {AT_TEXTURE, 2, offsetof(vertex, place)},
               {AT_CENTER, 3, offsetof(vertex, center)}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        glVertexAttribPointer(row[i].at, row[i].n, GL_FLOAT, GL_FALSE, sizeof(vertex),
                              (const char *)NULL + row[i].offset);
        glEnableVertexAttribArray(row[i].at);
    }
    glVertexAttribIPointer(AT_LEAF, 1, GL_UNSIGNED_INT, sizeof(vertex),
                           (const char *)NULL + offsetof(vertex, leaf));
    glEnableVertexAttribArray(AT_LEAF);
}

/* ---- textures ---- */

static double linear(uint8_t srgb) {
    double c = srgb / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

/* Mean linear colour of the texels that are there. */
static void texture_mean(const pps_texture *t, double alpha_min, float mean[3]) {
    double sum[3] = {0, 0, 0}, n = 0;
    for (int i = 0; i < t->width * t->height; i++) {
        if (t->rgba[4 * i + 3] / 255.0 >= alpha_min) {
            for (int k = 0; k < 3; k++) {
                sum[k] += linear(t->rgba[4 * i + k]);
            }
            n++;
        }
    }
    for (int k = 0; k < 3; k++) {
        mean[k] = n > 0 ? (float)(sum[k] / n) : 1;
    }
}

/* The texture with its rows from the bottom up, as v runs. */
static pps_status upload(const pps_texture *t, GLuint texture) {
    size_t row = 4 * (size_t)t->width;
    uint8_t *flipped = malloc(row * (size_t)t->height + 1);
    if (!flipped) {
        return PPS_ERR_MEMORY;
    }
    for (int y = 0; y < t->height; y++) {
        memcpy(flipped + row * (size_t)y, t->rgba + row * (size_t)(t->height - 1 - y),
               row);
    }
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, t->width, t->height, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, flipped);
    glGenerateMipmap(GL_TEXTURE_2D);
    free(flipped);
    return PPS_OK;
}

/* ---- life ---- */

static void upload_filling(const filling *f, gpu_mesh *out) {
    glGenVertexArrays(1, &out->vertices);
    glGenBuffers(1, &out->buffer);
    glGenBuffers(1, &out->indices);
    glBindVertexArray(out->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, out->buffer);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(f->n_vertices * sizeof *f->vertex),
                 f->vertex, GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, out->indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(f->n_indices * sizeof *f->index),
                 f->index, GL_STATIC_DRAW);
    describe_vertices();
    glBindVertexArray(0);
}

static void measure_leaves(gpu_mesh *out) {
    double area = 0;
    for (size_t i = 0; i < out->mesh->n_leaves; i++) {
        area += out->mesh->leaf[i].area;
    }
    out->leaf_size = out->mesh->n_leaves ? sqrt(area / (double)out->mesh->n_leaves) : 0;
}

static pps_status upload_all(gpu_mesh *out) {
    const pps_mesh *mesh = out->mesh;
    size_t n = 3 * mesh->n_triangles + 1;
    filling f = {.mesh = mesh,
                 .sum = vertex_normals(mesh),
                 .vertex = malloc(n * sizeof *f.vertex),
                 .index = malloc(n * sizeof *f.index),
                 .made = calloc(mesh->n_vertices + 1, sizeof *f.made)};
    pps_status status =
        f.sum && f.vertex && f.index && f.made ? PPS_OK : PPS_ERR_MEMORY;
    for (size_t i = 0; i < mesh->n_textures && !status; i++) {
        status = upload(&mesh->texture[i], out->texture[i]);
    }
    if (!status) {
        group_triangles(out, &f);
        upload_filling(&f, out);
        measure_leaves(out);
    }
    for (size_t i = 0; i < out->n_groups; i++) {
        const pps_material *m = out->group[i].material;
        if (m->texture >= 0) {
            texture_mean(&mesh->texture[m->texture], m->alpha_min, out->group[i].mean);
        }
    }
    free(f.sum);
    free(f.vertex);
    free(f.index);
    free(f.made);
    return status;
}

pps_status gpu_mesh_create(const pps_mesh *mesh, gpu_mesh *out) {
    *out = (gpu_mesh){.mesh = mesh};
    out->texture = calloc(mesh->n_textures + 1, sizeof *out->texture);
    out->group = calloc(2 * mesh->n_materials + 1, sizeof *out->group);
    pps_status status = PPS_ERR_MEMORY;
    if (out->texture && out->group) {
        glGenTextures((GLsizei)mesh->n_textures, out->texture);
        status = upload_all(out);
    }
    if (status) {
        gpu_mesh_free(out);
    }
    return status;
}

void gpu_mesh_free(gpu_mesh *mesh) {
    if (mesh->texture) {
        glDeleteTextures((GLsizei)mesh->mesh->n_textures, mesh->texture);
    }
    glDeleteVertexArrays(1, &mesh->vertices);
    glDeleteBuffers(1, &mesh->buffer);
    glDeleteBuffers(1, &mesh->indices);
    free(mesh->texture);
    free(mesh->group);
    *mesh = (gpu_mesh){0};
}

void gpu_group_draw(const gpu_group *group, int level, GLsizei n) {
    glDrawElementsInstanced(GL_TRIANGLES, group->count[level], GL_UNSIGNED_INT,
                            (const char *)NULL + group->first, n);
}
