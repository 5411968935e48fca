/* Times of the system's steps and of frames while the sun goes round; frames with and
 * without what makes them fast.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/bench.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

#include "preview/frame.h"
#include "preview/offscreen.h"
#include "preview/stage_open.h"

enum { ROUND = 4 };
static const double DEGREE = 3.14159265358979323846 / 180, EYES = 1.7;

/* Seconds on the clock, and of all the program's threads. */
typedef struct {
    double wall, cpu;
} duration;

static double read_clock(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static duration now(void) {
    return (duration){read_clock(CLOCK_MONOTONIC),
                      read_clock(CLOCK_PROCESS_CPUTIME_ID)};
}

typedef struct {
    stage *stage;
    const preview_options *options;
    frame frame;
    pps_camera outside, within;
} bench;

/* ---- rows ---- */

static void print_row(const bench *b, int step, const char *work, duration t) {
    const stage *s = b->stage;
    printf("%d,%s,%.3f,%.3f,%.4g,%zu,%zu,%zu,%d,%d,%d,\"%s\"\n", step, work,
           1000 * t.wall, 1000 * t.cpu, t.wall > 0 ? 1 / t.wall : 0,
           s->scene->n_instances, s->n_triangles, s->system ? s->system->n_cells : 0,
           b->frame.width, b->frame.height, b->frame.samples,
           (const char *)glGetString(GL_RENDERER));
    fflush(stdout);
}

/* A step as it was when the stage opened. */
static duration of_opening(const stage *s, int step) {
    return (duration){s->seconds[step], s->seconds[step] * s->cores};
}

static void print_steps(const bench *b) {
    static const char *const work[] = {"cells", "maps", "depths and G", "sky"};
    for (int i = 0; i < 4; i++) {
        print_row(b, i + 1, work[i], of_opening(b->stage, i));
    }
}

/* ---- frames ---- */

static duration draw(const bench *b, const pps_camera *camera, stage_look look) {
    duration start = now();
    frame_begin(&b->frame);
    stage_draw(b->stage, camera, b->frame.width, b->frame.height, &look);
    frame_finish(&b->frame);
    glFinish();
    duration end = now();
    return (duration){end.wall - start.wall, end.cpu - start.cpu};
}

static void add(duration *sum, duration t, double share) {
    sum->wall += share * t.wall;
    sum->cpu += share * t.cpu;
}

/* What a moved sun costs. */
typedef struct {
    duration light, maps, frame;
} move;

/* Monte Carlo takes so long that once is enough: as it was when the stage opened. */
static void take_opening(const bench *b, move *out) {
    out->light = of_opening(b->stage, 4);
    out->maps = of_opening(b->stage, 5);
    out->frame = draw(b, &b->outside, b->options->look);
}

/* Means over a round of the sun at its own height. */
static bool go_round(const bench *b, move *out, pps_problem *problem) {
    stage *s = b->stage;
    double elevation = asin(fmin(fmax(s->scene->sun.to[2], -1), 1)) / DEGREE;
    for (int i = 0; i < ROUND; i++) {
        turn_sun(s->scene, 360.0 * i / ROUND, fmax(elevation, 5));
        duration start = now();
        if (!stage_light_sun(s, problem)) {
            return false;
        }
        double cpu = now().cpu - start.cpu, wall = s->seconds[4] + s->seconds[5];
        add(&out->light, (duration){s->seconds[4], cpu * s->seconds[4] / wall},
            1.0 / ROUND);
        add(&out->maps, (duration){s->seconds[5], cpu * s->seconds[5] / wall},
            1.0 / ROUND);
        add(&out->frame, draw(b, &b->outside, b->options->look), 1.0 / ROUND);
    }
    return true;
}

/* The very first frame, which waits for the driver to translate shaders, is not counted. */
static bool move_sun(const bench *b, pps_problem *problem) {
    move m = {{0, 0}, {0, 0}, {0, 0}};
    draw(b, &b->outside, b->options->look);
    if (b->stage->options.way == STAGE_MONTE_CARLO) {
        take_opening(b, &m);
    } else if (!go_round(b, &m, problem)) {
        return false;
    }
    print_row(b, 5, "sun", m.light);
    print_row(b, 5, "maps of the sun on the GPU", m.maps);
    print_row(b, 6, "frame", m.frame);
    return true;
}

/* From outside, all in view, and from within: with every plant and leaf, with those in
 * view, and with fewer leaves where they are small. The first frame of each is not
 * counted. */
static void leave_out(const bench *b) {
    double detail = b->options->look.detail > 0 ? b->options->look.detail : 2;
    stage_look look[] = {b->options->look, b->options->look, b->options->look};
    look[0].all = true;
    look[0].detail = look[1].detail = 0;
    look[2].detail = detail;
    static const char *const name[] = {"every plant and leaf", "plants in view",
                                       "fewer leaves"};
    static const char *const place[] = {"outside", "within"};
    for (int k = 0; k < 6; k++) {
        const pps_camera *camera = k < 3 ? &b->outside : &b->within;
        char work[80];
        snprintf(work, sizeof work, "frame from %s: %s", place[k / 3], name[k % 3]);
        draw(b, camera, look[k % 3]);
        print_row(b, 6, work, draw(b, camera, look[k % 3]));
    }
}

/* In the middle of the scene, eyes above what is lowest, looking as the view does. */
static void stand_within(bench *b) {
    const pps_box *box = &b->stage->box;
    double a = b->options->view[0] * DEGREE;
    b->within = (pps_camera){.up = {0, 0, 1}, .field_of_view = 50};
    for (int i = 0; i < 3; i++) {
        b->within.eye[i] =
            i < 2 ? (box->low[i] + box->high[i]) / 2 : box->low[i] + EYES;
        b->within.target[i] = b->within.eye[i];
    }
    b->within.target[0] -= 10 * cos(a);
    b->within.target[1] -= 10 * sin(a);
    b->within.target[2] += 1;
}

static int measure(const stage_pair *pair, const preview_options *options,
                   pps_problem *problem) {
    stage *s = pair->of[0];
    bench b = {.stage = s, .options = options};
    if (!frame_create(options->width, options->height, options->samples, &b.frame,
                      problem)) {
        return EXIT_FAILED;
    }
    pps_camera_fit(s->scene, options->view[0], options->view[1],
                   (double)options->width / options->height, &b.outside);
    stand_within(&b);
    printf("step,work,ms,cpu_ms,per_second,instances,triangles,cells,width,height,"
           "samples,renderer\n");
    print_steps(&b);
    bool good = move_sun(&b, problem);
    if (good) {
        leave_out(&b);
        good = gl_check("drawing", problem);
    }
    frame_free(&b.frame);
    return good ? EXIT_DONE : EXIT_FAILED;
}

int bench_run(const preview_options *options, pps_problem *problem) {
    return offscreen_run(options, measure, problem);
}
