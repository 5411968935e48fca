/* The hard places that `stability` walks: lists of cases as texts of options.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability_design.h"

#include <math.h>

#include "cli.h"
#include "csv.h"
#include "settings.h"

#define ALL_ALBEDOS                                                                    \
    "0,0.9,0.99,0.999,0.9999,0.99999,0.999999,0.9999999,0.99999999,0.999999999,"       \
    "0.9999999999,0.99999999999,0.999999999999,0.9999999999999,0.99999999999999,"      \
    "0.999999999999999,1"
#define ALL_THICKNESSES "1e-9:1e9:19log,inf"
#define SOME_ALBEDOS "0,0.9,0.999,0.999999,0.999999999,0.999999999999999,1"
#define SOME_THICKNESSES "1e-9,1e-6,1e-3,0.1,1,10,1e3,1e6,1e9,inf"
#define FEW_THICKNESSES "1e-6,1e-3,0.1,1,10,1e3,inf"
#define ALL_G "-0.99,-0.9,-0.5,0,0.5,0.9,0.99,0.999"

/* Albedo, g, thickness, mu0: the product of each row. */
static const char *const maps[][4] = {
    {ALL_ALBEDOS, "0.5", ALL_THICKNESSES, "0.6"},
    {SOME_ALBEDOS, "-0.5,0", SOME_THICKNESSES, "0.6"},
    {"0,0.9,0.999999,1", "-0.9,0.9", FEW_THICKNESSES, "0.6"},
    {"0.9,1", "-0.99,0.99,0.999", "1e-6,1e-3,1,1e3,inf", "0.6"},
    {"0.95,1", "0.8", "1e-6,1e-3,1,10,inf", "1e-4,1e-3,0.01,0.05,0.1,0.3,0.9,0.99,1"},
};
enum { N_MAPS = sizeof maps / sizeof maps[0] };

/* Beams at and beside a special mu0. Each has its own albedo, by which plots know it. */
typedef enum { NODE, RESONANCE, EDDINGTON, HEMISPHERIC } special;
static const struct {
    double albedo, g;
    special at;
    int streams;
    pps_delta_m delta_m;
} beams[] = {
    {0.7, 0.5, NODE, 16, PPS_DELTA_M_OFF},
    {0.8, 0.5, RESONANCE, 16, PPS_DELTA_M_OFF},
    {0.85, 0.5, RESONANCE, 32, PPS_DELTA_M_AUTO},
    {0.4, 0, EDDINGTON, 0, PPS_DELTA_M_AUTO},
    {0.5, 0, HEMISPHERIC, 0, PPS_DELTA_M_AUTO},
};
enum { N_BEAMS = sizeof beams / sizeof beams[0], TEXT_SIZE = 512 };

_Static_assert(N_MAPS + N_BEAMS <= MAX_BLOCKS, "room for every block");

/* The middle node, or 1/k of the first eigenvalue k > 1 of order 0. */
static int discrete_beam(size_t i, double *mu0) {
    pps_slab slab = {beams[i].albedo, beams[i].g, 1};
    pps_dom_opts opts = {
        .streams = beams[i].streams, .delta_m = beams[i].delta_m, .orders = 1};
    double value[64], weight[64];
    pps_dom *dom;
    pps_status status = pps_dom_create(&slab, &opts, &dom);
    int j = beams[i].at == NODE ? beams[i].streams / 4 : 0;

    if (!status)
        status = beams[i].at == NODE ? pps_dom_nodes(dom, value, weight)
                                     : pps_dom_eigenvalues(dom, 0, value);
    pps_dom_free(dom);
    if (status)
        return cli_failed("a special beam: %s", pps_status_string(status));
    while (beams[i].at == RESONANCE && value[j] <= 1)
        j++;
    *mu0 = beams[i].at == NODE ? value[j] : 1 / value[j];
    return CLI_DONE;
}

static int special_beam(size_t i, double *mu0) {
    double lost = 1 - beams[i].albedo, scattered = 1 - beams[i].albedo * beams[i].g;

    if (beams[i].at == NODE || beams[i].at == RESONANCE)
        return discrete_beam(i, mu0);
    *mu0 = 1 / sqrt((beams[i].at == EDDINGTON ? 3 : 4) * lost * scattered);
    return CLI_DONE;
}

/* mu0 itself and 1e-14 .. 1e-4 beside it. */
static void neighbours(double mu0, char text[TEXT_SIZE]) {
    size_t length = csv_format(mu0, text);

    for (int power = -14; power <= -4; power += 2) {
        text[length++] = ',';
        length += csv_format(mu0 * (1 + pow(10, power)), text + length);
    }
}

static int beam_block(case_grid *grid, invocation *mine, size_t i) {
    char albedo[CSV_NUMBER_SIZE], g[CSV_NUMBER_SIZE], text[TEXT_SIZE];
    double mu0 = 0;
    int rc = special_beam(i, &mu0);

    if (rc != CLI_DONE)
        return rc;
    csv_format(beams[i].albedo, albedo);
    csv_format(beams[i].g, g);
    neighbours(mu0, text);
    mine->text[OPT_ALBEDO] = albedo;
    mine->text[OPT_G] = g;
    mine->text[OPT_THICKNESS] = FEW_THICKNESSES;
    mine->text[OPT_MU0] = text;
    return grid_init(grid, mine, GRID_ERROR);
}

static int map_block(case_grid *grid, invocation *mine, size_t i) {
    mine->text[OPT_ALBEDO] = maps[i][0];
    mine->text[OPT_G] = maps[i][1];
    mine->text[OPT_THICKNESS] = maps[i][2];
    mine->text[OPT_MU0] = maps[i][3];
    return grid_init(grid, mine, GRID_ERROR);
}

/* One product of the lists given; of the others, everything. */
static int own_block(case_grid *grid, invocation *mine) {
    static const struct {
        option_id id;
        const char *text;
    } lists[] = {
        {OPT_ALBEDO, ALL_ALBEDOS}, {OPT_G, ALL_G}, {OPT_THICKNESS, ALL_THICKNESSES}};

    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        if (!option_given(mine, lists[i].id))
            mine->text[lists[i].id] = lists[i].text;
    }
    if (!option_given(mine, OPT_MU0) && !option_given(mine, OPT_THETA0))
        mine->text[OPT_MU0] = "0.6";
    return grid_init(grid, mine, GRID_ERROR);
}

int design_init(case_grid grid[MAX_BLOCKS], size_t *n, const invocation *call) {
    invocation mine = *call;
    char names[METHOD_NAMES_SIZE];
    bool own = option_given(call, OPT_ALBEDO) || option_given(call, OPT_G) ||
               option_given(call, OPT_THICKNESS) || option_given(call, OPT_MU0) ||
               option_given(call, OPT_THETA0);
    int rc = CLI_DONE;

    every_method(names);
    if (!option_given(call, OPT_METHOD))
        mine.text[OPT_METHOD] = names;
    if (!option_given(call, OPT_PHOTONS))
        mine.text[OPT_PHOTONS] = "1000";
    *n = own ? 1 : N_MAPS + N_BEAMS;
    if (own)
        return own_block(grid, &mine);
    for (size_t i = 0; i < N_MAPS && rc == CLI_DONE; i++)
        rc = map_block(&grid[i], &mine, i);
    for (size_t i = 0; i < N_BEAMS && rc == CLI_DONE; i++)
        rc = beam_block(&grid[N_MAPS + i], &mine, i);
    return rc;
}
