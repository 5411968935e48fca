/* Opacity maps by two passes with blending, for OpenGL 3.3: the greatest (-along, along)
 * of each texel, then sums of layers. Depth buffers would give the first surface only.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/gpu_map.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const float NOTHING = -3e38F;

static GLuint make_texture(int texels, int n, GLenum format) {
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, (GLint)format, texels, texels, n, 0, GL_RGBA,
                 GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

bool gpu_maps_create(int texels, int n, bool counts, gpu_maps *out,
                     pps_problem *problem) {
    *out = (gpu_maps){.texels = texels, .n = n};
    out->span_program = gl_program("map_vert", "map_span_frag", problem);
    out->count_program =
        out->span_program ? gl_program("map_vert", "map_count_frag", problem) : 0;
    if (!out->count_program) {
        gpu_maps_free(out);
        return false;
    }
    glGenFramebuffers(1, &out->frame_buffer);
    out->span = make_texture(texels, n, GL_RG32F);
    for (int k = 0; k < 2 && counts; k++) {
        out->count[k] = make_texture(texels, n, GL_RGBA16F);
    }
    glGenSamplers(1,
                  &out->sampler); /* alpha is of the nearest texel, as in the library */
    glSamplerParameteri(out->sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(out->sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    bool good = gl_check("opacity maps", problem);
    if (!good) {
        gpu_maps_free(out);
    }
    return good;
}

void gpu_maps_free(gpu_maps *maps) {
    glDeleteProgram(maps->span_program);
    glDeleteProgram(maps->count_program);
    glDeleteTextures(1, &maps->span);
    glDeleteTextures(2, maps->count);
    glDeleteFramebuffers(1, &maps->frame_buffer);
    glDeleteSamplers(1, &maps->sampler);
    *maps = (gpu_maps){0};
}

/* ---- drawing ---- */

/* From the mesh to clip space, in the arithmetic of tree/opacity_map.c. */
static void set_frame(GLuint program, const pps_opacity_map *frame) {
    static const char *const name[] = {"across", "up"};
    glUseProgram(program);
    for (int i = 0; i < 2; i++) {
        float scale = (float)(2 / (frame->texels * frame->size[i]));
        float row[4];
        for (int k = 0; k < 3; k++) {
            row[k] = (float)frame->axis[i][k] * scale;
        }
        row[3] = (float)(-2 * frame->low[i] / (frame->texels * frame->size[i]) - 1);
        glUniform4fv(glGetUniformLocation(program, name[i]), 1, row);
    }
    gl_set_vec3(program, "axis", frame->axis[2]);
    gl_set_int(program, "image", 0);
    gl_set_int(program, "spans", 1);
}

static void draw_groups(const gpu_maps *maps, GLuint program, const gpu_mesh *mesh,
                        int wood) {
    glBindVertexArray(mesh->vertices);
    glActiveTexture(GL_TEXTURE0);
    glBindSampler(0, maps->sampler);
    glCullFace(GL_FRONT); /* seen along the light, its lit sides run clockwise */
    for (size_t g = 0; g < mesh->n_groups; g++) {
        const gpu_group *group = &mesh->group[g];
        glBindTexture(GL_TEXTURE_2D, group->texture);
        gl_set_float(program, "alpha_min",
                     group->texture ? group->material->alpha_min : 0);
        gl_set_float(program, "weight", group->leaf ? 1 : wood);
        (group->leaf ? glDisable : glEnable)(GL_CULL_FACE);
        gpu_group_draw(group, 0, 1);
    }
    glDisable(GL_CULL_FACE);
    glBindSampler(0, 0);
    glBindVertexArray(0);
}

void gpu_maps_draw(const gpu_maps *maps, int i, const gpu_mesh *mesh,
                   const pps_opacity_map *frame, int wood) {
    static const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    const float nothing[] = {NOTHING, NOTHING, 0, 0}, none[] = {0, 0, 0, 0};
    glBindFramebuffer(GL_FRAMEBUFFER, maps->frame_buffer);
    glViewport(0, 0, maps->texels, maps->texels);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, targets[0], maps->span, 0, i);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, targets[1], 0, 0, 0);
    glDrawBuffers(1, targets);
    glClearBufferfv(GL_COLOR, 0, nothing);
    glBlendEquation(GL_MAX);
    set_frame(maps->span_program, frame);
    draw_groups(maps, maps->span_program, mesh, 1);
    glBlendEquation(GL_FUNC_ADD);
    if (maps->count[0]) {
        for (int k = 0; k < 2; k++) {
            glFramebufferTextureLayer(GL_FRAMEBUFFER, targets[k], maps->count[k], 0, i);
        }
        glDrawBuffers(2, targets);
        glClearBufferfv(GL_COLOR, 0, none);
        glClearBufferfv(GL_COLOR, 1, none);
        glBlendFunc(GL_ONE, GL_ONE);
        set_frame(maps->count_program, frame);
        gl_set_int(maps->count_program, "map", i);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D_ARRAY, maps->span);
        draw_groups(maps, maps->count_program, mesh, wood ? wood : 1);
    }
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

/* ---- reading ---- */

static void read_layer(const gpu_maps *maps, GLuint texture, int i, GLenum format,
                       float *out) {
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0, i);
    glReadPixels(0, 0, maps->texels, maps->texels, format, GL_FLOAT, out);
}

void gpu_maps_read(const gpu_maps *maps, int i, pps_opacity_map *out) {
    size_t n = (size_t)maps->texels * (size_t)maps->texels;
    float *texel = malloc(4 * n * sizeof *texel);
    if (!texel) {
        return;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, maps->frame_buffer);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, 0, 0, 0);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    read_layer(maps, maps->span, i, GL_RG, texel);
    for (size_t t = 0; t < n; t++) {
        bool met = texel[2 * t] > NOTHING / 10;
        out->first[t] = met ? -texel[2 * t] : INFINITY;
        out->last[t] = met ? texel[2 * t + 1] : -INFINITY;
    }
    for (int k = 0; k < 2 && maps->count[0]; k++) {
        read_layer(maps, maps->count[k], i, GL_RGBA, texel);
        for (size_t t = 0; t < 4 * n; t++) {
            out->count[t / 4 * PPS_OPACITY_LAYERS + (size_t)(4 * k) + t % 4] = texel[t];
        }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    free(texel);
}
