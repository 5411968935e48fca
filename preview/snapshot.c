/* Pictures from the GPU.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/snapshot.h"

#include <string.h>

#include "preview/frame.h"
#include "preview/offscreen.h"

pps_picture *snapshot_draw(stage *s, const preview_options *options,
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
    pps_camera_fit(s->scene, options->view[0], options->view[1],
                   (double)options->width / options->height, &camera);
    frame_begin(&f);
    stage_draw(s, &camera, options->width, options->height, &options->look);
    frame_finish(&f);
    frame_read(&f, picture);
    frame_free(&f);
    if (!gl_check("drawing", problem)) {
        pps_picture_free(picture);
        picture = NULL;
    }
    return picture;
}

static int draw_and_write(stage *s, const preview_options *options,
                          pps_problem *problem) {
    pps_picture *picture = snapshot_draw(s, options, problem);
    if (!picture) {
        return EXIT_FAILED;
    }
    double exposure =
        options->look.show == SHOW_LIGHT ? options->exposure * stage_exposure(s) : 1;
    pps_status status =
        pps_picture_write(picture, exposure, options->snapshot, problem);
    pps_picture_free(picture);
    return status ? EXIT_FAILED : EXIT_DONE;
}

int snapshot_run(const preview_options *options, pps_problem *problem) {
    return offscreen_run(options, draw_and_write, problem);
}
