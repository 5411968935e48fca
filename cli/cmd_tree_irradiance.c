/* ppscat tree irradiance: the irradiance of every leaf as CSV.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>

#include "cli.h"
#include "commands.h"
#include "output.h"
#include "tree_answer.h"

/* One method's answer to one component; no light in it where it was refused. */
typedef struct {
    const tree_method *method;
    const tree_component *component;
    tree_answer answer;
} part;

static double mean_error(const pps_irradiance *light, size_t i) {
    return light->front_error ? hypot(light->front_error[i], light->back_error[i]) / 2
                              : CSV_EMPTY;
}

static int write_part(output *out, const tree_work *work, const part *p, size_t leaf,
                      size_t band) {
    const pps_irradiance *light = p->answer.light;
    size_t i = leaf * (size_t)work->scene->n_bands + band;
    tree_place place = tree_answer_place(work, &p->answer, leaf);

    csv_number(&out->csv, place.depth);
    csv_number(&out->csv, place.thickness);
    csv_number(&out->csv, place.visibility);
    csv_number(&out->csv, place.g_factor);
    csv_text(&out->csv, p->method->name);
    csv_text(&out->csv, p->component->name);
    csv_number(&out->csv, light ? light->front[i] : CSV_EMPTY);
    csv_number(&out->csv, light ? light->back[i] : CSV_EMPTY);
    csv_number(&out->csv, light ? mean_error(light, i) : CSV_EMPTY);
    return output_end_row(out, NULL, NULL);
}

static int write_leaf(output *out, const tree_work *work, size_t n, const part *parts,
                      size_t leaf) {
    const pps_scene *scene = work->scene;
    pps_scene_leaf at;
    int rc = CLI_DONE;

    pps_scene_leaf_at(scene, leaf, &at);
    const pps_mesh *mesh =
        scene->prototype[scene->instance[at.instance].prototype].mesh;
    for (size_t band = 0; band < (size_t)scene->n_bands; band++) {
        for (size_t i = 0; i < n && rc == CLI_DONE; i++) {
            csv_number(&out->csv, (double)at.instance);
            csv_number(&out->csv, (double)at.leaf);
            csv_text(&out->csv, mesh->material[mesh->leaf[at.leaf].material].name);
            for (int k = 0; k < 3; k++)
                csv_number(&out->csv, at.center[k]);
            for (int k = 0; k < 3; k++)
                csv_number(&out->csv, at.normal[k]);
            csv_number(&out->csv, at.area);
            csv_text(&out->csv, scene->band[band]);
            rc = write_part(out, work, &parts[i], leaf, band);
        }
    }
    return rc;
}

/* CLI_REFUSED, with a note for each, where a method does not know a component. */
static int find_parts(tree_work *work, const tree_asked *asked, part *parts) {
    int worst = CLI_DONE;

    for (size_t i = 0; i < asked->n_methods * asked->n_components; i++) {
        part *p = &parts[i];
        const char *why = "";
        p->method = &asked->method[i / asked->n_components];
        p->component = asked->component[i % asked->n_components];
        int rc = tree_answer_find(work, p->method, p->component, &p->answer, &why);
        if (rc == CLI_REFUSED) {
            cli_note("%s refuses component %s: %s", p->method->name, p->component->name,
                     why);
            worst = rc;
        } else if (rc != CLI_DONE) {
            return rc;
        }
    }
    return worst;
}

static int write_all(output *out, const tree_work *work, size_t n, const part *parts) {
    int rc = CLI_DONE;

    for (size_t leaf = 0; leaf < work->scene->n_leaves && rc == CLI_DONE; leaf++)
        rc = write_leaf(out, work, n, parts, leaf);
    return rc;
}

/* The file is opened before the work is done: it may be refused. */
static int run(const invocation *call, const pps_scene *scene,
               const tree_settings *settings, const tree_asked *asked) {
    size_t n = asked->n_methods * asked->n_components;
    tree_work work = {.scene = scene, .settings = settings};
    output out;
    int rc = output_open(&out, call), found;

    if (rc != CLI_DONE)
        return rc;
    part *parts = calloc(n, sizeof *parts);
    found = parts ? find_parts(&work, asked, parts) : cli_no_memory();
    rc = found == CLI_REFUSED ? CLI_DONE : found;
    if (rc == CLI_DONE)
        rc = write_all(&out, &work, n, parts);
    for (size_t i = 0; parts && i < n; i++)
        tree_answer_free(&parts[i].answer);
    free(parts);
    tree_work_free(&work);
    rc = output_close(&out, rc);
    return rc == CLI_DONE ? found : rc;
}

int cmd_tree_irradiance(const invocation *call) {
    pps_scene *scene = NULL;
    tree_settings settings;
    tree_asked asked = {0};
    int rc = tree_settings_read(call, &settings);

    if (rc == CLI_DONE)
        rc = tree_asked_read(call, false, &asked);
    if (rc == CLI_DONE)
        rc = tree_scene_open(call, &scene);
    if (rc == CLI_DONE)
        rc = run(call, scene, &settings, &asked);
    tree_asked_free(&asked);
    pps_scene_free(scene);
    return rc;
}
