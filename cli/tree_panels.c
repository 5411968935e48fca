/* Panels of pictures.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree_panels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"

enum { PIXEL_RAYS = 4 };

/* One model's answer to one component; no light in it: the model does not know it. */
typedef struct {
    const tree_method *method;
    const tree_component *component;
    tree_answer answer;
    double *value; /* of each leaf: what false colours show, or the irradiance */
    pps_picture *picture;
    char caption[96];
} panel;

typedef struct {
    picture_wish *wish;
    tree_work *work;
    size_t n, n_components;
    panel *panel;
    tree_answer *truth; /* of each component, for errors; else no light in it */
} panels;

enum { WIDE = 2400 }; /* pixels: more than screens show */

void tree_panels_count(const tree_asked *asked, int width, int *across, int *down) {
    int models = (int)asked->n_methods, components = (int)asked->n_components;

    *across = components > 1 ? components : models;
    *down = components > 1 ? models : 1;
    if (*down == 1 && *across > 3 && *across * width > WIDE) {
        *across = (*across + 1) / 2;
        *down = 2;
    }
}

/* ---- light ---- */

static bool of_cells(shown what) { return what <= SHOW_G; }

static int find_answer(panels *all, panel *p) {
    const char *why = "";
    int rc = tree_answer_find(all->work, p->method, p->component, &p->answer, &why);

    if (rc == CLI_DONE && of_cells(all->wish->what) && !p->answer.field)
        return cli_usage("--false-color: model '%s' has no cells, so no such number; "
                         "allowed with it: irradiance, error",
                         p->method->name);
    if (rc == CLI_REFUSED && all->n == 1)
        return cli_usage("model %s and component %s do not fit: %s", p->method->name,
                         p->component->name, why);
    if (rc == CLI_REFUSED)
        cli_note("%s refuses component %s: %s", p->method->name, p->component->name,
                 why);
    return rc;
}

static int find_truths(panels *all) {
    tree_method mc = tree_method_at(tree_method_find("mc"));
    const char *why = "";
    int rc = CLI_DONE;

    for (size_t i = 0; i < all->n_components && rc == CLI_DONE; i++)
        rc = tree_answer_find(all->work, &mc, all->panel[i].component, &all->truth[i],
                              &why);
    return rc;
}

/* CLI_REFUSED where a panel has no light. */
static int find_light(panels *all) {
    int worst = CLI_DONE;

    for (size_t i = 0; i < all->n; i++) {
        int rc = find_answer(all, &all->panel[i]);
        if (rc == CLI_REFUSED)
            worst = rc;
        else if (rc != CLI_DONE)
            return rc;
    }
    if (all->wish->what == SHOW_ERROR) {
        int rc = find_truths(all);
        worst = rc == CLI_DONE ? worst : rc;
    }
    return worst;
}

/* ---- values ---- */

/* The mean irradiance of both faces over the bands. */
static double mean_light(const pps_irradiance *light, size_t leaf) {
    double sum = 0;

    for (int b = 0; b < light->n_bands; b++) {
        size_t i = leaf * (size_t)light->n_bands + (size_t)b;
        sum += light->front[i] + light->back[i];
    }
    return sum / (2 * light->n_bands);
}

static double leaf_value(const panels *all, size_t i, size_t leaf) {
    const tree_answer *answer = &all->panel[i].answer;
    tree_place place = tree_answer_place(all->work, answer, leaf);
    double light = mean_light(answer->light, leaf);

    switch (all->wish->what) {
    case SHOW_DEPTH:
        return place.depth;
    case SHOW_THICKNESS:
        return place.thickness;
    case SHOW_VISIBILITY:
        return place.visibility;
    case SHOW_G:
        return place.g_factor;
    case SHOW_ERROR:
        return light - mean_light(all->truth[i % all->n_components].light, leaf);
    case SHOW_IRRADIANCE:
    case SHOW_LIGHT:
        break;
    }
    return light;
}

/* Values of a panel's leaves, and its caption with their mean by area. */
static int fill_panel(panels *all, size_t i) {
    const pps_scene *scene = all->work->scene;
    panel *p = &all->panel[i];
    double sum = 0, area = 0;

    p->value = malloc((scene->n_leaves + 1) * sizeof *p->value);
    if (!p->value)
        return cli_no_memory();
    for (size_t leaf = 0; leaf < scene->n_leaves; leaf++) {
        pps_scene_leaf at;
        pps_scene_leaf_at(scene, leaf, &at);
        p->value[leaf] = leaf_value(all, i, leaf);
        if (isfinite(p->value[leaf])) {
            sum += at.area * p->value[leaf];
            area += at.area;
        }
    }
    snprintf(p->caption, sizeof p->caption, "%s%s%s, mean %.3g", p->method->name,
             all->n_components > 1 ? " " : "",
             all->n_components > 1 ? p->component->name : "",
             area > 0 ? sum / area : 0);
    return CLI_DONE;
}

static int fill_panels(panels *all) {
    int rc = CLI_DONE;

    for (size_t i = 0; i < all->n && rc == CLI_DONE; i++) {
        panel *p = &all->panel[i];
        if (p->answer.light)
            rc = fill_panel(all, i);
        else
            snprintf(p->caption, sizeof p->caption, "%s %s: not modelled",
                     p->method->name, p->component->name);
    }
    return rc;
}

static int by_value(const void *a, const void *b) {
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* From the second to the ninety-eighth percentile of all panels; errors evenly about 0. */
static int find_range(panels *all) {
    picture_wish *w = all->wish;
    size_t n = all->work->scene->n_leaves, m = 0;
    double *sorted = malloc((all->n * n + 1) * sizeof *sorted);

    if (!sorted)
        return cli_no_memory();
    for (size_t i = 0; i < all->n * n; i++) {
        const double *value = all->panel[i / n].value;
        if (value && isfinite(value[i % n]))
            sorted[m++] = value[i % n];
    }
    w->range[0] = 0;
    w->range[1] = 1;
    if (m > 0) {
        qsort(sorted, m, sizeof *sorted, by_value);
        double low = sorted[m / 50], high = sorted[m - 1 - m / 50];
        double most = fmax(fabs(low), fabs(high));
        w->range[0] = w->what == SHOW_ERROR ? -most : fmin(low, 0);
        w->range[1] = w->what == SHOW_ERROR ? most : high;
    }
    if (!(w->range[0] < w->range[1]))
        w->range[1] = w->range[0] + 1;
    free(sorted);
    return CLI_DONE;
}

/* ---- pictures ---- */

/* What is split is always on a sheet, whose footer says what the colours are. */
static bool as_sheet(const panels *all) {
    return all->n > 1 || all->panel[0].component->split;
}

/* The scene with the lights that the component counts, for wood, ground and background. */
static pps_scene scene_of(const panels *all, unsigned sources) {
    pps_scene scene = *all->work->scene;

    if (!(sources & PPS_SUN))
        memset(scene.sun.irradiance, 0, sizeof scene.sun.irradiance);
    if (!(sources & PPS_SKY))
        scene.sky = (pps_sky){0};
    return scene;
}

static pps_status render(const panels *all, panel *p, const pps_camera *camera) {
    const picture_wish *w = all->wish;
    const pps_scene scene = scene_of(all, p->component->sources);
    char title[80];
    pps_status status = pps_picture_create(w->width, w->height, &p->picture);

    if (status)
        return status;
    if (p->component->split)
        return pps_render_split(&scene, p->answer.light, camera, PIXEL_RAYS,
                                p->picture);
    if (w->what == SHOW_LIGHT)
        return pps_render(&scene, p->answer.light, camera, PIXEL_RAYS, p->picture);
    snprintf(title, sizeof title, "%s, %s", w->title, p->method->name);
    pps_false_color color = {p->value, w->range[0], w->range[1], title, as_sheet(all)};
    return pps_render_false(&scene, &color, camera, PIXEL_RAYS, p->picture);
}

static int render_all(panels *all) {
    const picture_wish *w = all->wish;
    pps_camera camera;
    pps_status status = PPS_OK;

    pps_camera_fit(all->work->scene, w->view[0], w->view[1],
                   (double)w->width / w->height, &camera);
    for (size_t i = 0; i < all->n && !status; i++) {
        if (all->panel[i].answer.light)
            status = render(all, &all->panel[i], &camera);
    }
    return status ? cli_failed("%s", pps_status_string(status)) : CLI_DONE;
}

/* The exposure of all panels that are, or are not, split; 0 where there are none. */
static pps_status group_exposure(const panels *all, bool split, double *exposure) {
    pps_picture **picture = calloc(all->n, sizeof *picture);
    pps_status status = picture ? PPS_OK : PPS_ERR_MEMORY;
    size_t n = 0;

    *exposure = 0;
    for (size_t i = 0; i < all->n && picture; i++) {
        if (all->panel[i].picture && all->panel[i].component->split == split)
            picture[n++] = all->panel[i].picture;
    }
    if (n > 0)
        status = pps_picture_exposure(n, picture, exposure);
    free(picture);
    return status;
}

/* Expose every panel, and say how in the footer. */
static pps_status expose_all(panels *all, char *footer, size_t size) {
    double light = all->wish->exposure, split;
    pps_status status = light > 0 ? PPS_OK : group_exposure(all, false, &light);
    char said[2][80] = {"", ""};

    if (!status)
        status = group_exposure(all, true, &split);
    if (status)
        return status;
    for (size_t i = 0; i < all->n; i++) {
        panel *p = &all->panel[i];
        bool is_split = p->component->split;
        if (p->picture)
            pps_picture_expose(p->picture, is_split ? split : light);
        snprintf(said[is_split], sizeof said[0], "%s%.3g in all panels",
                 is_split ? "split: red reflected, green transmitted, radiance x "
                          : "radiance x ",
                 is_split ? split : light);
    }
    snprintf(footer, size, "%s%s%s", said[0], *said[0] && *said[1] ? "; " : "",
             said[1]);
    return PPS_OK;
}

static pps_status draw_sheet(panels *all, int across, pps_picture **out) {
    const picture_wish *w = all->wish;
    bool in_light = w->what == SHOW_LIGHT;
    pps_picture **picture = malloc(all->n * sizeof *picture);
    const char **caption = malloc(all->n * sizeof *caption);
    char footer[200] = "";
    pps_false_color key = {.low = w->range[0], .high = w->range[1], .title = w->title};
    pps_sheet sheet = {.columns = across,
                       .n = all->n,
                       .panel = picture,
                       .caption = caption,
                       .footer = in_light ? footer : NULL,
                       .key = in_light ? NULL : &key};
    pps_status status = picture && caption ? PPS_OK : PPS_ERR_MEMORY;

    if (!status && in_light)
        status = expose_all(all, footer, sizeof footer);
    for (size_t i = 0; i < all->n && !status; i++) {
        picture[i] = all->panel[i].picture;
        caption[i] = all->panel[i].caption;
    }
    if (!status)
        status = pps_sheet_draw(&sheet, out);
    free(picture);
    free(caption);
    return status;
}

static int write_picture(panels *all, int across) {
    const picture_wish *w = all->wish;
    pps_picture *sheet = NULL;
    pps_problem problem = {""};
    pps_status status = PPS_OK;
    double exposure = w->what == SHOW_LIGHT ? w->exposure : 1;

    if (as_sheet(all)) {
        status = draw_sheet(all, across, &sheet);
        exposure = 1;
    }
    if (status)
        return cli_failed("%s", pps_status_string(status));
    status = pps_picture_write(sheet ? sheet : all->panel[0].picture, exposure, w->path,
                               &problem);
    pps_picture_free(sheet);
    return status ? cli_failed("%s", problem.text) : CLI_DONE;
}

/* ---- all of it ---- */

static int panels_init(panels *all, const tree_asked *asked) {
    all->n_components = asked->n_components;
    all->n = asked->n_methods * asked->n_components;
    all->panel = calloc(all->n, sizeof *all->panel);
    all->truth = calloc(all->n_components, sizeof *all->truth);
    if (!all->panel || !all->truth)
        return cli_no_memory();
    for (size_t i = 0; i < all->n; i++) {
        all->panel[i].method = &asked->method[i / asked->n_components];
        all->panel[i].component = asked->component[i % asked->n_components];
    }
    return CLI_DONE;
}

static void panels_free(panels *all) {
    for (size_t i = 0; all->panel && i < all->n; i++) {
        tree_answer_free(&all->panel[i].answer);
        pps_picture_free(all->panel[i].picture);
        free(all->panel[i].value);
    }
    for (size_t i = 0; all->truth && i < all->n_components; i++)
        tree_answer_free(&all->truth[i]);
    free(all->panel);
    free(all->truth);
}

int tree_panels_draw(picture_wish *wish, tree_work *work, const tree_asked *asked) {
    panels all = {.wish = wish, .work = work};
    int across, down, refused = CLI_DONE, rc = panels_init(&all, asked);

    tree_panels_count(asked, wish->width, &across, &down);
    if (rc == CLI_DONE)
        rc = find_light(&all);
    if (rc == CLI_REFUSED) {
        refused = rc;
        rc = CLI_DONE;
    }
    if (rc == CLI_DONE)
        rc = fill_panels(&all);
    if (rc == CLI_DONE && !wish->ranged && wish->what != SHOW_LIGHT)
        rc = find_range(&all);
    if (rc == CLI_DONE)
        rc = render_all(&all);
    if (rc == CLI_DONE)
        rc = write_picture(&all, across);
    panels_free(&all);
    return rc == CLI_DONE ? refused : rc;
}
