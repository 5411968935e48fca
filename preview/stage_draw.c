/* Drawing the stage: plants in view from near to far, then sky and ground behind them.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "preview/stage_own.h"

static const double PI = 3.14159265358979323846;

/* The camera's axes, and the matrix from the scene to clip space. */
typedef struct {
    double right[3], up[3], back[3], tangent, aspect;
    float to_clip[16]; /* by columns */
} view;

/* As the shaders read it. */
typedef struct {
    float place[4], turn[2];
    uint32_t own[2];
} instance_row;

typedef struct {
    double distance;
    size_t instance;
} seen;

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static void normalize(double v[3]) {
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3 && length > 0; i++) {
        v[i] /= length;
    }
}

/* ---- the camera ---- */

/* Near and far planes about the whole scene. */
static void depth_range(const pps_box *all, const pps_camera *camera,
                        const double back[3], double *near, double *far) {
    double most = 0;
    for (int corner = 0; corner < 8; corner++) {
        double off[3];
        for (int i = 0; i < 3; i++) {
            off[i] = (corner >> i & 1 ? all->high[i] : all->low[i]) - camera->eye[i];
        }
        most = fmax(most, -dot(off, back));
    }
    *far = fmax(4 * most, 100);
    *near = fmax(most / 1000, 0.02);
}

static void set_view(const pps_box *box, const pps_camera *camera, double aspect,
                     view *v) {
    double near, far;
    for (int i = 0; i < 3; i++) {
        v->back[i] = camera->eye[i] - camera->target[i];
    }
    normalize(v->back);
    cross(camera->up, v->back, v->right);
    normalize(v->right);
    cross(v->back, v->right, v->up);
    v->tangent = tan(camera->field_of_view * PI / 360);
    v->aspect = aspect;
    depth_range(box, camera, v->back, &near, &far);
    const double *row[] = {v->right, v->up, v->back};
    const double scale[] = {1 / (v->tangent * aspect), 1 / v->tangent,
                            (far + near) / (near - far)};
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            /* In front of the eye `back` is negative, clip z and w grow. */
            v->to_clip[4 * c + r] = (float)(scale[r] * row[r][c]);
            v->to_clip[4 * c + 3] = (float)-v->back[c];
        }
        v->to_clip[12 + r] = (float)(-scale[r] * dot(row[r], camera->eye));
    }
    v->to_clip[14] += (float)(2 * far * near / (near - far));
    v->to_clip[15] = (float)dot(v->back, camera->eye);
}

/* ---- instances ---- */

static int nearer(const void *a, const void *b) {
    double x = ((const seen *)a)->distance, y = ((const seen *)b)->distance;
    return (x > y) - (x < y);
}

/* A ball against the four sides of the view and the eye's plane. */
static bool in_view(const view *v, const double off[3], double radius) {
    double ahead = -dot(off, v->back);
    double half[] = {v->tangent * v->aspect, v->tangent};
    double side[] = {fabs(dot(off, v->right)), fabs(dot(off, v->up))};
    bool in = ahead > -radius;
    for (int i = 0; i < 2; i++) {
        in = in && side[i] - half[i] * ahead < radius * sqrt(1 + half[i] * half[i]);
    }
    return in;
}

static void put_instances(stage *s, const pps_camera *camera, const view *v,
                          seen *order, instance_row *row) {
    const pps_scene *scene = s->scene;
    size_t n = 0;
    for (size_t i = 0; i < scene->n_instances; i++) {
        const double *ball = s->ball[scene->instance[i].prototype];
        double center[3], radius = ball[3] * scene->instance[i].scale, off[3];
        pps_instance_point(&scene->instance[i], ball, center);
        for (int k = 0; k < 3; k++) {
            off[k] = center[k] - camera->eye[k];
        }
        if (in_view(v, off, radius)) {
            order[n++] = (seen){dot(off, off), i};
        }
    }
    qsort(order, n, sizeof *order, nearer);
    for (size_t p = 0; p < scene->n_prototypes; p++) {
        size_t m = 0;
        for (size_t k = 0; k < n; k++) {
            size_t i = order[k].instance;
            const pps_instance *at = &scene->instance[i];
            if ((size_t)at->prototype == p) {
                row[m++] = (instance_row){
                    {(float)at->translation[0], (float)at->translation[1],
                     (float)at->translation[2], (float)at->scale},
                    {(float)cos(at->yaw * PI / 180), (float)sin(at->yaw * PI / 180)},
                    {(uint32_t)i, (uint32_t)scene->first_leaf[i]}};
            }
        }
        s->n_drawn[p] = (GLsizei)m;
        glBindBuffer(GL_ARRAY_BUFFER, s->instances[p]);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(m * sizeof *row), row,
                     GL_STREAM_DRAW);
    }
}

static void describe_instances(void) {
    const char *base = NULL;
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
    stage_use_sun(&s->sun, program, stage_counts(s));
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

static void draw_prototype(const stage *s, GLuint program, size_t p) {
    const gpu_mesh *mesh = &s->mesh[p];
    set_optics(s, program, p);
    set_slab(s, program, p);
    glBindVertexArray(mesh->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, s->instances[p]);
    describe_instances();
    for (size_t g = 0; g < mesh->n_groups && s->n_drawn[p] > 0; g++) {
        const gpu_group *group = &mesh->group[g];
        const double mean[] = {(double)group->mean[0], (double)group->mean[1],
                               (double)group->mean[2]};
        glActiveTexture(GL_TEXTURE0 + UNIT_IMAGE);
        glBindTexture(GL_TEXTURE_2D, group->texture ? group->texture : s->white);
        gl_set_vec3(program, "image_mean", mean);
        gl_set_vec3(program, "color", group->material->color);
        gl_set_float(program, "alpha_min",
                     group->texture ? group->material->alpha_min : 0);
        glDrawArraysInstanced(GL_TRIANGLES, group->first, group->count, s->n_drawn[p]);
    }
    glBindVertexArray(0);
}

static void draw_plants(const stage *s, const pps_camera *camera, const view *v,
                        stage_show show) {
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
    gl_set_int(program, "false_color", (int)show);
    gl_set_float(program, "false_top", 1.5 * PI / stage_exposure(s));
    for (size_t p = 0; p < s->scene->n_prototypes; p++) {
        draw_prototype(s, program, p);
    }
}

static void draw_backdrop(const stage *s, const pps_camera *camera, const view *v) {
    GLuint program = s->backdrop_program;
    const pps_scene *scene = s->scene;
    double right[3], up[3];
    for (int i = 0; i < 3; i++) {
        right[i] = v->right[i] * v->tangent * v->aspect;
        up[i] = v->up[i] * v->tangent;
    }
    set_common(s, program, camera, v);
    gl_set_vec3(program, "right", right);
    gl_set_vec3(program, "up", up);
    gl_set_vec3(program, "back", v->back);
    set_bands(scene, program, "zenith", scene->sky.zenith, true);
    set_bands(scene, program, "horizon", scene->sky.horizon, true);
    set_bands(scene, program, "below", scene->sky.below, true);
    set_bands(scene, program, "ground_reflectance", scene->ground.reflectance, true);
    gl_set_float(program, "sky_on", s->options.sources & PPS_SKY ? 1 : 0);
    gl_set_int(program, "ground_present", scene->ground.present);
    gl_set_float(program, "ground_height", scene->ground.height);
    gl_set_int(program, "ground_list", (int)scene->n_instances);
    glActiveTexture(GL_TEXTURE0 + UNIT_OPEN);
    glBindTexture(GL_TEXTURE_2D, s->openness);
    gl_set_int(program, "openness", UNIT_OPEN);
    glUniform4fv(glGetUniformLocation(program, "open_frame"), 1, s->open_frame);
    glDepthFunc(GL_LEQUAL); /* the sky lies on the far plane */
    glBindVertexArray(s->empty);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glDepthFunc(GL_LESS);
}

void stage_draw(stage *s, const pps_camera *camera, int width, int height,
                stage_show show) {
    size_t n = s->scene->n_instances;
    view v;
    seen *order = malloc((n + 1) * sizeof *order);
    instance_row *row = malloc((n + 1) * sizeof *row);
    set_view(&s->box, camera, (double)width / height, &v);
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    if (order && row) {
        put_instances(s, camera, &v, order, row);
        draw_plants(s, camera, &v, show);
    }
    draw_backdrop(s, camera, &v);
    free(order);
    free(row);
}
