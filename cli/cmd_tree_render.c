/* ppscat tree render: a scene as a PNG, by the light on its leaves or in false colour.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/tree/picture.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "commands.h"
#include "output.h"
#include "tree_answer.h"
#include "values.h"

enum { SIZE_MIN = 16, SIZE_MAX_PIXELS = 16384, PIXEL_RAYS = 4 };

typedef enum {
    FALSE_DEPTH,
    FALSE_THICKNESS,
    FALSE_VISIBILITY,
    FALSE_G,
    FALSE_LIGHT,
    FALSE_ERROR
} false_kind;

/* What the options ask of the picture. */
typedef struct {
    const char *path;
    int width, height;
    double view[2], exposure;
    bool false_color, ranged;
    false_kind kind;
    double range[2];
} wish;

static int read_size(const invocation *call, wish *w) {
    const char *text = option_text(call, OPT_SIZE);
    char end;

    if (sscanf(text, "%5dx%5d%c", &w->width, &w->height, &end) == 2 &&
        w->width >= SIZE_MIN && w->width <= SIZE_MAX_PIXELS && w->height >= SIZE_MIN &&
        w->height <= SIZE_MAX_PIXELS)
        return CLI_DONE;
    return cli_usage(
        "--size: '%.60s' is not possible; allowed: WIDTHxHEIGHT, %d to %d pixels each",
        text, SIZE_MIN, SIZE_MAX_PIXELS);
}

static int read_view(const invocation *call, wish *w) {
    int rc = value_pair(call, OPT_VIEW, w->view);

    if (rc != CLI_DONE || (fabs(w->view[0]) <= 360 && fabs(w->view[1]) <= 90))
        return rc;
    return cli_usage(
        "--view: '%.60s' is out of range; allowed: an azimuth from -360 to 360 and an "
        "elevation from -90 to 90",
        option_text(call, OPT_VIEW));
}

static int read_colors(const invocation *call, wish *w) {
    int kind = 0, rc = CLI_DONE;

    w->false_color = option_given(call, OPT_FALSE_COLOR);
    w->ranged = option_given(call, OPT_RANGE);
    if (w->ranged && !w->false_color)
        return cli_usage("--range is for --false-color");
    if (w->false_color)
        rc = value_choice(call, OPT_FALSE_COLOR, &kind);
    w->kind = (false_kind)kind;
    if (rc == CLI_DONE && w->ranged)
        rc = value_pair(call, OPT_RANGE, w->range);
    if (rc == CLI_DONE && w->ranged && !(w->range[0] < w->range[1]))
        return cli_usage("--range: '%.60s' is empty; allowed: LOW below HIGH",
                         call->text[OPT_RANGE]);
    return rc;
}

static int read_wish(const invocation *call, wish *w) {
    int rc;

    *w = (wish){.path = call->text[OPT_OUTPUT]};
    size_t length = w->path ? strlen(w->path) : 0;
    if (length < 5 || strcmp(w->path + length - 4, ".png") != 0)
        return cli_usage("--output: '%.60s' is not possible; allowed: FILE.png",
                         w->path ? w->path : "");
    if (option_given(call, OPT_EXPOSURE) &&
        (rc = value_number(call, OPT_EXPOSURE, &w->exposure)))
        return rc;
    if ((rc = read_size(call, w)) || (rc = read_view(call, w)))
        return rc;
    return read_colors(call, w);
}

/* ---- false colour ---- */

/* The mean irradiance of both faces over the bands. */
static double mean_light(const pps_irradiance *light, size_t leaf) {
    double sum = 0;

    for (int b = 0; b < light->n_bands; b++) {
        size_t i = leaf * (size_t)light->n_bands + (size_t)b;
        sum += light->front[i] + light->back[i];
    }
    return sum / (2 * light->n_bands);
}

static double leaf_value(const wish *w, const tree_work *work,
                         const tree_answer *answer, const tree_answer *truth,
                         size_t leaf) {
    tree_place place = tree_answer_place(work, answer, leaf);

    switch (w->kind) {
    case FALSE_DEPTH:
        return place.depth;
    case FALSE_THICKNESS:
        return place.thickness;
    case FALSE_VISIBILITY:
        return place.visibility;
    case FALSE_G:
        return place.g_factor;
    case FALSE_LIGHT:
        return mean_light(answer->light, leaf);
    case FALSE_ERROR:
        return mean_light(answer->light, leaf) - mean_light(truth->light, leaf);
    }
    return NAN;
}

static int by_value(const void *a, const void *b) {
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* From the second to the ninety-eighth percentile; errors evenly about 0. */
static void find_range(wish *w, size_t n, const double *value) {
    double *sorted = malloc((n + 1) * sizeof *sorted);
    size_t m = 0;

    w->range[0] = 0;
    w->range[1] = 1;
    for (size_t i = 0; sorted && i < n; i++) {
        if (isfinite(value[i]))
            sorted[m++] = value[i];
    }
    if (m > 0) {
        qsort(sorted, m, sizeof *sorted, by_value);
        double low = sorted[m / 50], high = sorted[m - 1 - m / 50];
        double most = fmax(fabs(low), fabs(high));
        w->range[0] = w->kind == FALSE_ERROR ? -most : fmin(low, 0);
        w->range[1] = w->kind == FALSE_ERROR ? most : high;
    }
    if (!(w->range[0] < w->range[1]))
        w->range[1] = w->range[0] + 1;
    free(sorted);
}

static int paint(wish *w, const invocation *call, tree_work *work,
                 const tree_answer *answer, const tree_answer *truth,
                 const pps_camera *camera, pps_picture *picture) {
    size_t n = work->scene->n_leaves;
    double *value = malloc((n + 1) * sizeof *value);
    char title[80];

    if (!value)
        return cli_no_memory();
    for (size_t i = 0; i < n; i++)
        value[i] = leaf_value(w, work, answer, truth, i);
    if (!w->ranged)
        find_range(w, n, value);
    snprintf(title, sizeof title, "%s, %s", call->text[OPT_FALSE_COLOR],
             option_text(call, OPT_MODEL));
    pps_false_color color = {value, w->range[0], w->range[1], title};
    pps_status status =
        pps_render_false(work->scene, &color, camera, PIXEL_RAYS, picture);
    free(value);
    return status ? cli_failed("%s", pps_status_string(status)) : CLI_DONE;
}

/* ---- the picture ---- */

static int draw(wish *w, const invocation *call, tree_work *work,
                const tree_answer *answer, const tree_answer *truth,
                pps_picture *picture) {
    pps_camera camera;

    pps_camera_fit(work->scene, w->view[0], w->view[1], (double)w->width / w->height,
                   &camera);
    if (w->false_color)
        return paint(w, call, work, answer, truth, &camera, picture);
    pps_status status =
        pps_render(work->scene, answer->light, &camera, PIXEL_RAYS, picture);
    return status ? cli_failed("%s", pps_status_string(status)) : CLI_DONE;
}

static int write_picture(const wish *w, const pps_picture *picture) {
    pps_problem problem = {""};
    double exposure = w->false_color ? 1 : w->exposure;

    return pps_picture_write(picture, exposure, w->path, &problem)
               ? cli_failed("%s", problem.text)
               : CLI_DONE;
}

static int find_light(const wish *w, tree_work *work, const tree_asked *asked,
                      tree_answer *answer, tree_answer *truth) {
    tree_method mc = tree_method_at(tree_method_find("mc"));
    const char *why = "";
    int rc =
        tree_answer_find(work, &asked->method[0], asked->component[0], answer, &why);

    if (rc == CLI_DONE && w->false_color && w->kind == FALSE_ERROR)
        rc = tree_answer_find(work, &mc, asked->component[0], truth, &why);
    if (rc == CLI_DONE && w->false_color && w->kind <= FALSE_G && !answer->field)
        return cli_usage("--false-color: model '%s' has no cells, so no such number; "
                         "allowed with it: irradiance, error",
                         asked->method[0].name);
    return rc == CLI_REFUSED
               ? cli_usage("model %s and component %s do not fit: %s",
                           asked->method[0].name, asked->component[0]->name, why)
               : rc;
}

static int run(wish *w, const invocation *call, tree_work *work,
               const tree_asked *asked) {
    tree_answer answer = {0}, truth = {0};
    pps_picture *picture = NULL;
    int rc = find_light(w, work, asked, &answer, &truth);

    if (rc == CLI_DONE && pps_picture_create(w->width, w->height, &picture))
        rc = cli_no_memory();
    if (rc == CLI_DONE)
        rc = draw(w, call, work, &answer, &truth, picture);
    if (rc == CLI_DONE)
        rc = write_picture(w, picture);
    pps_picture_free(picture);
    tree_answer_free(&answer);
    tree_answer_free(&truth);
    return rc;
}

static int read_one(const invocation *call, tree_asked *asked) {
    int rc = tree_asked_read(call, asked);

    if (rc == CLI_DONE && asked->n_methods > 1)
        return cli_usage("--model: '%.60s' is a list; a picture takes one",
                         call->text[OPT_MODEL]);
    if (rc == CLI_DONE && asked->n_components > 1)
        return cli_usage("--component: '%.60s' is a list; a picture takes one",
                         call->text[OPT_COMPONENT]);
    return rc;
}

int cmd_tree_render(const invocation *call) {
    pps_scene *scene = NULL;
    tree_settings settings;
    tree_asked asked = {0};
    wish w;
    int rc = tree_settings_read(call, &settings);

    if (rc == CLI_DONE)
        rc = read_wish(call, &w);
    if (rc == CLI_DONE)
        rc = output_writable(w.path);
    if (rc == CLI_DONE)
        rc = read_one(call, &asked);
    if (rc == CLI_DONE)
        rc = tree_scene_open(call, &scene);
    if (rc == CLI_DONE) {
        tree_work work = {.scene = scene, .settings = &settings};
        rc = run(&w, call, &work, &asked);
        tree_work_free(&work);
    }
    tree_asked_free(&asked);
    pps_scene_free(scene);
    return rc;
}
