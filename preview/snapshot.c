/* Pictures from the GPU.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/snapshot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "preview/frame.h"
#include "preview/offscreen.h"

/* The lens grows longer, the eye stays. */
static void zoom_in(pps_camera *camera, double zoom) {
    const double degree = 3.14159265358979323846 / 180;
    camera->field_of_view =
        2 * atan(tan(camera->field_of_view / 2 * degree) / zoom) / degree;
}

static void find_camera(const pps_scene *scene, const preview_options *options,
                        pps_camera *camera) {
    pps_camera_fit(scene, options->view[0], options->view[1],
                   (double)options->width / options->height, camera);
    zoom_in(camera, options->zoom);
}

static pps_picture *draw(const stage_pair *pair, const preview_options *options,
                         pps_problem *problem) {
    frame f;
    pps_camera camera;
    pps_picture *picture;
    if (pps_picture_create(options->width, options->height, &picture)) {
        strcpy(problem->text, "out of memory");
        return NULL;
    }
    if (!frame_create(options->width, options->height, options->samples, &f, problem)) {
        pps_picture_free(picture);
        return NULL;
    }
    find_camera(pair->scene, options, &camera);
    frame_begin(&f);
    pair_draw(pair, options->width / 2, &camera, options->width, options->height,
              &options->look);
    frame_finish(&f);
    frame_read(&f, picture);
    frame_free(&f);
    if (!gl_check("drawing", problem)) {
        pps_picture_free(picture);
        picture = NULL;
    }
    return picture;
}

pps_picture *snapshot_draw(stage *s, const preview_options *options,
                           pps_problem *problem) {
    stage_pair alone = {s->scene, {s, NULL}};
    return draw(&alone, options, problem);
}

static int draw_and_write(const stage_pair *pair, const preview_options *options,
                          pps_problem *problem) {
    pps_camera camera;
    find_camera(pair->scene, options, &camera);
    if (pair->scene->ground.present && camera.eye[2] <= pair->scene->ground.height) {
        snprintf(problem->text, sizeof problem->text,
                 "--view: from an elevation of %g the ground hides all",
                 options->view[1]);
        return EXIT_USAGE;
    }
    pps_picture *picture = draw(pair, options, problem);
    if (!picture) {
        return EXIT_FAILED;
    }
    double exposure = options->look.show == SHOW_LIGHT
                          ? options->exposure * stage_exposure(pair->of[0])
                          : 1;
    pps_status status =
        pps_picture_write(picture, exposure, options->snapshot, problem);
    pps_picture_free(picture);
    return status ? EXIT_FAILED : EXIT_DONE;
}

int snapshot_run(const preview_options *options, pps_problem *problem) {
    return offscreen_run(options, draw_and_write, problem);
}
