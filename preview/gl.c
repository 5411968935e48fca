/* Thin help over OpenGL.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/gl.h"

#include <stdio.h>
#include <string.h>

/* ---- programs ---- */

static const struct {
    const char *name, *text;
} shaders[] = {
#include "shaders.inc" /* made by CMake: every file of shaders/ */
};

static const char *shader_text(const char *name) {
    for (size_t i = 0; i < sizeof shaders / sizeof *shaders; i++) {
        if (strcmp(shaders[i].name, name) == 0) {
            return shaders[i].text;
        }
    }
    return NULL;
}

/* The text of a shader without its version, which comes once and first. */
static const char *part_text(const char *name) {
    static const char version[] = "#version 330 core\n";
    const char *text = shader_text(name);
    const char *after = text ? strstr(text, version) : NULL;
    return after ? after + sizeof version - 1 : text;
}

/* `name` is a shader's, or "PART+PART+SHADER". */
static GLuint compile(GLenum kind, const char *name, pps_problem *problem) {
    enum { PARTS_MOST = 6 };
    const char *text[PARTS_MOST + 1] = {"#version 330 core\n"};
    GLsizei n = 1;
    for (const char *rest = name; rest && n <= PARTS_MOST; n++) {
        char part[40];
        const char *plus = strchr(rest, '+');
        snprintf(part, sizeof part, "%.*s",
                 plus ? (int)(plus - rest) : (int)strlen(rest), rest);
        text[n] = part_text(part);
        rest = plus ? plus + 1 : NULL;
    }
    GLuint shader = glCreateShader(kind);
    GLint good = 0;
    glShaderSource(shader, n, text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        char log[400];
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        snprintf(problem->text, sizeof problem->text, "shader %s: %s", name, log);
        glDeleteShader(shader);
        return 0;
    }
    return shader;
}

GLuint gl_program(const char *vertex, const char *fragment, pps_problem *problem) {
    GLuint v = compile(GL_VERTEX_SHADER, vertex, problem);
    GLuint f = v ? compile(GL_FRAGMENT_SHADER, fragment, problem) : 0;
    GLuint program = f ? glCreateProgram() : 0;
    if (program) {
        GLint good = 0;
        glAttachShader(program, v);
        glAttachShader(program, f);
        glLinkProgram(program);
        glGetProgramiv(program, GL_LINK_STATUS, &good);
        if (!good) {
            char log[400];
            glGetProgramInfoLog(program, sizeof log, NULL, log);
            snprintf(problem->text, sizeof problem->text, "shaders %s, %s: %s", vertex,
                     fragment, log);
            glDeleteProgram(program);
            program = 0;
        }
    }
    glDeleteShader(v); /* kept by the program as long as it lives; 0 is fine */
    glDeleteShader(f);
    return program;
}

void gl_set_int(GLuint program, const char *name, int value) {
    glUniform1i(glGetUniformLocation(program, name), value);
}

void gl_set_float(GLuint program, const char *name, double value) {
    glUniform1f(glGetUniformLocation(program, name), (float)value);
}

void gl_set_vec3(GLuint program, const char *name, const double value[3]) {
    glUniform3f(glGetUniformLocation(program, name), (float)value[0], (float)value[1],
                (float)value[2]);
}

void gl_set_vec4(GLuint program, const char *name, const double value[4]) {
    glUniform4f(glGetUniformLocation(program, name), (float)value[0], (float)value[1],
                (float)value[2], (float)value[3]);
}

/* ---- tables ---- */

void gl_table_fill(gl_table *table, GLenum format, const void *data, size_t bytes) {
    if (!table->buffer) {
        glGenBuffers(1, &table->buffer);
        glGenTextures(1, &table->texture);
    }
    glBindBuffer(GL_TEXTURE_BUFFER, table->buffer);
    if (table->bytes == bytes) {
        glBufferSubData(GL_TEXTURE_BUFFER, 0, (GLsizeiptr)bytes, data);
    } else {
        glBufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)bytes, data, GL_DYNAMIC_DRAW);
    }
    table->bytes = bytes;
    glBindTexture(GL_TEXTURE_BUFFER, table->texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, table->buffer);
}

void gl_table_free(gl_table *table) {
    glDeleteTextures(1, &table->texture);
    glDeleteBuffers(1, &table->buffer);
    *table = (gl_table){0};
}

void gl_table_use(const gl_table *table, GLuint program, const char *name, int unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_BUFFER, table->texture);
    gl_set_int(program, name, unit);
}

/* ---- what failed ---- */

bool gl_check(const char *what, pps_problem *problem) {
    GLenum error = glGetError();
    if (error == GL_NO_ERROR) {
        return true;
    }
    snprintf(problem->text, sizeof problem->text, "OpenGL failed at %s: %s", what,
             error == GL_OUT_OF_MEMORY ? "out of memory" : "a wrong call");
    return false;
}

bool gl_good_enough(pps_problem *problem) {
    int version = epoxy_gl_version();
    if (!epoxy_is_desktop_gl() || version < 33) {
        snprintf(problem->text, sizeof problem->text,
                 "OpenGL 3.3 is needed; this driver has %d.%d", version / 10,
                 version % 10);
        return false;
    }
    return true;
}
