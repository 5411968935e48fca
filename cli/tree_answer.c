/* Asking light models and Monte Carlo.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree_answer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "progress.h"
#include "system.h"

static const tree_method references[] = {
    {TREE_TRACE, "mc", "Monte Carlo: light traced from sun and sky, all bounces", "",
     PPS_ALL_LIGHT, false, NULL},
    {TREE_GATHER, "gather", "Monte Carlo: light gathered backwards from every leaf", "",
     PPS_ALL_LIGHT, false, NULL},
};
enum { N_REFERENCES = sizeof references / sizeof references[0] };

size_t tree_method_count(void) { return pps_light_model_count() + N_REFERENCES; }

tree_method tree_method_at(size_t i) {
    if (i >= pps_light_model_count())
        return references[i - pps_light_model_count()];
    const pps_light_model *m = pps_light_model_at(i);
    return (tree_method){TREE_MODEL, m->name,        m->summary, m->source,
                         m->sources, m->compensates, m};
}

size_t tree_method_find(const char *name) {
    size_t i = 0;

    while (i < tree_method_count() && strcmp(tree_method_at(i).name, name) != 0)
        i++;
    return i;
}

/* ---- what was asked ---- */

/* The number of a name among n; false where there is none of it. */
static bool find_name(const char *word, size_t length, size_t n,
                      const char *const *names, size_t *out) {
    for (*out = 0; *out < n; ++*out) {
        if (strlen(names[*out]) == length && strncmp(word, names[*out], length) == 0)
            return true;
    }
    return false;
}

static int refuse_name(option_id id, const char *word, size_t length, size_t n,
                       const char *const *names) {
    char all[512] = "", given[64];
    size_t used = 0;
    const char *closest;

    snprintf(given, sizeof given, "%.*s", (int)(length < 60 ? length : 60), word);
    for (size_t i = 0; i < n; i++)
        used += (size_t)snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "",
                                 names[i]);
    closest = cli_closest(given, n, names);
    return cli_usage("--%s: unknown name '%s'; %s%s%sallowed: %s",
                     option_table[id].name, given, closest ? "did you mean '" : "",
                     closest ? closest : "", closest ? "'? " : "", all);
}

enum { NAMES_MAX = 64 };

/* The names of a list as numbers; each once. */
static int read_names(const invocation *call, option_id id, size_t n,
                      const char *const *names, size_t chosen[NAMES_MAX],
                      size_t *n_chosen) {
    const char *at = option_text(call, id);

    for (*n_chosen = 0;; at++) {
        size_t length = strcspn(at, ","), which;
        if (!find_name(at, length, n, names, &which))
            return refuse_name(id, at, length, n, names);
        for (size_t i = 0; i < *n_chosen; i++) {
            if (chosen[i] == which)
                return cli_usage("--%s: '%s' is there twice; allowed: each name once",
                                 option_table[id].name, names[which]);
        }
        chosen[(*n_chosen)++] = which;
        at += length;
        if (*at == '\0')
            return CLI_DONE;
    }
}

/* The G-factor is for those that take one; somebody must. */
static int check_compensation(const invocation *call, const tree_asked *asked) {
    bool any = strcmp(option_text(call, OPT_COMPENSATE), "none") == 0;

    for (size_t i = 0; i < asked->n_methods; i++)
        any = any || asked->method[i].compensates;
    return any ? CLI_DONE
               : cli_usage("--compensate: '%.60s' is for models that take a G-factor; "
                           "--model '%.60s' names none (ppscat tree models)",
                           call->text[OPT_COMPENSATE], option_text(call, OPT_MODEL));
}

int tree_asked_read(const invocation *call, tree_asked *out) {
    const char *methods[NAMES_MAX], *components[TREE_COMPONENTS];
    size_t method[NAMES_MAX], component[NAMES_MAX];
    int rc;

    *out = (tree_asked){0};
    for (size_t i = 0; i < tree_method_count(); i++)
        methods[i] = tree_method_at(i).name;
    for (size_t i = 0; i < TREE_COMPONENTS; i++)
        components[i] = tree_components[i].name;
    rc = read_names(call, OPT_MODEL, tree_method_count(), methods, method,
                    &out->n_methods);
    if (rc == CLI_DONE)
        rc = read_names(call, OPT_COMPONENT, TREE_COMPONENTS, components, component,
                        &out->n_components);
    if (rc != CLI_DONE)
        return rc;
    out->method = malloc(out->n_methods * sizeof *out->method);
    out->component = malloc(out->n_components * sizeof *out->component);
    if (!out->method || !out->component)
        return cli_no_memory();
    for (size_t i = 0; i < out->n_methods; i++)
        out->method[i] = tree_method_at(method[i]);
    for (size_t i = 0; i < out->n_components; i++)
        out->component[i] = &tree_components[component[i]];
    return check_compensation(call, out);
}

void tree_asked_free(tree_asked *asked) {
    free(asked->method);
    free(asked->component);
}

/* ---- running ---- */

static bool keep_going(void *user, uint64_t done, uint64_t total) {
    progress_meter *meter = user;

    meter->total = (size_t)total;
    progress_count(meter, (size_t)done - atomic_load(&meter->done));
    progress_show(meter);
    return !system_signal();
}

/* Monte Carlo, with a progress line, stopped by an interrupt. */
static pps_status run_reference(const tree_work *work, const tree_method *method,
                                unsigned sources, pps_irradiance **out) {
    pps_trace_options options = work->settings->trace;
    progress_meter meter;
    pps_status status;

    system_watch_signals();
    progress_start(&meter, work->settings->progress, (size_t)options.rays);
    options.sources = sources;
    options.progress = keep_going;
    options.user = &meter;
    status = method->kind == TREE_TRACE
                 ? pps_trace_light(work->scene, &options, out, NULL)
                 : pps_gather_light(work->scene, 0, NULL,
                                    work->settings->gather_samples, &options, out);
    progress_end(&meter);
    return status;
}

static pps_status need_cells(tree_work *work) {
    const pps_cells_options *options = &work->settings->cells;
    pps_status status = PPS_OK;

    if (!work->cells) {
        status = pps_cells_create(work->scene, options, &work->cells);
        if (!status)
            status = pps_cells_set_sun(work->cells, work->scene, options);
    }
    return status;
}

static pps_status run_model(tree_work *work, const pps_light_model *model,
                            unsigned sources, tree_answer *out) {
    pps_light_options options = work->settings->light;
    pps_status status = model->per_leaf ? PPS_OK : need_cells(work);

    options.sources = sources;
    if (!model->compensates)
        options.compensate = PPS_COMPENSATE_NONE;
    if (status)
        return status;
    if (model->per_leaf)
        return pps_light_model_run(model, work->scene, NULL, &options, &out->light);
    status =
        pps_light_field_solve(model, work->scene, work->cells, &options, &out->field);
    return status ? status
                  : pps_light_field_leaves(out->field, work->scene, work->cells,
                                           sources, &out->light);
}

int tree_answer_find(tree_work *work, const tree_method *method,
                     const tree_component *component, tree_answer *out,
                     const char **why) {
    unsigned sources = component->sources & method->sources;
    pps_status status;

    *out = (tree_answer){0};
    if (!sources) {
        *why = "the model does not know this light";
        return CLI_REFUSED;
    }
    status = method->kind == TREE_MODEL
                 ? run_model(work, method->model, sources, out)
                 : run_reference(work, method, sources, &out->light);
    if (status == PPS_ERR_CANCELLED)
        return cli_failed("interrupted; nothing is written");
    if (status == PPS_ERR_UNSUPPORTED) {
        *why = pps_status_string(status);
        return CLI_REFUSED;
    }
    return status ? cli_failed("%s: %s", method->name, pps_status_string(status))
                  : CLI_DONE;
}

void tree_answer_free(tree_answer *answer) {
    pps_irradiance_free(answer->light);
    pps_light_field_free(answer->field);
    *answer = (tree_answer){0};
}

void tree_work_free(tree_work *work) { pps_cells_free(work->cells); }

tree_place tree_answer_place(const tree_work *work, const tree_answer *answer,
                             size_t leaf) {
    const pps_light_field *field = answer->field;

    if (!field)
        return (tree_place){NAN, NAN, NAN, NAN};
    uint32_t c = work->cells->cell_of[leaf];
    return (tree_place){(double)field->depth[c], (double)field->thickness[c],
                        (double)field->sun[c], (double)field->g_factor[c]};
}
