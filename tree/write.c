/* Writing meshes: OBJ for whole plants, PLY for geometry and colours.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tree/image.h"
#include "tree/path.h"
#include "tree/problem.h"
#include "tree/srgb.h"
#include "tree/text.h"

/* ---- OBJ ---- */

/* Names in OBJ and MTL end at a space. */
static void print_name(FILE *file, const pps_mesh *mesh, size_t material) {
    const char *name = mesh->material[material].name;
    for (const char *c = name; c && *c; c++) {
        fputc((unsigned char)*c <= ' ' ? '_' : *c, file);
    }
    if (!name || !*name) {
        fprintf(file, mesh->material[material].leaf ? "leaf_%zu" : "wood_%zu",
                material);
    }
}

/* y up, as OBJ files have it. */
static void print_vertices(FILE *file, const pps_mesh *mesh, const float *color) {
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        const double *p = mesh->position[v];
        fprintf(file, "v %.9g %.9g %.9g", p[0], p[2], -p[1]);
        for (int i = 0; color && i < 3; i++) {
            double linear = fmin(fmax((double)color[3 * v + (size_t)i], 0), 1);
            fprintf(file, " %.4f", srgb_encode(linear));
        }
        fputc('\n', file);
    }
    for (size_t v = 0; mesh->uv && v < mesh->n_vertices; v++) {
        fprintf(file, "vt %.9g %.9g\n", (double)mesh->uv[v][0], (double)mesh->uv[v][1]);
    }
}

static void print_faces(FILE *file, const pps_mesh *mesh) {
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        uint32_t material = mesh->material_of[t];
        if (t == 0 || material != mesh->material_of[t - 1]) {
            fprintf(file, "usemtl ");
            print_name(file, mesh, material);
            fputc('\n', file);
        }
        fputc('f', file);
        for (int i = 0; i < 3; i++) {
            uint32_t v = mesh->triangle[t][i] + 1;
            fprintf(file, mesh->uv ? " %u/%u" : " %u", v, v);
        }
        fputc('\n', file);
    }
}

static void write_obj(FILE *file, const pps_mesh *mesh, const float *color,
                      const char *path) {
    const char *base = pps_path_base(path);
    fprintf(file, "mtllib %.*s.mtl\no plant\n", (int)(pps_path_ending(base) - base),
            base);
    print_vertices(file, mesh, color);
    print_faces(file, mesh);
}

static void write_mtl(FILE *file, const pps_mesh *mesh, const char *path) {
    const char *base = pps_path_base(path);
    int stem = (int)(pps_path_ending(base) - base);
    for (size_t i = 0; i < mesh->n_materials; i++) {
        const pps_material *m = &mesh->material[i];
        fprintf(file, "newmtl ");
        print_name(file, mesh, i);
        fprintf(file, "\nKd %.6g %.6g %.6g\n", m->color[0], m->color[1], m->color[2]);
        if (m->texture >= 0) {
            fprintf(file, "map_Kd %.*s_%zu.png\n", stem, base, i);
        }
        if (m->texture >= 0 && m->alpha_min > 0) {
            fprintf(file, "map_d %.*s_%zu.png\n", stem, base, i);
        }
        fputc('\n', file);
    }
}

/* OBJ cuts at half: the alpha is written as what is there or not. */
static pps_status write_texture(FILE *file, const pps_mesh *mesh,
                                const pps_material *m) {
    const pps_texture *from = &mesh->texture[m->texture];
    size_t n = (size_t)from->width * (size_t)from->height;
    pps_texture image = {from->width, from->height, malloc(4 * n)};
    if (!image.rgba) {
        return PPS_ERR_MEMORY;
    }
    memcpy(image.rgba, from->rgba, 4 * n);
    for (size_t i = 0; i < n; i++) {
        image.rgba[4 * i + 3] = image.rgba[4 * i + 3] / 255.0 >= m->alpha_min ? 255 : 0;
    }
    pps_status status = pps_image_write(&image, m->alpha_min > 0, file);
    free(image.rgba);
    return status;
}

/* ---- PLY ---- */

/* Bytes from the lowest on, whatever the machine. */
static void put_u32(FILE *file, uint32_t x) {
    for (int i = 0; i < 4; i++, x >>= 8) {
        fputc((int)(x & 255), file);
    }
}

static void put_float(FILE *file, float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put_u32(file, bits);
}

static void write_ply(FILE *file, const pps_mesh *mesh, const float *color) {
    fprintf(
        file,
        "ply\nformat binary_little_endian 1.0\ncomment metres, z up\n"
        "element vertex %zu\nproperty float x\nproperty float y\nproperty float z\n"
        "%s%selement face %zu\nproperty list uchar int vertex_indices\nend_header\n",
        mesh->n_vertices, mesh->uv ? "property float s\nproperty float t\n" : "",
        color ? "property uchar red\nproperty uchar green\nproperty uchar blue\n" : "",
        mesh->n_triangles);
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        for (int i = 0; i < 3; i++) {
            put_float(file, (float)mesh->position[v][i]);
        }
        for (int i = 0; mesh->uv && i < 2; i++) {
            put_float(file, mesh->uv[v][i]);
        }
        for (size_t i = 0; color && i < 3; i++) {
            fputc(srgb_byte((double)color[3 * v + i]), file);
        }
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        fputc(3, file);
        for (int i = 0; i < 3; i++) {
            put_u32(file, mesh->triangle[t][i]);
        }
    }
}

/* ---- files ---- */

/* What is written under NAME.part, to be renamed when all is. */
typedef struct {
    const pps_mesh *mesh;
    const char *path;
    const float *color;
    pps_problem *problem;
    size_t n;
    char *(*name)[2]; /* final and .part, in the order of renaming */
} saving;

/* Of name and ".part". */
static char *part_of(const char *name) {
    return text_join(name, strlen(name), ".part");
}

/* STEM.mtl, STEM_0.png ... of the mesh file's path. */
static char *companion(const char *path, const char *format, size_t number) {
    char ending[32];
    snprintf(ending, sizeof ending, format, number);
    return text_join(path, (size_t)(pps_path_ending(path) - path), ending);
}

typedef pps_status writer(FILE *file, const saving *s, size_t material);

static pps_status as_obj(FILE *file, const saving *s, size_t material) {
    (void)material;
    write_obj(file, s->mesh, s->color, s->path);
    return PPS_OK;
}

static pps_status as_ply(FILE *file, const saving *s, size_t material) {
    (void)material;
    write_ply(file, s->mesh, s->color);
    return PPS_OK;
}

static pps_status as_mtl(FILE *file, const saving *s, size_t material) {
    (void)material;
    write_mtl(file, s->mesh, s->path);
    return PPS_OK;
}

static pps_status as_png(FILE *file, const saving *s, size_t material) {
    return write_texture(file, s->mesh, &s->mesh->material[material]);
}

/* One file, complete, under its name and ".part". Takes the name. */
static pps_status save(saving *s, char *name, writer *write, size_t material) {
    char *part = name ? part_of(name) : NULL;
    if (!part) {
        free(name);
        return PPS_ERR_MEMORY;
    }
    s->name[s->n][0] = name;
    s->name[s->n++][1] = part;
    errno = 0;
    FILE *file = fopen(part, "wb");
    pps_status status = file ? write(file, s, material) : PPS_ERR_FILE;
    if (!status && ferror(file)) {
        status = PPS_ERR_FILE;
    }
    if (file && fclose(file) && !status) {
        status = PPS_ERR_FILE;
    }
    if (status == PPS_ERR_FILE) {
        pps_complain(s->problem, status, "%s: %s", part, strerror(errno));
    }
    return status;
}

static pps_status save_all(saving *s) {
    const pps_mesh *mesh = s->mesh;
    bool obj = pps_path_ends(s->path, ".obj");
    pps_status status = PPS_OK;
    for (size_t i = 0; obj && !status && i < mesh->n_materials; i++) {
        if (mesh->material[i].texture >= 0) {
            status = save(s, companion(s->path, "_%zu.png", i), as_png, i);
        }
    }
    if (obj && !status) {
        status = save(s, companion(s->path, ".mtl", 0), as_mtl, 0);
    }
    if (!status) {
        status = save(s, text_copy(s->path), obj ? as_obj : as_ply, 0);
    }
    return status;
}

/* To the final names if all went well, the mesh itself last; else away with the parts. */
static pps_status settle(saving *s, pps_status status) {
    for (size_t i = 0; i < s->n; i++) {
        const char *name = s->name[i][0], *part = s->name[i][1];
        if (!status && rename(part, name)) {
            status =
                pps_complain(s->problem, PPS_ERR_FILE, "%s: %s", name, strerror(errno));
        }
        if (status) {
            remove(part);
        }
        free(s->name[i][0]);
        free(s->name[i][1]);
    }
    return status;
}

pps_status pps_mesh_write(const pps_mesh *mesh, const char *path, const float *color,
                          pps_problem *problem) {
    if (!pps_path_ends(path, ".obj") && !pps_path_ends(path, ".ply")) {
        return pps_complain(problem, PPS_ERR_ARGUMENT,
                            "%s: a mesh is written as .obj or .ply", path);
    }
    saving s = {mesh, path, color, problem, 0, NULL};
    s.name = calloc(mesh->n_materials + 2, sizeof *s.name);
    pps_status status = s.name ? settle(&s, save_all(&s)) : PPS_ERR_MEMORY;
    free(s.name);
    if (status == PPS_ERR_MEMORY) {
        pps_complain(problem, status, "%s: out of memory", path);
    }
    return status;
}
