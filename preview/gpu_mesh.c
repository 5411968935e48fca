/* Meshes to vertex buffers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/gpu_mesh.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    float position[3], normal[3], place[2];
    uint32_t leaf;
} vertex;

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

static void add_triangle(const pps_mesh *mesh, size_t t, const double (*sum)[3],
                         vertex *out) {
    double own[3];
    triangle_normal(mesh, t, own);
    normalize(own);
    for (int i = 0; i < 3; i++) {
        uint32_t v = mesh->triangle[t][i];
        for (int k = 0; k < 3; k++) {
            out[i].position[k] = (float)mesh->position[v][k];
        }
        corner_normal(own, sum[v], out[i].normal);
        out[i].place[0] = mesh->uv ? mesh->uv[v][0] : 0;
        out[i].place[1] = mesh->uv ? mesh->uv[v][1] : 0;
        out[i].leaf = mesh->leaf_of[t];
    }
}

/* Triangles in groups of leaf or wood and of one material. */
static void group_triangles(gpu_mesh *out, const double (*sum)[3], vertex *all) {
    const pps_mesh *mesh = out->mesh;
    size_t n = 0;
    for (size_t g = 0; g < 2 * mesh->n_materials; g++) {
        bool leaf = g < mesh->n_materials;
        size_t m = g % mesh->n_materials, first = n;
        for (size_t t = 0; t < mesh->n_triangles; t++) {
            if (mesh->material_of[t] == m &&
                leaf == (mesh->leaf_of[t] != PPS_NO_LEAF)) {
                add_triangle(mesh, t, sum, all + n);
                n += 3;
            }
        }
        if (n > first) {
            const pps_material *material = &mesh->material[m];
            out->group[out->n_groups++] = (gpu_group){
                .material = material,
                .texture = material->texture >= 0 ? out->texture[material->texture] : 0,
                .mean = {1, 1, 1},
                .first = (GLint)first,
                .count = (GLsizei)(n - first),
                .leaf = leaf};
        }
    }
}

static void describe_vertices(void) {
    static const struct {
        GLuint at;
        GLint n;
        size_t offset;
    } row[] = {{AT_POSITION, 3, offsetof(vertex, position)},
               {AT_NORMAL, 3, offsetof(vertex, normal)},
               {AT_TEXTURE, 2, offsetof(vertex, place)}};
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

static pps_status upload_all(gpu_mesh *out) {
    const pps_mesh *mesh = out->mesh;
    vertex *all = malloc((3 * mesh->n_triangles + 1) * sizeof *all);
    double(*sum)[3] = vertex_normals(mesh);
    pps_status status = all && sum ? PPS_OK : PPS_ERR_MEMORY;
    for (size_t i = 0; i < mesh->n_textures && !status; i++) {
        status = upload(&mesh->texture[i], out->texture[i]);
    }
    if (!status) {
        group_triangles(out, (const double(*)[3])sum, all);
        glGenVertexArrays(1, &out->vertices);
        glGenBuffers(1, &out->buffer);
        glBindVertexArray(out->vertices);
        glBindBuffer(GL_ARRAY_BUFFER, out->buffer);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(3 * mesh->n_triangles * sizeof *all),
                     all, GL_STATIC_DRAW);
        describe_vertices();
        glBindVertexArray(0);
    }
    for (size_t i = 0; i < out->n_groups; i++) {
        const pps_material *m = out->group[i].material;
        if (m->texture >= 0) {
            texture_mean(&mesh->texture[m->texture], m->alpha_min, out->group[i].mean);
        }
    }
    free(all);
    free(sum);
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
    free(mesh->texture);
    free(mesh->group);
    *mesh = (gpu_mesh){0};
}
