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
    if (scene && options->sun_given) {
        turn_sun(scene, options->sun[0], options->sun[1]);
    }
    return scene;
}
