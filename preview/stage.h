/* A scene on the GPU, with the light that the rendering system finds for it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_STAGE_H
#define PREVIEW_STAGE_H

#include <stdatomic.h>

#include <ppscat/tree/picture.h>
#include <ppscat/tree/system.h>

#include "preview/gpu_map.h"

/* What lights the leaves. */
typedef enum {
    STAGE_GRID,      /* pps_system, over the scene's grid */
    STAGE_INSTANCES, /* pps_system, the paper's own way */
    STAGE_LEAVES,    /* a model without cells */
    STAGE_MONTE_CARLO
} stage_way;

/* How far the opening of a stage is, for another thread to look at and to end it. */
typedef struct {
    atomic_int step;       /* of the system's, 1 to 5; 0: not begun */
    atomic_int percent;    /* of a step that counts; -1: it does not */
    atomic_bool cancelled; /* set it: Monte Carlo ends early, and opening fails */
} stage_progress;

typedef struct {
    stage_way way;
    const pps_light_model *model; /* of GRID and LEAVES */
    pps_compensation compensate;
    unsigned sources; /* pps_light_source, added */
    bool apart;       /* LEAVES: plants do not shade one another */
    bool by_point;    /* models by counts: the sun's scattered light pixel by pixel */
    int map_texels;   /* of the sun's maps that shaders read */
    uint64_t rays;    /* of MONTE_CARLO, as stage_rays */
    int threads;      /* 0: all cores */
    stage_progress *progress; /* NULL: nobody looks */
} stage_options;

typedef enum { SHOW_LIGHT, SHOW_SUN, SHOW_SCATTERED } stage_show;

/* How a frame is drawn. */
typedef struct {
    stage_show show;
    double detail; /* pixels: where leaves are smaller, fewer and larger ones stand for
                      them, until they are that large; 0: every leaf */
    double relief; /* of leaves, 0 to 1 */
    bool all;      /* plants out of view too, to see what leaving them out saves */
} stage_look;

/* Seconds: [0..4] the system's steps 1 to 5, [5] the sun's maps on the GPU. */
enum { STAGE_TIMES = 6 };

/* A light's tables and maps: one each for what is drawn by it. */
typedef struct {
    gpu_maps maps;
    gl_table casters, poses, shade;
} stage_sun;

typedef struct stage {
    pps_scene *scene; /* not its own */
    stage_options options;
    pps_system *system;
    float *attenuation;     /* of LEAVES */
    pps_irradiance *leaves; /* of LEAVES and MONTE_CARLO */
    double seconds[STAGE_TIMES];
    double cores;       /* at work, in the mean, while it was prepared */
    size_t n_triangles; /* of all instances */
    pps_box box;
    double (*ball)[4];              /* about each prototype: middle and radius */
    gpu_mesh *mesh;                 /* of each prototype */
    GLuint *instances;              /* buffers of each prototype's instances, */
    GLsizei (*n_drawn)[GPU_LEVELS]; /* in view, of each level of detail */
    stage_sun sun;
    gl_table cell_of, scattered, sky_shares, leaf_light;
    GLuint openness, empty, white;
    float open_frame[4], around[3];
    GLuint depth_program, plant_program, ground_program, sky_program;
} stage;

/* False, and the problem: the model does not take such a scene. */
bool stage_takes(const pps_scene *scene, const stage_options *options,
                 pps_problem *problem);

/* Do steps 1 to 5 for a scene, which must outlive the stage. NULL: the problem. */
stage *stage_open(pps_scene *scene, const stage_options *options, pps_problem *problem);
void stage_close(stage *s); /* NULL is fine */

/* The same in its parts: make room; all that needs no OpenGL, and may have a thread of its
 * own; and the rest. A stage whose part has failed is to be closed. */
stage *stage_create(pps_scene *scene, const stage_options *options,
                    pps_problem *problem);
bool stage_prepare(stage *s, pps_problem *problem);
bool stage_upload(stage *s, pps_problem *problem);

/* After the scene's sun moved, its sky changed, or other sources are asked for. */
bool stage_light_sun(stage *s, pps_problem *problem);
bool stage_light_sky(stage *s, pps_problem *problem);

/* Draw into the bound frame buffer, whose viewport is width x height: linear radiance. */
void stage_draw(stage *s, const pps_camera *camera, int width, int height,
                const stage_look *look);

/* What makes a white plane under the open sky shine as brightly as can be shown. */
double stage_exposure(const stage *s);

/* Rays of MONTE_CARLO: as many as asked for, or (0) 32 a leaf and at least a million. */
uint64_t stage_rays(const pps_scene *scene, uint64_t asked);

/* The band that a colour (0 red, 1 green, 2 blue) is taken from; -1: none. */
int stage_band(const pps_scene *scene, int color);

#endif
