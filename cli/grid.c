/* From options to the case grid, with every check that can be made before computing.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "grid.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "csv.h"
#include "directions.h"
#include "names.h"
#include "values.h"

enum {
    DEFAULT_NODES = 8,  /* Gauss nodes a hemisphere: --mu */
    ERROR_NODES = 16,   /* the same for `error` */
    ERROR_AZIMUTHS = 19 /* every 10 degrees */
};

static const double error_depth_cap = 10;
static const char error_depths[] = "0%,5%,10%,20%,30%,40%,50%,60%,75%,90%,100%";

static int read_list(const invocation *call, option_id id, number_list *out) {
    return value_list(id, option_text(call, id), out);
}

/* An angle's option, or the cosine's. */
static int read_cosines(const invocation *call, option_id angle, option_id cosine,
                        number_list *out) {
    int rc;

    if (option_given(call, angle) && option_given(call, cosine))
        return cli_usage(
            "--%s '%.60s' and --%s '%.60s' contradict each other; allowed: "
            "one of them",
            option_table[cosine].name, call->text[cosine], option_table[angle].name,
            call->text[angle]);
    if (!option_given(call, angle))
        return read_list(call, cosine, out);
    rc = read_list(call, angle, out);
    for (size_t i = 0; i < out->n; i++)
        out->value[i] = cos_degrees(out->value[i]);
    return rc;
}

/* ---- methods ---- */

static const char *method_name(size_t i) {
    size_t n;

    return pps_method_table(&n)[i]->name;
}

static int read_methods(const invocation *call, case_grid *grid) {
    name_table table = {.kind = "method", .name = method_name};
    const pps_method *const *method = pps_method_table(&table.n);
    name_list chosen;
    int rc = names_read(call, OPT_METHOD, &table, &chosen);

    if (rc != CLI_DONE)
        return rc;
    /* an array of pointers: NOLINTNEXTLINE(bugprone-sizeof-expression) */
    grid->method = malloc(chosen.n * sizeof *grid->method);
    if (!grid->method)
        return cli_no_memory();
    grid->n_methods = chosen.n;
    for (size_t i = 0; i < chosen.n; i++)
        grid->method[i] = method[chosen.index[i]];
    return CLI_DONE;
}

/* ---- depths ---- */

/* What depth item i of a list means in a slab; a share is of min(thickness, cap). */
static int resolve_depth(const number_list *list, size_t i, double thickness,
                         double cap, double *tau) {
    char x[CSV_NUMBER_SIZE], w[CSV_NUMBER_SIZE], what[160];

    csv_format(list->value[i], x);
    csv_format(thickness, w);
    *tau = list->value[i];
    if (list->share[i] && isinf(fmin(thickness, cap))) {
        snprintf(what, sizeof what, "'%s%%' is no share of --thickness inf", x);
        return value_refuse(OPT_DEPTH, what);
    }
    if (list->share[i])
        *tau = list->value[i] / 100 * fmin(thickness, cap);
    if (*tau > thickness) {
        snprintf(what, sizeof what, "'%s' is beyond --thickness '%s'", x, w);
        return value_refuse(OPT_DEPTH, what);
    }
    return CLI_DONE;
}

static int resolve_depths(case_grid *grid, const number_list *list, size_t i_thickness,
                          double cap) {
    depth_list *depth = &grid->depth[i_thickness];

    depth->tau = malloc(2 * list->n * sizeof *depth->tau);
    if (!depth->tau)
        return cli_no_memory();
    depth->n = list->n;
    depth->share = depth->tau + list->n;
    if (depth->n > grid->max_depths)
        grid->max_depths = depth->n;
    for (size_t i = 0; i < list->n; i++) {
        int rc = resolve_depth(list, i, grid->thickness.value[i_thickness], cap,
                               &depth->tau[i]);
        depth->share[i] = list->share[i]        ? list->value[i] / 100
                          : list->value[i] == 0 ? 0
                                                : (double)NAN;
        if (rc != CLI_DONE)
            return rc;
    }
    return CLI_DONE;
}

/* The list of depths for a slab as text; what the option's default means. */
static const char *depth_text(const invocation *call, grid_kind kind,
                              double thickness) {
    if (option_given(call, OPT_DEPTH))
        return call->text[OPT_DEPTH];
    if (kind == GRID_ERROR)
        return error_depths;
    return isinf(thickness) ? "0" : "0,50%,100%";
}

static int read_depths(const invocation *call, grid_kind kind, case_grid *grid) {
    double cap = INFINITY;
    size_t n = grid->thickness.n;

    if (kind == GRID_ERROR && !option_given(call, OPT_DEPTH))
        cap = error_depth_cap;
    grid->depth = calloc(n, sizeof *grid->depth);
    if (!grid->depth)
        return cli_no_memory();
    for (size_t i = 0; i < n; i++) {
        number_list list;
        const char *text = depth_text(call, kind, grid->thickness.value[i]);
        int rc = value_list(OPT_DEPTH, text, &list);
        if (rc == CLI_DONE)
            rc = resolve_depths(grid, &list, i, cap);
        list_free(&list);
        if (rc != CLI_DONE)
            return rc;
    }
    return CLI_DONE;
}

/* ---- directions ---- */

static int allocate(size_t n, number_list *list, double **weight) {
    free(list->value);
    list->value = malloc(n * sizeof *list->value);
    list->n = list->value ? n : 0;
    free(*weight);
    *weight = malloc(n * sizeof **weight);
    return list->value && *weight ? CLI_DONE : cli_no_memory();
}

static int equal_weights(size_t n, double **weight) {
    *weight = malloc(n * sizeof **weight);
    if (!*weight)
        return cli_no_memory();
    for (size_t i = 0; i < n; i++)
        (*weight)[i] = 1 / (double)n;
    return CLI_DONE;
}

static int read_cosines_of_travel(const invocation *call, grid_kind kind,
                                  case_grid *grid) {
    size_t n = kind == GRID_ERROR ? ERROR_NODES : DEFAULT_NODES;
    int rc;

    if (option_given(call, OPT_MU) || option_given(call, OPT_THETA)) {
        rc = read_cosines(call, OPT_THETA, OPT_MU, &grid->mu);
        return rc == CLI_DONE ? equal_weights(grid->mu.n, &grid->mu_weight) : rc;
    }
    rc = allocate(2 * n, &grid->mu, &grid->mu_weight);
    if (rc == CLI_DONE)
        gauss_sphere(n, grid->mu.value, grid->mu_weight);
    return rc;
}

static int read_azimuths(const invocation *call, grid_kind kind, case_grid *grid) {
    int rc;

    if (option_given(call, OPT_PHI) || kind != GRID_ERROR) {
        rc = read_list(call, OPT_PHI, &grid->phi);
        return rc == CLI_DONE ? equal_weights(grid->phi.n, &grid->phi_weight) : rc;
    }
    rc = allocate(ERROR_AZIMUTHS, &grid->phi, &grid->phi_weight);
    if (rc == CLI_DONE)
        even_azimuths(ERROR_AZIMUTHS, grid->phi.value, grid->phi_weight);
    return rc;
}

/* ---- all of it ---- */

static int read_lists(const invocation *call, grid_kind kind, case_grid *grid) {
    int rc = read_methods(call, grid);

    if (rc == CLI_DONE)
        rc = read_list(call, OPT_ALBEDO, &grid->albedo);
    if (rc == CLI_DONE)
        rc = read_list(call, OPT_G, &grid->g);
    if (rc == CLI_DONE)
        rc = read_list(call, OPT_THICKNESS, &grid->thickness);
    if (rc == CLI_DONE)
        rc = read_cosines(call, OPT_THETA0, OPT_MU0, &grid->mu0);
    if (rc == CLI_DONE)
        rc = read_depths(call, kind, grid);
    if (rc == CLI_DONE)
        rc = read_cosines_of_travel(call, kind, grid);
    return rc == CLI_DONE ? read_azimuths(call, kind, grid) : rc;
}

static int read_light(const invocation *call, case_grid *grid) {
    double sky, ground;
    int rc = value_number(call, OPT_BEAM, &grid->beam);

    if (rc == CLI_DONE)
        rc = value_number(call, OPT_SKY, &sky);
    if (rc == CLI_DONE)
        rc = value_number(call, OPT_GROUND, &ground);
    if (rc != CLI_DONE)
        return rc;
    /* Without a sky everything is linear in the beam, which may then be 0 as well. */
    grid->options.light = (pps_light){.beam = 1, .ground = ground};
    if (sky > 0) {
        grid->options.light.beam = grid->beam;
        grid->options.light.sky = sky;
        grid->beam = 1;
    }
    return CLI_DONE;
}

static int read_streams(const invocation *call, int *out) {
    const char *text = option_text(call, OPT_STREAMS);

    *out = 0;
    if (strcmp(text, "auto") == 0)
        return CLI_DONE;
    if (!value_whole(text, 2, PPS_STREAMS_MAX, out) || *out % 2)
        return cli_usage(
            "--streams: '%.60s' is not possible; allowed: even numbers from "
            "2 to %d, or auto",
            text, PPS_STREAMS_MAX);
    return CLI_DONE;
}

static int read_solver(const invocation *call, pps_options *options) {
    int nodes = 0, delta_m = 0, of = 0;
    int rc = value_number(call, OPT_TOL, &options->tolerance);

    if (rc == CLI_DONE)
        rc = read_streams(call, &options->streams);
    if (rc == CLI_DONE)
        rc = value_choice(call, OPT_NODES, &nodes);
    if (rc == CLI_DONE)
        rc = value_choice(call, OPT_DELTA_M, &delta_m);
    if (rc == CLI_DONE)
        rc = value_choice(call, OPT_TOL_OF, &of);
    options->tolerance_of = (pps_tolerance_of)of;
    options->nodes = (pps_nodes)nodes;
    options->delta_m = (pps_delta_m)delta_m;
    if (rc == CLI_DONE && options->delta_m == PPS_DELTA_M_OFF &&
        options->nodes > PPS_NODES_GAUSS)
        return cli_usage(
            "--nodes 'mapped' or 'graded' contradicts --delta-m 'off', the plain "
            "discrete problem on Gauss nodes; allowed: gauss, auto");
    return rc;
}

static int read_sampling(const invocation *call, pps_options *options) {
    int rc = value_count(call, OPT_PHOTONS, 1, 1000000000000, &options->photons);

    return rc == CLI_DONE ? value_count(call, OPT_SEED, 0, UINT64_MAX, &options->seed)
                          : rc;
}

static int read_running(const invocation *call, case_grid *grid) {
    int rc = value_threads(call, &grid->threads);

    if (rc == CLI_DONE)
        rc = value_progress(call, &grid->progress);
    return rc;
}

/* Every count that follows is a size_t; this keeps their products in range. */
static int check_size(const case_grid *grid, grid_kind kind) {
    double rows = (double)grid->n_methods * (double)grid->albedo.n * (double)grid->g.n *
                  (double)grid->thickness.n * (double)grid->mu0.n *
                  (double)grid->max_depths;

    if (kind != GRID_FLUX)
        rows *= (double)grid->mu.n * (double)grid->phi.n;
    if (rows > 1e15)
        return cli_usage("the lists ask for %.1e rows; allowed: up to 1e15", rows);
    return CLI_DONE;
}

int grid_init(case_grid *grid, const invocation *call, grid_kind kind) {
    int rc;

    *grid = (case_grid){0};
    rc = read_lists(call, kind, grid);
    if (rc == CLI_DONE)
        rc = read_light(call, grid);
    if (rc == CLI_DONE)
        rc = read_solver(call, &grid->options);
    if (rc == CLI_DONE)
        rc = read_sampling(call, &grid->options);
    if (rc == CLI_DONE)
        rc = read_running(call, grid);
    return rc == CLI_DONE ? check_size(grid, kind) : rc;
}

void grid_free(case_grid *grid) {
    for (size_t i = 0; grid->depth && i < grid->thickness.n; i++)
        free(grid->depth[i].tau);
    free(grid->depth);
    free(grid->method);
    list_free(&grid->albedo);
    list_free(&grid->g);
    list_free(&grid->thickness);
    list_free(&grid->mu0);
    list_free(&grid->mu);
    list_free(&grid->phi);
    free(grid->mu_weight);
    free(grid->phi_weight);
    *grid = (case_grid){0};
}
