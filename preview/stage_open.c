/* Reading scenes; nine cherries where none is given.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/stage_open.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>

static const double DEGREE = 3.14159265358979323846 / 180;

void turn_sun(pps_scene *scene, double azimuth, double elevation) {
    double a = azimuth * DEGREE, e = elevation * DEGREE;
    scene->sun.to[0] = cos(e) * cos(a);
    scene->sun.to[1] = cos(e) * sin(a);
    scene->sun.to[2] = sin(e);
}

static pps_scene *grove(pps_problem *problem) {
    enum { ROWS = 3 };
    static const double shift[ROWS * ROWS][2] = {
        {0.4, -0.7}, {-0.9, 0.3}, {0.6, 0.8},  {-0.5, 0.5}, {0.2, -0.6},
        {0.9, 0.1},  {-0.3, 0.9}, {0.7, -0.2}, {-0.8, -0.4}};
    pps_mesh *mesh;
    pps_scene *scene;
    if (pps_species_grow("cherry", 1, &mesh, problem) ||
        pps_scene_of_mesh(mesh, &scene)) {
        return NULL;
    }
    pps_instance *at = realloc(scene->instance, ROWS * ROWS * sizeof *at);
    if (!at || pps_species_optics("cherry", &scene->prototype[0].optics, problem)) {
        pps_scene_free(scene);
        return NULL;
    }
    scene->instance = at;
    scene->n_instances = ROWS * ROWS;
    for (int i = 0; i < ROWS * ROWS; i++) {
        at[i] = (pps_instance){
            0,
            {7.0 * (i % ROWS - 1) + shift[i][0], 7.0 * (i / ROWS - 1) + shift[i][1], 0},
            72.0 * (3 * i % 5),
            0.85 + 0.3 * (7 * i % 9) / 9};
    }
    if (pps_scene_index(scene)) {
        pps_scene_free(scene);
        return NULL;
    }
    return scene;
}

/* A face keeps what it reflects to what it lets through, and never gives more than it gets. */
static void set_face(pps_leaf_optics *o, int face, int band, double factor) {
    double *r = &o->reflectance[face][band], *t = &o->transmittance[face][band];
    factor = fmin(factor, 1 / fmax(*r + *t, 1e-9));
    *r *= factor;
    *t *= factor;
}

void set_albedo(pps_scene *scene, int band, double albedo) {
    for (size_t p = 0; p < scene->n_prototypes; p++) {
        pps_leaf_optics *o = &scene->prototype[p].optics;
        double now = pps_leaf_albedo(o, band);
        for (int face = 0; face < 2; face++) {
            if (now > 0) {
                set_face(o, face, band, albedo / now);
            } else {
                o->reflectance[face][band] = o->transmittance[face][band] = albedo / 2;
            }
        }
    }
}

bool leaves_too_large(const stage *s, char *out, size_t size) {
    double most = 0;
    for (size_t i = 0; i < s->scene->n_instances; i++) {
        const pps_instance *at = &s->scene->instance[i];
        most = fmax(most, s->mesh[at->prototype].leaf_size * at->scale);
    }
    if (!s->system || most <= s->system->cell) {
        return false;
    }
    snprintf(out, size,
             "leaves of %.2g m are larger than the cells of %.2g m that light is "
             "known in",
             most, s->system->cell);
    return true;
}

pps_scene *scene_for(const preview_options *options, pps_problem *problem) {
    pps_scene *scene = NULL;
    problem->text[0] = '\0';
    if (!options->scene) {
        scene = grove(problem);
    } else if (pps_scene_read(options->scene, &scene, problem)) {
        scene = NULL;
    }
    if (!scene && !problem->text[0]) {
        strcpy(problem->text, "out of memory");
    }
    for (int b = 0; scene && b < scene->n_bands; b++) {
        if (!isnan(options->albedo[b])) {
            set_albedo(scene, b, options->albedo[b]);
        }
    }
    if (scene && options->sun_given) {
        turn_sun(scene, options->sun[0], options->sun[1]);
    }
    if (scene &&
        !(stage_takes(scene, &options->stage, problem) &&
          (!options->split || stage_takes(scene, &options->second, problem)))) {
        pps_scene_free(scene);
        scene = NULL;
    }
    return scene;
}
