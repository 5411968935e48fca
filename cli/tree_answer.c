/* Asking light models and Monte Carlo.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree_answer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "names.h"
#include "progress.h"
#include "system.h"

static const tree_method references[] = {
    {.kind = TREE_TRACE,
     .name = "mc",
     .summary = "Monte Carlo: light traced from sun and sky, all bounces",
     .source = "",
     .sources = PPS_ALL_LIGHT},
    {.kind = TREE_GATHER,
     .name = "gather",
     .summary = "Monte Carlo: light gathered backwards from every leaf",
     .source = "",
     .sources = PPS_ALL_LIGHT},
};
enum { N_REFERENCES = sizeof references / sizeof references[0] };

size_t tree_method_count(void) { return pps_light_model_count() + N_REFERENCES; }

tree_method tree_method_at(size_t i) {
    if (i >= pps_light_model_count())
        return references[i - pps_light_model_count()];
    const pps_light_model *m = pps_light_model_at(i);
    tree_method method = {.kind = TREE_MODEL,
                          .summary = m->summary,
                          .source = m->source,
                          .sources = m->sources,
                          .compensates = m->compensates,
                          .model = m};
    snprintf(method.name, sizeof method.name, "%s", m->name);
    return method;
}

size_t tree_method_find(const char *name) {
    size_t i = 0;

    while (i < tree_method_count() && strcmp(tree_method_at(i).name, name) != 0)
        i++;
    return i;
}

/* ---- what was asked ---- */

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

/* What --model takes: every method, and those with a G-factor also with one of their own,
 * as "spp+derived". */
static tree_method choice[NAMES_MAX];

static size_t fill_choices(void) {
    static const struct {
        const char *name;
        pps_compensation form;
    } factor[] = {
#define ROW(name, form) {name, form},
        PPS_COMPENSATION_LIST(ROW)
#undef ROW
    };
    size_t n = 0;

    while (n < tree_method_count()) {
        choice[n] = tree_method_at(n);
        n++;
    }
    for (size_t i = 0; i < tree_method_count(); i++) {
        for (int k = 1; k < 3 && choice[i].compensates && n < NAMES_MAX; k++, n++) {
            choice[n] = choice[i];
            choice[n].compensate = factor[k].form;
            snprintf(choice[n].name, sizeof choice[n].name, "%s+%s",
                     choice[i].model->name, factor[k].name);
        }
    }
    return n;
}

static const char *choice_name(size_t i) { return choice[i].name; }

static const char *component_name(size_t i) { return tree_components[i].name; }

int tree_asked_read(const invocation *call, bool split, tree_asked *out) {
    name_table methods = {"model", fill_choices(), choice_name};
    name_table components = {
        "component", split ? TREE_COMPONENTS_SPLIT : TREE_COMPONENTS, component_name};
    name_list method, component;
    int rc = names_read(call, OPT_MODEL, &methods, &method);

    *out = (tree_asked){0};
    if (rc == CLI_DONE)
        rc = names_read(call, OPT_COMPONENT, &components, &component);
    if (rc != CLI_DONE)
        return rc;
    out->method = malloc(method.n * sizeof *out->method);
    out->component = malloc(component.n * sizeof *out->component);
    if (!out->method || !out->component)
        return cli_no_memory();
    out->n_methods = method.n;
    for (size_t i = 0; i < method.n; i++)
        out->method[i] = choice[method.index[i]];
    out->n_components = component.n;
    for (size_t i = 0; i < component.n; i++)
        out->component[i] = &tree_components[component.index[i]];
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

static pps_status need_attenuations(tree_work *work) {
    pps_attenuation_options options = {.threads = work->settings->threads};

    return work->att ? PPS_OK
                     : pps_leaf_attenuation_create(work->scene, &options, &work->att);
}

static pps_status run_model(tree_work *work, const tree_method *method,
                            unsigned sources, tree_answer *out) {
    const pps_light_model *model = method->model;
    pps_light_options options = work->settings->light;
    pps_status status = model->without_cells ? PPS_OK : need_cells(work);

    if (!status && model->takes_attenuations)
        status = need_attenuations(work);
    options.att = work->att;
    options.sources = sources;
    if (method->compensate)
        options.compensate = method->compensate;
    if (!model->compensates)
        options.compensate = PPS_COMPENSATE_NONE;
    if (status)
        return status;
    if (model->without_field)
        return pps_light_model_run(model, work->scene, work->cells, &options,
                                   &out->light);
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
                 ? run_model(work, method, sources, out)
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

void tree_work_free(tree_work *work) {
    pps_cells_free(work->cells);
    free(work->att);
}

tree_place tree_answer_place(const tree_work *work, const tree_answer *answer,
                             size_t leaf) {
    const pps_light_field *field = answer->field;

    if (!field)
        return (tree_place){NAN, NAN, NAN, NAN};
    uint32_t c = work->cells->cell_of[leaf];
    return (tree_place){(double)field->depth[c], (double)field->thickness[c],
                        (double)field->sun[c], (double)field->g_factor[c]};
}
