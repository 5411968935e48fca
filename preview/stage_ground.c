/* How open to the sky each place on the ground is: the parts of the sky one after another,
 * each by opacity maps towards it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>

#include "preview/stage_own.h"

enum { PLACES = 256, MAP_TEXELS = 128 };

/* The plants' box, and as much again around it as they are high. */
static void set_frame(stage *s, double low[2], double extent[2]) {
    pps_box all, leaves;
    pps_scene_box(s->scene, &all, &leaves);
    double reach = 1.5 * (all.high[2] - all.low[2]);
    for (int i = 0; i < 2; i++) {
        low[i] = all.low[i] - reach;
        extent[i] = all.high[i] - all.low[i] + 2 * reach;
        s->open_frame[i] = (float)low[i];
        s->open_frame[2 + i] = (float)(1 / extent[i]);
    }
}

static GLuint make_texture(void) {
    static const float open[] = {1, 1, 1, 1};
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R16F, PLACES, PLACES, 0, GL_RED, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, open);
    return texture;
}

/* The ground's light from a part of the sky, over all bands; 0 for parts below. */
static double weight_of(const pps_scene *scene, const double to[3]) {
    double sum = 0;
    for (int b = 0; b < scene->n_bands && to[2] > 0; b++) {
        sum += to[2] * pps_sky_radiance(&scene->sky, b, to[2]);
    }
    return sum;
}

static void add_direction(const stage *s, GLuint frame, GLuint program,
                          const stage_sun *light, double weight) {
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glViewport(0, 0, PLACES, PLACES);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_ONE, GL_ONE);
    stage_use_sun(light, program);
    gl_set_float(program, "weight", weight);
    gl_set_float(program, "ground_height", s->scene->ground.height);
    gl_set_int(program, "ground_list", (int)s->scene->n_instances);
    glBindVertexArray(s->empty);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
}

static bool add_all(stage *s, GLuint frame, GLuint program, stage_sun *light,
                    pps_problem *problem) {
    pps_directions directions = pps_directions_22();
    double whole = 0;
    for (int j = 0; j < directions.n; j++) {
        whole += weight_of(s->scene, directions.to[j]);
    }
    for (int j = 0; j < directions.n; j++) {
        double weight = weight_of(s->scene, directions.to[j]);
        if (weight > 0) {
            if (stage_fill_sun(s, directions.to[j], true, light)) {
                return false;
            }
            add_direction(s, frame, program, light, weight / whole);
        }
    }
    return gl_check("the ground's light", problem);
}

bool stage_open_ground(stage *s, pps_problem *problem) {
    static const float none[] = {0, 0, 0, 0};
    double low[2], extent[2];
    stage_sun light = {0};
    GLuint frame,
        program = gl_program("screen_vert", "by_opacity+sun+open_frag", problem);
    if (!program ||
        !gpu_maps_create(MAP_TEXELS, s->sun.maps.n, false, &light.maps, problem)) {
        glDeleteProgram(program);
        return false;
    }
    set_frame(s, low, extent);
    s->openness = make_texture();
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           s->openness, 0);
    glClearBufferfv(GL_COLOR, 0, none);
    glUseProgram(program);
    glUniform2f(glGetUniformLocation(program, "low"), (float)low[0], (float)low[1]);
    glUniform2f(glGetUniformLocation(program, "extent"), (float)extent[0],
                (float)extent[1]);
    bool good = add_all(s, frame, program, &light, problem);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &frame);
    glDeleteProgram(program);
    stage_sun_free(&light);
    return good;
}
