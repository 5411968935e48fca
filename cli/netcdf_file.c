/* The results of a sweep as NetCDF-4 by the CF conventions, so that xarray and its like
 * open them as labelled arrays.
 *
 * Every parameter is a dimension with its coordinate variable; every column of results is
 * a variable over all of them. Depths that are the same for every thickness are the axis
 * `depth`. Where they are shares of the thickness the axis is `share`, from 0 to 1, else
 * it is `level`, and the depths are an auxiliary coordinate depth(thickness, share or
 * level). What was refused, and the levels that a half-space lacks, is _FillValue.
 *
 * The file is written chunk by chunk. A chunk is a run of cells in the order of the rows.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "netcdf_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <netcdf.h>

#include "cli.h"
#include "columns.h"
#include "metadata.h"
#include "system.h"
#include "values.h"

enum {
    MOST_AXES = 8,
    MOST_VARIABLES = 8,
    CHUNK_CELLS = 1 << 16, /* half a MiB */
    BLOCK_CASES = 1 << 12
};

/* One file being written. `status` is the first failure of netCDF; all is skipped after
 * one, so that it need be looked at once. */
typedef struct {
    const sweep_task *task;
    const sweep_plan *plan;
    const case_grid *grid;
    const column *columns; /* one an axis, then one a variable */
    const store *values;
    int status, id;
    int n_axes, dimension[MOST_AXES];
    size_t length[MOST_AXES], chunk[MOST_AXES];
    const char *depth_axis; /* depth, share or level; NULL without */
    int n_variables, variable[MOST_VARIABLES];
    int coordinate[MOST_AXES], depth; /* variables */
    uint64_t at;                      /* bytes of the values that are read */
} netcdf;

/* Do a call of netCDF unless one has failed. */
#define TRY(file, call) ((file)->status = (file)->status ? (file)->status : (call))

static void put_text(netcdf *f, int variable, const char *name, const char *text) {
    TRY(f, nc_put_att_text(f->id, variable, name, strlen(text), text));
}

/* ---- what is in the file ---- */

/* The longest list of depths: the others, of half-spaces, are its beginning. */
static const depth_list *longest_depths(const case_grid *grid) {
    const depth_list *depth = grid->depth;

    while (depth->n < grid->max_depths)
        depth++;
    return depth;
}

static const char *choose_depth_axis(const case_grid *grid) {
    const depth_list *longest = longest_depths(grid);
    bool same = true, shares = true;

    for (size_t i = 0; i < grid->thickness.n; i++)
        same &= grid->depth[i].n == longest->n &&
                memcmp(grid->depth[i].tau, longest->tau,
                       longest->n * sizeof *longest->tau) == 0;
    for (size_t k = 0; k < longest->n; k++)
        shares &= !isnan(longest->share[k]);
    return same ? "depth" : shares ? "share" : "level";
}

static void measure(netcdf *f) {
    const case_grid *grid = f->grid;
    const size_t length[MOST_AXES] = {
        grid->n_methods, grid->albedo.n,   grid->g.n,  grid->thickness.n,
        grid->mu0.n,     grid->max_depths, grid->mu.n, grid->phi.n};
    size_t cells = CHUNK_CELLS;

    f->n_axes = f->plan->shape == ROWS_CASE ? 5 : f->plan->shape == ROWS_DEPTHS ? 6 : 8;
    memcpy(f->length, length, sizeof length);
    for (int i = f->n_axes - 1; i >= 0; i--) { /* all of the last axes, part of one */
        f->chunk[i] = length[i] < cells ? length[i] : cells;
        cells = f->chunk[i] < length[i] ? 1 : cells / (length[i] ? length[i] : 1);
        cells = cells ? cells : 1;
    }
    if (f->n_axes > 5)
        f->depth_axis = choose_depth_axis(grid);
    for (const column *c = f->columns + f->n_axes; c->name; c++)
        f->n_variables++;
}

static const char *axis_name(const netcdf *f, int i) {
    return i == 5 ? f->depth_axis : f->columns[i].name;
}

static void describe(netcdf *f, int variable, const char *unit, const char *text) {
    if (unit)
        put_text(f, variable, "units", unit);
    put_text(f, variable, "long_name", text);
}

static void define_axes(netcdf *f) {
    for (int i = 0; i < f->n_axes; i++)
        TRY(f, nc_def_dim(f->id, axis_name(f, i), f->length[i], &f->dimension[i]));
    for (int i = 0; i < f->n_axes; i++) {
        const column *c = &f->columns[i];
        TRY(f, nc_def_var(f->id, axis_name(f, i), i == 0 ? NC_STRING : NC_DOUBLE, 1,
                          &f->dimension[i], &f->coordinate[i]));
        if (strcmp(axis_name(f, i), "share") == 0)
            describe(f, f->coordinate[i], "1", "optical depth / thickness");
        else if (strcmp(axis_name(f, i), "level") == 0)
            describe(f, f->coordinate[i], "1", "number of the depth in its list");
        else
            describe(f, f->coordinate[i], c->unit, c->description);
    }
}

/* depth(thickness, share or level) */
static void define_depths(netcdf *f) {
    const int axes[] = {f->dimension[3], f->dimension[5]};
    const double fill = NC_FILL_DOUBLE;

    TRY(f, nc_def_var(f->id, "depth", NC_DOUBLE, 2, axes, &f->depth));
    TRY(f, nc_put_att_double(f->id, f->depth, "_FillValue", NC_DOUBLE, 1, &fill));
    describe(f, f->depth, f->columns[5].unit, f->columns[5].description);
}

static void define_variable(netcdf *f, int i, bool auxiliary, int deflate) {
    const column *c = &f->columns[f->n_axes + i];
    const double fill = NC_FILL_DOUBLE;
    int *variable = &f->variable[i];

    TRY(f, nc_def_var(f->id, c->name, NC_DOUBLE, f->n_axes, f->dimension, variable));
    TRY(f, nc_def_var_chunking(f->id, *variable, NC_CHUNKED, f->chunk));
    if (deflate) /* shuffled: alike bytes together */
        TRY(f, nc_def_var_deflate(f->id, *variable, 1, 1, deflate));
    TRY(f, nc_set_var_chunk_cache(f->id, *variable, 4 * CHUNK_CELLS * sizeof(double),
                                  97, 1));
    TRY(f, nc_put_att_double(f->id, *variable, "_FillValue", NC_DOUBLE, 1, &fill));
    describe(f, *variable, c->unit, c->description);
    if (auxiliary)
        put_text(f, *variable, "coordinates", "depth");
}

/* How the file was made: `history` for people, `ppscat` as JSON for programs. */
static void put_origin(netcdf *f, const invocation *call, const record *done) {
    char *notes = metadata_notes(call, done);
    char date[DATE_SIZE], source[64];
    buffer history = {0};

    snprintf(source, sizeof source, "ppscat %s", pps_version());
    metadata_date(date);
    buffer_append(&history, date, strlen(date));
    buffer_append(&history, ": ppscat", 8);
    for (int i = 1; i < call->argc; i++) {
        buffer_append(&history, " ", 1);
        buffer_append(&history, call->argv[i], strlen(call->argv[i]));
    }
    put_text(f, NC_GLOBAL, "Conventions", "CF-1.8");
    put_text(f, NC_GLOBAL, "title", subcommand_table[call->subcommand].summary);
    put_text(f, NC_GLOBAL, "source", source);
    TRY(f, nc_put_att_text(f->id, NC_GLOBAL, "history", history.n, history.data));
    if (notes)
        put_text(f, NC_GLOBAL, "ppscat", notes);
    else
        TRY(f, NC_ENOMEM);
    buffer_free(&history);
    free(notes);
}

/* ---- coordinates ---- */

static void put_depths(netcdf *f) {
    const case_grid *grid = f->grid;

    for (size_t i = 0; i < grid->thickness.n; i++) {
        const size_t start[] = {i, 0}, count[] = {1, grid->depth[i].n};
        TRY(f, nc_put_vara_double(f->id, f->depth, start, count, grid->depth[i].tau));
    }
}

static void put_numbers(netcdf *f, size_t n) {
    double *number = malloc(n * sizeof *number);

    for (size_t k = 0; number && k < n; k++)
        number[k] = (double)k;
    TRY(f, number ? nc_put_var_double(f->id, f->coordinate[5], number) : NC_ENOMEM);
    free(number);
}

static void put_axes(netcdf *f) {
    const case_grid *grid = f->grid;
    const double *value[MOST_AXES] = {NULL,
                                      grid->albedo.value,
                                      grid->g.value,
                                      grid->thickness.value,
                                      grid->mu0.value,
                                      NULL,
                                      grid->mu.value,
                                      grid->phi.value};

    for (size_t m = 0; m < grid->n_methods; m++)
        TRY(f, nc_put_var1_string(f->id, f->coordinate[0], &m,
                                  (const char *[]){grid->method[m]->name}));
    if (f->depth_axis && strcmp(f->depth_axis, "depth") == 0)
        value[5] = longest_depths(grid)->tau;
    else if (f->depth_axis && strcmp(f->depth_axis, "share") == 0)
        value[5] = longest_depths(grid)->share;
    else if (f->depth_axis)
        put_numbers(f, grid->max_depths);
    for (int i = 1; i < f->n_axes; i++) {
        if (value[i])
            TRY(f, nc_put_var_double(f->id, f->coordinate[i], value[i]));
    }
}

/* ---- results ---- */

/* The next values in their order. */
static int read_next(netcdf *f, size_t n, double *values) {
    int rc = store_read(f->values, f->at, values, n * sizeof *values);

    f->at += n * sizeof *values;
    return rc;
}

/* n cells from number `first` on, values[cell * n_values + variable]; NAN at the levels
 * that a slab does not have, which the store has not either. */
static int read_rows(netcdf *f, uint64_t first, size_t n, double *values) {
    const case_grid *grid = f->grid;
    size_t n_values = (size_t)f->n_variables, level_cells = 1;
    bool ragged = false;

    for (size_t i = 0; i < grid->thickness.n; i++)
        ragged |= grid->depth[i].n != grid->max_depths;
    if (!ragged)
        return read_next(f, n * n_values, values);
    for (int i = 6; i < f->n_axes; i++)
        level_cells *= f->length[i];
    for (size_t done = 0, run; done < n; done += run) {
        uint64_t level = (first + done) / level_cells, slab;
        run = level_cells - (size_t)((first + done) % level_cells);
        run = run < n - done ? run : n - done;
        slab = level / grid->max_depths / grid->mu0.n % grid->thickness.n;
        if (level % grid->max_depths < grid->depth[slab].n) {
            if (read_next(f, run * n_values, values + done * n_values) != CLI_DONE)
                return CLI_FAILED;
        } else {
            for (size_t i = 0; i < run * n_values; i++)
                values[done * n_values + i] = (double)NAN;
        }
    }
    return CLI_DONE;
}

/* The same of ROWS_CASE: in the store all methods of a case are together. */
static int read_cases(netcdf *f, uint64_t first, size_t n, double *values) {
    size_t per_row = (size_t)f->n_variables, per_case = f->task->n_values;
    double *block = malloc(BLOCK_CASES * per_case * sizeof *block);
    int rc = CLI_DONE;

    if (!block)
        return cli_no_memory();
    for (size_t done = 0, run; done < n && rc == CLI_DONE; done += run) {
        uint64_t method = (first + done) / f->plan->cases;
        uint64_t at = (first + done) % f->plan->cases, left = f->plan->cases - at;
        run = n - done < BLOCK_CASES ? n - done : BLOCK_CASES;
        run = left < run ? (size_t)left : run;
        rc = store_read(f->values, at * per_case * sizeof *block, block,
                        run * per_case * sizeof *block);
        for (size_t i = 0; i < run && rc == CLI_DONE; i++)
            memcpy(values + (done + i) * per_row,
                   block + i * per_case + (size_t)method * per_row,
                   per_row * sizeof *values);
    }
    free(block);
    return rc;
}

/* One chunk of every variable. */
static void put_chunk(netcdf *f, const size_t *start, const size_t *count, size_t cells,
                      const double *values, double *one) {
    for (int v = 0; v < f->n_variables; v++) {
        for (size_t i = 0; i < cells; i++) {
            double x = values[i * (size_t)f->n_variables + (size_t)v];
            one[i] = isnan(x) ? NC_FILL_DOUBLE : x;
        }
        TRY(f, nc_put_vara_double(f->id, f->variable[v], start, count, one));
    }
}

/* Begin and extent of the chunk that begins at this cell. */
static size_t chunk_at(const netcdf *f, uint64_t cell, size_t *start, size_t *count) {
    size_t cells = 1;

    for (int i = f->n_axes - 1; i >= 0; i--) {
        start[i] = (size_t)(cell % f->length[i]);
        cell /= f->length[i];
        count[i] = f->length[i] - start[i];
        count[i] = f->chunk[i] < count[i] ? f->chunk[i] : count[i];
        cells *= count[i];
    }
    return cells;
}

static int put_results(netcdf *f) {
    size_t n_values = (size_t)f->n_variables, start[MOST_AXES], count[MOST_AXES];
    double *values = calloc(CHUNK_CELLS * (n_values + 1), sizeof *values);
    uint64_t n_cells = 1, cells;
    int rc = values ? CLI_DONE : cli_no_memory();

    for (int i = 0; i < f->n_axes; i++)
        n_cells *= f->length[i];
    for (uint64_t at = 0; at < n_cells && rc == CLI_DONE && !f->status; at += cells) {
        cells = chunk_at(f, at, start, count);
        rc = f->plan->shape == ROWS_CASE ? read_cases(f, at, (size_t)cells, values)
                                         : read_rows(f, at, (size_t)cells, values);
        if (rc == CLI_DONE)
            put_chunk(f, start, count, (size_t)cells, values,
                      values + CHUNK_CELLS * n_values);
        if (system_signal())
            rc = CLI_FAILED;
    }
    free(values);
    return rc;
}

__attribute__((visibility("default"))) int
netcdf_file_write(const char *path, const invocation *call, const sweep_task *task,
                  const sweep_plan *plan, const store *values, const record *done) {
    netcdf f = {.task = task,
                .plan = plan,
                .grid = task->grid,
                .columns = columns_of(call->subcommand),
                .values = values};
    bool auxiliary;
    int rc = CLI_DONE, closed, deflate = 0;

    value_whole(option_text(call, OPT_DEFLATE), 0, 9, &deflate);
    measure(&f);
    auxiliary = f.depth_axis && strcmp(f.depth_axis, "depth") != 0;
    f.status = nc_create(path, NC_NETCDF4 | NC_CLOBBER, &f.id);
    if (f.status)
        return cli_failed("cannot write %.200s: %s", path, nc_strerror(f.status));
    define_axes(&f);
    if (auxiliary)
        define_depths(&f);
    for (int i = 0; i < f.n_variables; i++)
        define_variable(&f, i, auxiliary, deflate);
    put_origin(&f, call, done);
    TRY(&f, nc_enddef(f.id));
    put_axes(&f);
    if (auxiliary)
        put_depths(&f);
    rc = put_results(&f);
    closed = nc_close(f.id);
    TRY(&f, closed);
    if (f.status)
        rc = cli_failed("cannot write %.200s: %s", path, nc_strerror(f.status));
    if (rc != CLI_DONE)
        unlink(path);
    return rc;
}
