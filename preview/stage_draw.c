/* Drawing the stage: plants in view from near to far, then sky and ground behind them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "preview/stage_own.h"
#include "preview/stage_view.h"

static const double PI = 3.14159265358979323846;

/* As the shaders read it. */
typedef struct {
    float place[4], turn[2];
    uint32_t own[2];
} instance_row;

typedef struct {
    double distance;
    size_t instance;
    int level;
} seen;

/* ---- instances ---- */

static int nearer(const void *a, const void *b) {
    double x = ((const seen *)a)->distance, y = ((const seen *)b)->distance;
    return (x > y) - (x < y);
}

/* The highest level whose leaves, `near` metres away, stay smaller than `pixel` metres for
 * every metre of distance. */
static int level_of(const stage *s, const pps_instance *at, double near, double pixel) {
    double leaf = s->mesh[at->prototype].leaf_size * at->scale;
    double most = pixel * fmax(near, 0.01) / fmax(leaf, 1e-9); /* times as large */
    return most > 1 ? (int)fmin(floor(2 * log2(most)), GPU_LEVELS - 1) : 0;
}

/* What is in view, from near to far. pixel: how large leaves may become, in metres 1 m away;
 * 0: as they are. */
static size_t find_seen(const stage *s, const view *v, const stage_look *look,
                        double pixel, seen *order) {
    const pps_scene *scene = s->scene;
    size_t n = 0;
    for (size_t i = 0; i < scene->n_instances; i++) {
        const pps_instance *at = &scene->instance[i];
        const double *ball = s->ball[at->prototype];
        double center[3], radius = ball[3] * at->scale, off[3], square = 0;
        pps_instance_point(at, ball, center);
        for (int k = 0; k < 3; k++) {
            off[k] = center[k] - v->eye[k];
            square += off[k] * off[k];
        }
        if (look->all || view_has(v, off, radius)) {
            double distance = sqrt(square);
            order[n++] = (seen){distance, i, level_of(s, at, distance - radius, pixel)};
        }
    }
    qsort(order, n, sizeof *order, nearer);
    return n;
}

/* Rows of a prototype's instances, level by level. */
static void put_instances(stage *s, size_t p, const seen *order, size_t n,
                          instance_row *row) {
    const pps_scene *scene = s->scene;
    size_t m = 0;
    for (int level = 0; level < GPU_LEVELS; level++) {
        size_t before = m;
        for (size_t k = 0; k < n; k++) {
            size_t i = order[k].instance;
            const pps_instance *at = &scene->instance[i];
            if ((size_t)at->prototype == p && order[k].level == level) {
                row[m++] = (instance_row){
                    {(float)at->translation[0], (float)at->translation[1],
                     (float)at->translation[2], (float)at->scale},
                    {(float)cos(at->yaw * PI / 180), (float)sin(at->yaw * PI / 180)},
                    {(uint32_t)i, (uint32_t)scene->first_leaf[i]}};
            }
        }
        s->n_drawn[p][level] = (GLsizei)(m - before);
    }
    glBindBuffer(GL_ARRAY_BUFFER, s->instances[p]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(m * sizeof *row), row, GL_STREAM_DRAW);
}

/* From row number `first` on: OpenGL 3.3 has no other way to begin there. */
static void describe_instances(size_t first) {
    const char *base = (const char *)NULL + first * sizeof(instance_row);
    glVertexAttribPointer(AT_PLACE, 4, GL_FLOAT, GL_FALSE, sizeof(instance_row),
                          base + offsetof(instance_row, place));
    glVertexAttribPointer(AT_TURN, 2, GL_FLOAT, GL_FALSE, sizeof(instance_row),
                          base + offsetof(instance_row, turn));
    glVertexAttribIPointer(AT_OWN, 2, GL_UNSIGNED_INT, sizeof(instance_row),
                           base + offsetof(instance_row, own));
    for (GLuint at = AT_PLACE; at <= AT_OWN; at++) {
        glEnableVertexAttribArray(at);
        glVertexAttribDivisor(at, 1);
    }
}

/* ---- uniforms ---- */

static void set_bands(const pps_scene *scene, GLuint program, const char *name,
                      const double *value, bool on) {
    double rgb[3];
    for (int k = 0; k < 3; k++) {
        int b = stage_band(scene, k);
        rgb[k] = on && b >= 0 ? value[b] : 0;
    }
    gl_set_vec3(program, name, rgb);
}

static void set_sky(const stage *s, GLuint program) {
    pps_directions directions = pps_directions_22();
    float to[24][3] = {{0}}, part[24][3] = {{0}};
    for (int j = 0; j < directions.n; j++) {
        double z = directions.to[j][2];
        bool dark =
            (z < 0 && s->scene->ground.present) || !(s->options.sources & PPS_SKY);
        for (int k = 0; k < 3; k++) {
            int b = stage_band(s->scene, k);
            to[j][k] = (float)directions.to[j][k];
            part[j][k] = b < 0 || dark
                             ? 0
                             : (float)(4 * PI / directions.n *
                                       pps_sky_radiance(&s->scene->sky, b, z));
        }
    }
    gl_set_int(program, "n_directions", directions.n);
    glUniform3fv(glGetUniformLocation(program, "direction"), 24, to[0]);
    glUniform3fv(glGetUniformLocation(program, "part"), 24, part[0]);
}

static void set_common(const stage *s, GLuint program, const pps_camera *camera,
                       const view *v) {
    stage_use_sun(&s->sun, program);
    glUniformMatrix4fv(glGetUniformLocation(program, "to_clip"), 1, GL_FALSE,
                       v->to_clip);
    gl_set_vec3(program, "eye", camera->eye);
    gl_set_vec3(program, "to_sun", s->scene->sun.to);
    set_bands(s->scene, program, "sun", s->scene->sun.irradiance,
              s->options.sources & PPS_SUN);
}

/* The closed form, for leaves of a prototype. Its albedo is kept 1e-7 away from 1, where
 * single precision would lose more than that moves. */
static void set_slab(const stage *s, GLuint program, size_t prototype) {
    double lambda[3];
    bool on = stage_by_point(s) && s->options.sources & PPS_SUN_INDIRECT;
    set_bands(s->scene, program, "sun_scattered", s->scene->sun.irradiance, on);
    if (!on) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        int b = stage_band(s->scene, k);
        const pps_leaf_optics *o = &s->scene->prototype[prototype].optics;
        double absorbed = b < 0 ? 1 : 1 - pps_leaf_albedo(o, b);
        lambda[k] = s->system->slab_m * sqrt(fmax(absorbed, 1e-7));
    }
    gl_set_float(program, "slab_m", s->system->slab_m);
    gl_set_float(program, "slab_kappa", s->system->slab_kappa);
    gl_set_vec3(program, "slab_lambda", lambda);
}

static void set_optics(const stage *s, GLuint program, size_t prototype) {
    static const char *const name[2][2] = {{"reflectance[0]", "reflectance[1]"},
                                           {"transmittance[0]", "transmittance[1]"}};
    const pps_leaf_optics *o = &s->scene->prototype[prototype].optics;
    for (int face = 0; face < 2; face++) {
        set_bands(s->scene, program, name[0][face], o->reflectance[face], true);
        set_bands(s->scene, program, name[1][face], o->transmittance[face], true);
    }
}

/* ---- drawing ---- */

static void draw_group(const stage *s, GLuint program, size_t p,
                       const gpu_group *group) {
    const double mean[] = {(double)group->mean[0], (double)group->mean[1],
                           (double)group->mean[2]};
    glActiveTexture(GL_TEXTURE0 + UNIT_IMAGE);
    glBindTexture(GL_TEXTURE_2D, group->texture ? group->texture : s->white);
    gl_set_vec3(program, "image_mean", mean);
    gl_set_vec3(program, "color", group->material->color);
    gl_set_float(program, "alpha_min", group->texture ? group->material->alpha_min : 0);
    size_t first = 0;
    for (int level = 0; level < GPU_LEVELS; level++) {
        GLsizei n = s->n_drawn[p][level];
        if (n > 0) {
            describe_instances(first);
            gl_set_float(program, "grow", group->grow[level]);
            gpu_group_draw(group, level, n);
        }
        first += (size_t)n;
    }
}

static void draw_prototype(const stage *s, GLuint program, size_t p) {
    const gpu_mesh *mesh = &s->mesh[p];
    glBindVertexArray(mesh->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, s->instances[p]);
    for (size_t g = 0; g < mesh->n_groups; g++) {
        draw_group(s, program, p, &mesh->group[g]);
    }
    glBindVertexArray(0);
}

/* Depths first: then only what is seen is shaded, and shading is what costs. */
static void draw_depths(const stage *s, const view *v) {
    GLuint program = s->depth_program;
    glUseProgram(program);
    glUniformMatrix4fv(glGetUniformLocation(program, "to_clip"), 1, GL_FALSE,
                       v->to_clip);
    gl_set_int(program, "image", UNIT_IMAGE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    for (size_t p = 0; p < s->scene->n_prototypes; p++) {
        draw_prototype(s, program, p);
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

static void draw_plants(const stage *s, const pps_camera *camera, const view *v,
                        const stage_look *look) {
    GLuint program = s->plant_program;
    const double around[] = {(double)s->around[0], (double)s->around[1],
                             (double)s->around[2]};
    set_common(s, program, camera, v);
    set_sky(s, program);
    gl_table_use(&s->cell_of, program, "cell_of", UNIT_CELLS);
    gl_table_use(&s->scattered, program, "scattered", UNIT_SCATTERED);
    gl_table_use(&s->sky_shares, program, "sky_shares", UNIT_SKY);
    gl_table_use(&s->leaf_light, program, "leaf_light", UNIT_LEAVES);
    gl_set_int(program, "per_leaf", !stage_cells_known(s));
    gl_set_int(program, "image", UNIT_IMAGE);
    gl_set_vec3(program, "around", around);
    gl_set_int(program, "false_color", (int)look->show);
    gl_set_float(program, "relief", look->show == SHOW_LIGHT ? look->relief : 0);
    gl_set_float(program, "false_top", 1.5 * PI / stage_exposure(s));
    glDepthFunc(GL_EQUAL);
    for (size_t p = 0; p < s->scene->n_prototypes; p++) {
        set_optics(s, program, p);
        set_slab(s, program, p);
        gl_set_float(program, "leaf_size", s->mesh[p].leaf_size);
        draw_prototype(s, program, p);
    }
    glDepthFunc(GL_LESS);
}

static void set_axes(const view *v, GLuint program) {
    double right[3], up[3];
    for (int i = 0; i < 3; i++) {
        right[i] = v->right[i] * v->tangent * v->aspect;
        up[i] = v->up[i] * v->tangent;
    }
    gl_set_vec3(program, "right", right);
    gl_set_vec3(program, "up", up);
    gl_set_vec3(program, "back", v->back);
}

static void set_sky_colors(const pps_scene *scene, GLuint program) {
    set_bands(scene, program, "zenith", scene->sky.zenith, true);
    set_bands(scene, program, "horizon", scene->sky.horizon, true);
    set_bands(scene, program, "below", scene->sky.below, true);
}

static void draw_sky(const stage *s, const view *v) {
    glUseProgram(s->sky_program);
    set_axes(v, s->sky_program);
    set_sky_colors(s->scene, s->sky_program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_ground(const stage *s, const pps_camera *camera, const view *v,
                        int width, int height) {
    GLuint program = s->ground_program;
    const pps_scene *scene = s->scene;
    set_common(s, program, camera, v);
    set_axes(v, program);
    set_sky_colors(scene, program);
    set_bands(scene, program, "ground_reflectance", scene->ground.reflectance, true);
    glUniform2f(glGetUniformLocation(program, "extent"), (float)width, (float)height);
    gl_set_float(program, "sky_on", s->options.sources & PPS_SKY ? 1 : 0);
    gl_set_float(program, "ground_height", scene->ground.height);
    gl_set_int(program, "ground_list", (int)scene->n_instances);
    glActiveTexture(GL_TEXTURE0 + UNIT_OPEN);
    glBindTexture(GL_TEXTURE_2D, s->openness);
    gl_set_int(program, "openness", UNIT_OPEN);
    glUniform4fv(glGetUniformLocation(program, "open_frame"), 1, s->open_frame);
    glEnable(GL_DEPTH_CLAMP); /* it goes on beyond the far plane */
    glDrawArrays(GL_TRIANGLES, 0, 12);
    glDisable(GL_DEPTH_CLAMP);
}

/* The sky fills what plants left, on the far plane; the ground lies before it. */
static void draw_backdrop(const stage *s, const pps_camera *camera, const view *v,
                          int width, int height) {
    glDepthFunc(GL_LEQUAL); /* what is beyond the far plane lies on it */
    glBindVertexArray(s->empty);
    draw_sky(s, v);
    if (s->scene->ground.present) {
        draw_ground(s, camera, v, width, height);
    }
    glBindVertexArray(0);
    glDepthFunc(GL_LESS);
}

void stage_draw(stage *s, const pps_camera *camera, int width, int height,
                const stage_look *look) {
    size_t n = s->scene->n_instances;
    view v;
    seen *order = malloc((n + 1) * sizeof *order);
    instance_row *row = malloc((n + 1) * sizeof *row);
    view_set(&s->box, camera, (double)width / height, &v);
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (order && row) {
        double pixel = look->detail * 2 * v.tangent / height;
        n = find_seen(s, &v, look, pixel, order);
        for (size_t p = 0; p < s->scene->n_prototypes; p++) {
            put_instances(s, p, order, n, row);
        }
        draw_depths(s, &v);
        draw_plants(s, camera, &v, look);
    }
    draw_backdrop(s, camera, &v, width, height);
    free(order);
    free(row);
}
