/* Times of the system's steps and of frames while the sun goes round.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/bench.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

#include "preview/frame.h"
#include "preview/offscreen.h"
#include "preview/stage_open.h"

enum { ROUND = 8 };

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Mean times over a round of the sun at its own height. */
typedef struct {
    double cells, maps, frames;
} round_times;

static bool go_round(stage *s, const preview_options *options, const frame *f,
                     round_times *mean, pps_problem *problem) {
    pps_camera camera;
    const double *to = s->scene->sun.to;
    double elevation = asin(fmin(fmax(to[2], -1), 1)) * 180 / 3.14159265358979323846;
    pps_camera_fit(s->scene, options->view[0], options->view[1],
                   (double)f->width / f->height, &camera);
    *mean = (round_times){0};
    for (int i = 0; i < ROUND; i++) {
        turn_sun(s->scene, 360.0 * i / ROUND, fmax(elevation, 5));
        if (!stage_light_sun(s, problem)) {
            return false;
        }
        double start = now();
        frame_begin(f);
        stage_draw(s, &camera, f->width, f->height, options->show);
        frame_finish(f);
        glFinish();
        mean->frames += (now() - start) / ROUND;
        mean->cells += s->seconds[4] / ROUND;
        mean->maps += s->seconds[5] / ROUND;
    }
    return gl_check("drawing", problem);
}

static void print(const stage *s, const preview_options *options,
                  const round_times *mean) {
    static const char *const step[] = {"1 cells", "2 maps", "3 G-factors", "4 sky"};
    printf("step,seconds\n");
    for (int i = 0; i < 4; i++) {
        printf("%s,%.6f\n", step[i], s->seconds[i]);
    }
    printf("5 sun,%.6f\n5 sun's maps on the GPU,%.6f\n6 frame,%.6f\n", mean->cells,
           mean->maps, mean->frames);
    fprintf(
        stderr,
        "ppscat-preview: %zu instances, %zu triangles, %zu cells, %d x %d pixels, %d "
        "samples; %s\n",
        s->scene->n_instances, s->n_triangles, s->system ? s->system->n_cells : 0,
        options->width, options->height, options->samples,
        (const char *)glGetString(GL_RENDERER));
}

static int measure(stage *s, const preview_options *options, pps_problem *problem) {
    frame f;
    round_times mean;
    if (!frame_create(options->width, options->height, options->samples, &f, problem)) {
        return EXIT_FAILED;
    }
    bool good = go_round(s, options, &f, &mean, problem);
    frame_free(&f);
    if (good) {
        print(s, options, &mean);
    }
    return good ? EXIT_DONE : EXIT_FAILED;
}

int bench_run(const preview_options *options, pps_problem *problem) {
    return offscreen_run(options, measure, problem);
}
