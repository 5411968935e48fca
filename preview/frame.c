/* Frame buffers: of half floats, where there are many samples; else of single precision, so
 * that pixels can be compared with what the library finds.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/frame.h"

#include <stdio.h>

static GLuint make_buffer(int samples, GLenum format, int width, int height,
                          GLenum attachment) {
    GLuint buffer;
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format,
                                     width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
    return buffer;
}

bool frame_create(int width, int height, int samples, frame *out,
                  pps_problem *problem) {
    GLint most = 1;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples = samples < most ? samples : most;
    *out = (frame){.width = width, .height = height, .samples = samples};
    GLenum format = samples > 1 ? GL_RGBA16F : GL_RGBA32F;
    glGenFramebuffers(1, &out->drawn);
    glBindFramebuffer(GL_FRAMEBUFFER, out->drawn);
    out->color = make_buffer(samples, format, width, height, GL_COLOR_ATTACHMENT0);
    out->depth =
        make_buffer(samples, GL_DEPTH_COMPONENT24, width, height, GL_DEPTH_ATTACHMENT);
    bool good = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glGenFramebuffers(1, &out->shown);
    glBindFramebuffer(GL_FRAMEBUFFER, out->shown);
    glGenTextures(1, &out->texture);
    glBindTexture(GL_TEXTURE_2D, out->texture);
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, width, height, 0, GL_RGBA, GL_FLOAT,
                 NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           out->texture, 0);
    good = good &&
           glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE &&
           gl_check("the picture", problem);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!good) {
        snprintf(problem->text, sizeof problem->text,
                 "OpenGL cannot make a picture of %dx%d pixels, %d samples each", width,
                 height, samples);
        frame_free(out);
    }
    return good;
}

void frame_free(frame *f) {
    glDeleteFramebuffers(1, &f->drawn);
    glDeleteFramebuffers(1, &f->shown);
    glDeleteRenderbuffers(1, &f->color);
    glDeleteRenderbuffers(1, &f->depth);
    glDeleteTextures(1, &f->texture);
    *f = (frame){0};
}

void frame_begin(const frame *f) { glBindFramebuffer(GL_FRAMEBUFFER, f->drawn); }

void frame_finish(const frame *f) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, f->drawn);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, f->shown);
    glBlitFramebuffer(0, 0, f->width, f->height, 0, 0, f->width, f->height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void frame_read(const frame *f, pps_picture *out) {
    size_t row = 3 * (size_t)f->width;
    glBindFramebuffer(GL_FRAMEBUFFER, f->shown);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, f->width, f->height, GL_RGB, GL_FLOAT, out->rgb);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    for (int y = 0; y < f->height / 2; y++) { /* pictures run from the top */
        float *a = out->rgb + row * (size_t)y,
              *b = out->rgb + row * (size_t)(f->height - 1 - y);
        for (size_t i = 0; i < row; i++) {
            float swap = a[i];
            a[i] = b[i];
            b[i] = swap;
        }
    }
}
