/* Scenes and settings from the command line.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree_scene.h"

#include <math.h>
#include <string.h>

#include "cli.h"
#include "values.h"

static const double DEGREE = 3.14159265358979323846 / 180;

const tree_component tree_components[TREE_COMPONENTS_SPLIT] = {
#define PLAIN(name, sources) {name, sources, false},
#define SPLIT(name, sources) {name "+split", sources, true},
    PPS_LIGHT_COMPONENT_LIST(PLAIN) PPS_LIGHT_COMPONENT_LIST(SPLIT)
#undef PLAIN
#undef SPLIT
};

static int read_bounces(const invocation *call, int *out) {
    const char *text = option_text(call, OPT_BOUNCES);

    *out = 0;
    if (strcmp(text, "all") != 0 && !value_whole(text, 1, 1000000, out))
        return cli_usage("--bounces: '%.60s' is not possible; allowed: whole numbers "
                         "from 1 to 1000000, or all",
                         text);
    return CLI_DONE;
}

static int read_compensation(const invocation *call, pps_compensation *out) {
    int choice = 0, rc = value_choice(call, OPT_COMPENSATE, &choice);

    *out = (pps_compensation)choice;
    return rc;
}

int tree_settings_read(const invocation *call, tree_settings *out) {
    uint64_t cells = 0, rays = 0, samples = 0;
    int bounces = 0, rc, sun_mean = 0;

    *out = (tree_settings){0};
    if ((rc = value_count(call, OPT_SEED, 0, UINT64_MAX, &out->seed)) ||
        (rc = value_threads(call, &out->threads)) ||
        (rc = value_progress(call, &out->progress)) ||
        (rc = value_count(call, OPT_CELLS, 1, 256, &cells)) ||
        (rc = value_count(call, OPT_RAYS, 1, 1000000000000, &rays)) ||
        (rc = value_count(call, OPT_SAMPLES, 1, 1000000, &samples)) ||
        (rc = read_bounces(call, &bounces)) ||
        (rc = value_choice(call, OPT_SUN_MEAN, &sun_mean)) ||
        (rc = read_compensation(call, &out->light.compensate)))
        return rc;
    out->cells = (pps_cells_options){
        .across = (int)cells, .seed = out->seed, .threads = out->threads};
    out->trace = (pps_trace_options){
        .rays = rays, .seed = out->seed, .bounces = bounces, .threads = out->threads};
    out->light.threads = out->threads;
    out->light.sun_mean = (pps_sun_mean)sun_mean;
    out->gather_samples = (int)samples;
    return CLI_DONE;
}

static int turn_sun(const invocation *call, pps_scene *scene) {
    double at[2];
    int rc = value_pair(call, OPT_SUN, at);

    if (rc != CLI_DONE)
        return rc;
    if (!(fabs(at[0]) <= 360) || !(at[1] > 0 && at[1] <= 90))
        return cli_usage(
            "--sun: '%.60s' is out of range; allowed: an azimuth from -360 to 360 and "
            "an elevation above 0 up to 90",
            call->text[OPT_SUN]);
    scene->sun.to[0] = cos(at[1] * DEGREE) * cos(at[0] * DEGREE);
    scene->sun.to[1] = cos(at[1] * DEGREE) * sin(at[0] * DEGREE);
    scene->sun.to[2] = sin(at[1] * DEGREE);
    return CLI_DONE;
}

/* A mesh, with --leaf to tell what is leaf. */
static pps_status read_mesh(const invocation *call, pps_scene **out,
                            pps_problem *problem) {
    pps_mesh_read_options options = {.leaf = option_text(call, OPT_LEAF)};
    pps_mesh *mesh;
    pps_status status = pps_mesh_read(call->operand, &options, &mesh, problem);

    return status ? status : pps_scene_of_mesh(mesh, out);
}

/* Else a scene's file, or the name of one that comes with the library. */
static bool is_mesh(const char *path) {
    size_t length = strlen(path);

    return strpbrk(path, "./") &&
           !(length > 5 && strcmp(path + length - 5, ".json") == 0);
}

int tree_scene_open(const invocation *call, pps_scene **out) {
    const char *path = call->operand;
    pps_problem problem = {""};
    int rc = CLI_DONE;

    *out = NULL;
    if (!path)
        return cli_usage("%s: which scene? allowed: a scene file (.json), a mesh, or "
                         "CHERRY16 and others that come with the program",
                         subcommand_table[call->subcommand].name);
    if (!is_mesh(path) && option_given(call, OPT_LEAF))
        return cli_usage("--leaf: '%.60s' is for meshes; a scene file has its own",
                         call->text[OPT_LEAF]);
    pps_status status = is_mesh(path) ? read_mesh(call, out, &problem)
                                      : pps_scene_read(path, out, &problem);
    if (status == PPS_ERR_MEMORY)
        return cli_no_memory();
    if (status)
        return cli_usage("%s", problem.text);
    if (option_given(call, OPT_SUN))
        rc = turn_sun(call, *out);
    if (rc != CLI_DONE) {
        pps_scene_free(*out);
        *out = NULL;
    }
    return rc;
}
