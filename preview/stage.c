/* Opening a scene, and the steps of its light.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "preview/stage_own.h"

static const double PI = 3.14159265358979323846;

static double read_clock(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double now(void) { return read_clock(CLOCK_MONOTONIC); }

int stage_band(const pps_scene *scene, int color) {
    return scene->n_bands == 1 ? 0 : color < scene->n_bands ? color : -1;
}

bool stage_cells_known(const stage *s) {
    return s->options.way == STAGE_GRID || s->options.way == STAGE_INSTANCES;
}

bool stage_counts(const stage *s) { return s->system && s->system->by_count; }

bool stage_by_point(const stage *s) {
    return s->options.by_point && s->system && s->system->slab_kappa > 0;
}

static bool fail(pps_status status, const char *what, pps_problem *problem) {
    if (status) {
        snprintf(problem->text, sizeof problem->text, "%s: %s", what,
                 pps_status_string(status));
    }
    return status != PPS_OK;
}

uint64_t stage_rays(const pps_scene *scene, uint64_t asked) {
    enum { A_LEAF = 32, LEAST = 1000000 };
    uint64_t enough = (uint64_t)A_LEAF * scene->n_leaves;
    return asked ? asked : enough > LEAST ? enough : LEAST;
}

/* ---- progress ---- */

static void begin_step(const stage *s, int step) {
    stage_progress *progress = s->options.progress;
    if (progress) {
        atomic_store(&progress->percent, -1);
        atomic_store(&progress->step, step);
    }
}

static bool keep_going(void *user, uint64_t done, uint64_t total) {
    stage_progress *progress = user;
    atomic_store(&progress->percent, (int)(100 * done / total));
    return !atomic_load(&progress->cancelled);
}

/* ---- light of leaves ---- */

static pps_status light_leaves(stage *s) {
    pps_irradiance *light = NULL;
    pps_status status;
    if (s->options.way == STAGE_MONTE_CARLO) {
        pps_trace_options trace = {.rays = stage_rays(s->scene, s->options.rays),
                                   .sources = s->options.sources,
                                   .threads = s->options.threads,
                                   .progress = s->options.progress ? keep_going : NULL,
                                   .user = s->options.progress};
        status = pps_trace_light(s->scene, &trace, &light, NULL);
    } else {
        status = pps_irradiance_create(s->scene, false, &light);
        if (!status) {
            unsigned sources = s->options.sources & s->options.model->sources;
            status = pps_leaf_light(s->scene, s->attenuation, PPS_SUN_UNBIASED, sources,
                                    light);
        }
    }
    if (status) {
        pps_irradiance_free(light);
        return status;
    }
    pps_irradiance_free(s->leaves);
    s->leaves = light;
    return PPS_OK;
}

static pps_status prepare_leaves(stage *s) {
    if (s->options.way != STAGE_LEAVES) {
        return PPS_OK;
    }
    pps_attenuation_options options = {.threads = s->options.threads,
                                       .apart = s->options.apart};
    return pps_leaf_attenuation_create(s->scene, &options, &s->attenuation);
}

/* ---- steps ---- */

static pps_system_options system_options(const stage_options *o) {
    pps_system_options options = {.way = o->way == STAGE_GRID ? PPS_SYSTEM_GRID
                                                              : PPS_SYSTEM_INSTANCES,
                                  .model = o->way == STAGE_GRID ? o->model : NULL,
                                  .by_point = o->by_point,
                                  .threads = o->threads};
    options.light.compensate = o->compensate;
    return options;
}

bool stage_takes(const pps_scene *scene, const stage_options *options,
                 pps_problem *problem) {
    if (options->way != STAGE_INSTANCES) {
        return true;
    }
    pps_system_options wish = system_options(options);
    pps_system *system;
    pps_status status = pps_system_create(scene, &wish, &system);
    pps_system_free(system);
    if (status == PPS_ERR_UNSUPPORTED) {
        strcpy(problem->text, "the model sppg takes scenes that do not repeat, of "
                              "plants turned by multiples of 72 degrees");
    }
    return status != PPS_ERR_UNSUPPORTED;
}

static bool prepare_system(stage *s, pps_problem *problem) {
    pps_system_options options = system_options(&s->options);
    begin_step(s, 1);
    if (fail(pps_system_create(s->scene, &options, &s->system), "the rendering system",
             problem) ||
        fail(pps_system_construct_cells(s->system), "step 1, cells", problem)) {
        return false;
    }
    begin_step(s, 2);
    if (fail(pps_system_map_directions(s->system), "step 2, maps", problem)) {
        return false;
    }
    begin_step(s, 3);
    return !fail(pps_system_find_g(s->system), "step 3, G-factors", problem);
}

static bool find_sky(stage *s, pps_problem *problem) {
    begin_step(s, 4);
    return !s->system ||
           !fail(pps_system_light_sky(s->system), "step 4, light of the sky", problem);
}

static bool find_sun(stage *s, pps_problem *problem) {
    double start = now();
    begin_step(s, 5);
    pps_status status = s->system ? pps_system_light_sun(s->system) : light_leaves(s);
    s->seconds[4] = now() - start;
    return !fail(status, "step 5, light of the sun", problem);
}

/* Light that was found, into tables, and the sun's maps. */
static bool upload_light(stage *s, pps_problem *problem) {
    double start = now();
    pps_status status = stage_fill_light(s);
    s->seconds[4] += now() - start;
    start = now();
    if (!status) {
        status = stage_fill_sun(s, s->scene->sun.to, false, &s->sun);
        glFinish();
    }
    s->seconds[5] = now() - start;
    return !fail(status, "step 5, light of the sun", problem) &&
           gl_check("the sun's maps", problem);
}

static void note_times(stage *s) {
    for (int i = 0; s->system && i < 4; i++) {
        s->seconds[i] = s->system->seconds[i];
    }
}

bool stage_light_sun(stage *s, pps_problem *problem) {
    return find_sun(s, problem) && upload_light(s, problem);
}

bool stage_light_sky(stage *s, pps_problem *problem) {
    if (!find_sky(s, problem)) {
        return false;
    }
    note_times(s);
    return stage_light_sun(s, problem);
}

static bool prepare_all(stage *s, pps_problem *problem) {
    double start = now();
    begin_step(s, 1);
    if (!stage_cells_known(s)) {
        if (fail(prepare_leaves(s), "the light of leaves", problem)) {
            return false;
        }
        s->seconds[0] = now() - start;
    } else if (!prepare_system(s, problem)) {
        return false;
    }
    if (!find_sky(s, problem)) {
        return false;
    }
    note_times(s);
    return find_sun(s, problem);
}

bool stage_prepare(stage *s, pps_problem *problem) {
    double wall = now(), cpu = read_clock(CLOCK_PROCESS_CPUTIME_ID);
    bool good = prepare_all(s, problem);
    s->cores = (read_clock(CLOCK_PROCESS_CPUTIME_ID) - cpu) / (now() - wall);
    return good;
}

/* ---- life ---- */

/* A texture of one texel. */
static GLuint plain_texture(void) {
    static const GLubyte white[] = {255, 255, 255, 255};
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, white);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    return texture;
}

static void find_ball(const pps_mesh *mesh, double ball[4]) {
    pps_mesh_size size;
    double square = 0;
    pps_mesh_measure(mesh, &size);
    for (int k = 0; k < 3; k++) {
        ball[k] = (size.low[k] + size.high[k]) / 2;
        square += pow((size.high[k] - size.low[k]) / 2, 2);
    }
    ball[3] = sqrt(square);
}

static pps_status load_meshes(stage *s) {
    const pps_scene *scene = s->scene;
    s->mesh = calloc(scene->n_prototypes, sizeof *s->mesh);
    s->instances = calloc(scene->n_prototypes, sizeof *s->instances);
    s->n_drawn = calloc(scene->n_prototypes, sizeof *s->n_drawn);
    s->ball = calloc(scene->n_prototypes, sizeof *s->ball);
    bool room = s->mesh && s->instances && s->n_drawn && s->ball;
    pps_status status = room ? PPS_OK : PPS_ERR_MEMORY;
    pps_box leaves;
    pps_scene_box(scene, &s->box, &leaves);
    for (size_t p = 0; p < scene->n_prototypes && !status; p++) {
        status = gpu_mesh_create(scene->prototype[p].mesh, &s->mesh[p]);
        find_ball(scene->prototype[p].mesh, s->ball[p]);
        glGenBuffers(1, &s->instances[p]);
    }
    for (size_t i = 0; i < scene->n_instances; i++) {
        s->n_triangles +=
            scene->prototype[scene->instance[i].prototype].mesh->n_triangles;
    }
    return status;
}

static bool compile(const char *vertex, const char *fragment, GLuint *out,
                    pps_problem *problem) {
    *out = gl_program(vertex, fragment, problem);
    return *out != 0;
}

static bool compile_all(stage *s, pps_problem *problem) {
    bool counts = stage_counts(s);
    const char *plant = counts ? "by_count+sun+spp+leaf_light+relief+plant_frag"
                               : "by_opacity+sun+spp+leaf_light+relief+plant_frag";
    const char *ground =
        counts ? "by_count+sun+ground_frag" : "by_opacity+sun+ground_frag";
    return compile("plant_vert", "depth_frag", &s->depth_program, problem) &&
           compile("plant_vert", plant, &s->plant_program, problem) &&
           compile("ground_vert", ground, &s->ground_program, problem) &&
           compile("screen_vert", "sky_frag", &s->sky_program, problem);
}

bool stage_upload(stage *s, pps_problem *problem) {
    size_t n_poses = 0;
    glGenVertexArrays(1, &s->empty);
    s->white = plain_texture();
    return !fail(load_meshes(s), "the plants' meshes", problem) &&
           !fail(stage_fill_static(s), "the cells' tables", problem) &&
           compile_all(s, problem) &&
           !fail(stage_count_poses(s->scene, &n_poses), "the sun's maps", problem) &&
           gpu_maps_create(s->options.map_texels, (int)n_poses, stage_counts(s),
                           &s->sun.maps, problem) &&
           upload_light(s, problem) &&
           (!s->scene->ground.present || stage_open_ground(s, problem));
}

stage *stage_create(pps_scene *scene, const stage_options *options,
                    pps_problem *problem) {
    stage *s = calloc(1, sizeof *s);
    if (fail(s ? PPS_OK : PPS_ERR_MEMORY, "the scene", problem)) {
        return NULL;
    }
    s->scene = scene;
    s->options = *options;
    return s;
}

stage *stage_open(pps_scene *scene, const stage_options *options,
                  pps_problem *problem) {
    stage *s = stage_create(scene, options, problem);
    if (s && !(stage_prepare(s, problem) && stage_upload(s, problem))) {
        stage_close(s);
        return NULL;
    }
    return s;
}

void stage_close(stage *s) {
    if (!s) {
        return;
    }
    for (size_t p = 0; s->mesh && p < s->scene->n_prototypes; p++) {
        gpu_mesh_free(&s->mesh[p]);
    }
    if (s->instances) {
        glDeleteBuffers((GLsizei)s->scene->n_prototypes, s->instances);
    }
    stage_sun_free(&s->sun);
    gl_table *table[] = {&s->cell_of, &s->scattered, &s->sky_shares, &s->leaf_light};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        gl_table_free(table[i]);
    }
    glDeleteTextures(1, &s->openness);
    glDeleteTextures(1, &s->white);
    glDeleteVertexArrays(1, &s->empty);
    glDeleteProgram(s->depth_program);
    glDeleteProgram(s->plant_program);
    glDeleteProgram(s->ground_program);
    glDeleteProgram(s->sky_program);
    pps_system_free(s->system);
    pps_irradiance_free(s->leaves);
    free(s->attenuation);
    free(s->mesh);
    free(s->instances);
    free(s->n_drawn);
    free(s->ball);
    free(s);
}

double stage_exposure(const stage *s) {
    const pps_scene *scene = s->scene;
    double most = 0;
    for (int b = 0; b < scene->n_bands; b++) {
        double sky = PI * (scene->sky.horizon[b] + 2 * scene->sky.zenith[b]) / 3;
        double sun = scene->sun.irradiance[b] * fmax(scene->sun.to[2], 0.35);
        most = fmax(most, sun + sky);
    }
    return most > 0 ? PI / most : 1;
}
