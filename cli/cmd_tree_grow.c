/* ppscat tree grow: a plant from a seed, as a mesh file, and its measures.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <ppscat/tree/grow.h>

#include "cli.h"
#include "commands.h"
#include "output.h"
#include "values.h"

static int grow_crown(const invocation *call, uint64_t seed, pps_mesh **out) {
    pps_crown crown = {.seed = seed};
    uint64_t leaves = 0;
    int shape = 0, rc = value_choice(call, OPT_CROWN, &shape);

    if (option_given(call, OPT_SPECIES))
        return cli_usage(
            "--species '%.60s' and --crown '%.60s' contradict each other; allowed: one "
            "of them",
            call->text[OPT_SPECIES], call->text[OPT_CROWN]);
    if (rc || (rc = value_count(call, OPT_LEAVES, 1, 10000000, &leaves)) ||
        (rc = value_number(call, OPT_LEAF_AREA_INDEX, &crown.leaf_area_index)))
        return rc;
    crown.shape = (pps_crown_shape)shape;
    crown.n_leaves = (uint32_t)leaves;
    return pps_crown_grow(&crown, out) ? cli_no_memory() : CLI_DONE;
}

static int grow_species(const invocation *call, uint64_t seed, pps_mesh **out) {
    const option_id of_crowns[] = {OPT_LEAVES, OPT_LEAF_AREA_INDEX};
    pps_problem problem = {""};

    for (size_t i = 0; i < 2; i++) {
        if (option_given(call, of_crowns[i]))
            return cli_usage(
                "--%s '%.60s' is for --crown; a species has its own, in its file",
                option_table[of_crowns[i]].name, call->text[of_crowns[i]]);
    }
    pps_status status =
        pps_species_grow(option_text(call, OPT_SPECIES), seed, out, &problem);
    if (status == PPS_ERR_MEMORY)
        return cli_no_memory();
    return status ? cli_usage("--species: %s", problem.text) : CLI_DONE;
}

static int write_mesh(const invocation *call, const pps_mesh *mesh) {
    pps_problem problem = {""};
    pps_status status = PPS_OK;

    if (option_given(call, OPT_OUTPUT))
        status = pps_mesh_write(mesh, call->text[OPT_OUTPUT], NULL, &problem);
    if (status == PPS_ERR_MEMORY)
        return cli_no_memory();
    if (status == PPS_ERR_ARGUMENT)
        return cli_usage("--output: %s", problem.text);
    return status ? cli_failed("%s", problem.text) : CLI_DONE;
}

static int print_measures(const invocation *call, const pps_mesh *mesh) {
    invocation to_stdout = *call; /* -o names the mesh */
    pps_mesh_size size;
    output out;
    int rc;

    to_stdout.text[OPT_OUTPUT] = NULL;
    rc = output_open(&out, &to_stdout);
    if (rc != CLI_DONE)
        return rc;
    pps_mesh_measure(mesh, &size);
    csv_number(&out.csv, (double)mesh->n_vertices);
    csv_number(&out.csv, (double)mesh->n_triangles);
    csv_number(&out.csv, (double)mesh->n_leaves);
    csv_number(&out.csv, size.leaf_area);
    csv_number(&out.csv, size.leaf_area_index);
    csv_number(&out.csv, 2 * size.radius);
    csv_number(&out.csv, size.high[2] - size.low[2]);
    return output_close(&out, output_end_row(&out, NULL, NULL));
}

int cmd_tree_grow(const invocation *call) {
    pps_mesh *mesh = NULL;
    uint64_t seed = 0;
    int rc = value_count(call, OPT_SEED, 0, UINT64_MAX, &seed);

    if (rc == CLI_DONE && option_given(call, OPT_OUTPUT))
        rc = output_writable(call->text[OPT_OUTPUT]);
    if (rc == CLI_DONE)
        rc = option_given(call, OPT_CROWN) ? grow_crown(call, seed, &mesh)
                                           : grow_species(call, seed, &mesh);
    if (rc == CLI_DONE)
        rc = write_mesh(call, mesh);
    if (rc == CLI_DONE)
        rc = print_measures(call, mesh);
    pps_mesh_free(mesh);
    return rc;
}
