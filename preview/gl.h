/* OpenGL 3.3 core: programs, textures that hold tables, and what failed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_GL_H
#define PREVIEW_GL_H

#include <stdbool.h>
#include <stddef.h>

#include <epoxy/gl.h>

#include <ppscat/tree/mesh.h>

/* A program of two shaders by name ("map_vert", "map_span_frag"), or by the names of
 * parts and a shader ("sun+spp+plant_frag"); 0: the problem says what the driver said. */
GLuint gl_program(const char *vertex, const char *fragment, pps_problem *problem);

/* Uniforms by name; a name that the driver dropped is skipped. */
void gl_set_int(GLuint program, const char *name, int value);
void gl_set_float(GLuint program, const char *name, double value);
void gl_set_vec3(GLuint program, const char *name, const double value[3]);
void gl_set_vec4(GLuint program, const char *name, const double value[4]);

/* A table that shaders read with texelFetch on a samplerBuffer. */
typedef struct {
    GLuint buffer, texture;
    size_t bytes;
} gl_table;

/* Fill a table, made when it is zero; `format` is that of one texel (GL_RGBA32F ...). */
void gl_table_fill(gl_table *table, GLenum format, const void *data, size_t bytes);
void gl_table_free(gl_table *table);

/* Bind a table to a texture unit and tell the program. */
void gl_table_use(const gl_table *table, GLuint program, const char *name, int unit);

/* Whether all calls since the last check succeeded; else the problem says which kind. */
bool gl_check(const char *what, pps_problem *problem);

/* Whether the context is at least OpenGL 3.3. */
bool gl_good_enough(pps_problem *problem);

#endif
