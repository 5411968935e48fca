/* Tables 1 and 2 of the SPP paper: errors of SPP and its refinement in slabs.
 *
 * A table is a run of `error` and a choice from its results. The paper does not define
 * its sampling; that of `error` was found by fitting the refined columns of Table 1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "compare.h"

enum { N_ALBEDOS = 5, N_ROWS = N_ALBEDOS + 1 /* and the total */ };

static const char albedos[] = "0.5,0.7,0.9,0.95,0.99";
static const char *const row_names[N_ROWS] = {"0.5",  "0.7",  "0.9",
                                              "0.95", "0.99", "total"};

/* A printed column: which results it is the mean of, and its figures in percent. */
typedef struct {
    const char *name;
    size_t method, g, n_g, thickness; /* indices into the lists of the table */
    double paper[N_ROWS];
} paper_column;

typedef struct {
    const char *number, *methods, *g, *thickness, *theta0;
    bool total_is_rms; /* else the mean */
    size_t n_columns;
    const paper_column *columns;
} paper_table;

/* SPP paper, Table 1. Its last row is "the total error throughout all the albedo
 * values": the mean of the column for S. to the printed digit (2.82, 3.28 and 2.82 for
 * 2.8, 3.3 and 2.9); for R. it lies between the mean and the root mean square. */
static const paper_column columns_1[] = {
    {"g=0.0 S.", 0, 0, 1, 0, {2.7, 1.9, 2.1, 2.9, 4.5, 2.8}},
    {"g=0.0 R.", 1, 0, 1, 0, {0.3, 0.5, 1.2, 1.7, 3.9, 1.7}},
    {"g=0.5 S.", 0, 1, 1, 0, {1.3, 2.1, 3.4, 4.1, 5.5, 3.3}},
    {"g=0.5 R.", 1, 1, 1, 0, {0.3, 0.7, 1.7, 2.7, 5.8, 2.5}},
    {"g=-0.5 S.", 0, 2, 1, 0, {1.2, 1.8, 2.7, 3.4, 5.0, 2.9}},
    {"g=-0.5 R.", 1, 2, 1, 0, {0.2, 0.4, 1.3, 2.0, 4.7, 2.1}},
};

/* SPP paper, Table 2: the refined solution, taken as the mean over the g of Table 1.
 * Its last row is the root mean square of the column (2.22, 2.43, 2.38 and 2.40 for
 * 2.3, 2.5, 2.4 and 2.5), not the mean (1.80 to 1.96). */
static const paper_column columns_2[] = {
    {"w=inf", 0, 0, 3, 0, {0.3, 0.7, 1.7, 2.3, 4.0, 2.3}},
    {"w=16", 0, 0, 3, 1, {0.3, 0.7, 1.7, 2.2, 4.6, 2.5}},
    {"w=10", 0, 0, 3, 2, {0.3, 0.7, 1.6, 2.1, 4.6, 2.4}},
    {"w=5", 0, 0, 3, 3, {0.4, 0.8, 1.6, 2.6, 4.4, 2.5}},
};

static const paper_table tables[] = {
    {"1", "spp,spp-refined", "0,0.5,-0.5", "10", "0:75:6", false, 6, columns_1},
    {"2", "spp-refined", "0,0.5,-0.5", "inf,16,10,5", "0:75:6", true, 4, columns_2},
};

/* What a cell of the table says, in percent. */
typedef struct {
    double rms_abs, rms_rel;
    const pps_method *refused_by;
    const char *refusal;
} cell;

/* Over all angles of incidence, for one albedo and g. */
static cell over_angles(const case_grid *grid, const comparison *result) {
    double mean_square = 0, rms_rel = 0, n = (double)grid->mu0.n;
    cell c = {0};

    for (size_t i = 0; i < grid->mu0.n; i++) {
        mean_square += result[i].mean_square / n;
        rms_rel += result[i].rms_rel / n;
        if (result[i].refusal) {
            c.refused_by = result[i].refused_by;
            c.refusal = result[i].refusal;
        }
    }
    c.rms_abs = 100 * sqrt(mean_square);
    c.rms_rel = 100 * rms_rel;
    return c;
}

/* One albedo: the mean over the column's g. */
static cell albedo_cell(const case_grid *grid, const comparison *result,
                        const paper_column *column, size_t albedo) {
    double n = (double)column->n_g;
    cell mean = {0};

    for (size_t g = column->g; g < column->g + column->n_g; g++) {
        size_t i = (column->method * N_ALBEDOS + albedo) * grid->g.n + g;
        i = (i * grid->thickness.n + column->thickness) * grid->mu0.n;
        cell one = over_angles(grid, &result[i]);
        mean.rms_abs += one.rms_abs / n;
        mean.rms_rel += one.rms_rel / n;
        if (one.refusal) {
            mean.refused_by = one.refused_by;
            mean.refusal = one.refusal;
        }
    }
    return mean;
}

/* The cells of a column: the albedos, then their total. */
static void fill_column(const paper_table *table, const case_grid *grid,
                        const comparison *result, const paper_column *column,
                        cell cells[N_ROWS]) {
    cell total = {0};

    for (size_t a = 0; a < N_ALBEDOS; a++) {
        cell c = cells[a] = albedo_cell(grid, result, column, a);
        total.rms_abs += (table->total_is_rms ? c.rms_abs * c.rms_abs : c.rms_abs);
        total.rms_rel += (table->total_is_rms ? c.rms_rel * c.rms_rel : c.rms_rel);
        if (c.refusal) {
            total.refused_by = c.refused_by;
            total.refusal = c.refusal;
        }
    }
    total.rms_abs /= N_ALBEDOS;
    total.rms_rel /= N_ALBEDOS;
    if (table->total_is_rms) {
        total.rms_abs = sqrt(total.rms_abs);
        total.rms_rel = sqrt(total.rms_rel);
    }
    cells[N_ALBEDOS] = total;
}

static int write_cell(output *out, const paper_table *table, size_t row,
                      const paper_column *column, const pps_method *method,
                      const cell *c) {
    table_row r =
        table_blank(table->number, row_names[row], column->name, method->name);

    r.paper = column->paper[row];
    r.ours = c->refusal ? CSV_EMPTY : c->rms_abs;
    r.rms_rel = c->refusal ? CSV_EMPTY : c->rms_rel;
    r.refused_by = c->refused_by;
    r.refusal = c->refusal;
    return table_write(out, &r);
}

static int write_table(const paper_table *table, const case_grid *grid, output *out,
                       const comparison *result) {
    int rc = CLI_DONE;

    for (size_t row = 0; row < N_ROWS; row++) {
        for (size_t j = 0; j < table->n_columns && rc == CLI_DONE; j++) {
            const paper_column *column = &table->columns[j];
            cell cells[N_ROWS];
            fill_column(table, grid, result, column, cells);
            rc = write_cell(out, table, row, column, grid->method[column->method],
                            &cells[row]);
        }
    }
    return rc;
}

/* The command line of the run of `error` behind the table. */
static invocation error_call(const paper_table *table, const invocation *call) {
    invocation error = *call;

    error.text[OPT_METHOD] = table->methods;
    error.text[OPT_ALBEDO] = albedos;
    error.text[OPT_G] = table->g;
    error.text[OPT_THICKNESS] = table->thickness;
    error.text[OPT_THETA0] = table->theta0;
    return error;
}

static int run(const paper_table *table, const case_grid *grid,
               const invocation *call) {
    output out;
    comparison *result;
    int rc = output_open(&out, call);

    if (rc != CLI_DONE)
        return rc;
    result = malloc(compare_count(grid) * sizeof *result);
    rc = result ? compare_run(grid, &out.record, result) : cli_no_memory();
    if (rc == CLI_DONE)
        rc = write_table(table, grid, &out, result);
    free(result);
    return output_close(&out, rc);
}

static int slab_table(const paper_table *table, const invocation *call) {
    invocation error = error_call(table, call);
    case_grid grid;
    int rc = grid_init(&grid, &error, GRID_ERROR);

    if (rc == CLI_DONE)
        rc = run(table, &grid, call);
    grid_free(&grid);
    return rc;
}

int table_1(const invocation *call) { return slab_table(&tables[0], call); }

int table_2(const invocation *call) { return slab_table(&tables[1], call); }
