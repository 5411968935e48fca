/* The columns that each subcommand prints. Their names are a contract with scripts.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "columns.h"

#include <stddef.h>

/* clang-format off */
#define CASE_COLUMNS                                                                   \
    {"method", "string", NULL, "name of the method"},                                  \
    {"albedo", "double", "1", "single-scattering albedo"},                             \
    {"g", "double", "1", "asymmetry of the Henyey-Greenstein phase function"},         \
    {"thickness", "double", "1", "optical thickness; inf is a half-space"},            \
    {"mu0", "double", "1", "cosine of the beam's angle of incidence"}

static const column methods_columns[] = {
    {"name", "string", NULL, "name, as --method takes it"},
    {"cost", "string", NULL, "what one more case costs"},
    {"fields", "boolean", NULL, "gives radiances"},
    {"fluxes", "boolean", NULL, "gives fluxes"},
    {"thickness_inf", "boolean", NULL, "covers the half-space"},
    {"summary", "string", NULL, "what it is"},
    {"limits", "string", NULL, "where it is wrong or refuses"},
    {0}};

static const column field_columns[] = {
    CASE_COLUMNS,
    {"depth", "double", "1", "optical depth below the lit side"},
    {"mu", "double", "1", "cosine of the direction; above 0 goes down"},
    {"phi", "double", "degree", "azimuth of the direction, 0 is the beam's own"},
    {"radiance", "double", "1/sr",
     "diffuse radiance, without the beam; the beam's irradiance is 1 or --beam"},
    {0}};

static const column flux_columns[] = {
    CASE_COLUMNS,
    {"depth", "double", "1", "optical depth below the lit side"},
    {"flux_up", "double", "1",
     "diffuse flux upward through a horizontal surface; irradiance of the beam = 1"},
    {"flux_down", "double", "1", "diffuse flux downward through a horizontal surface"},
    {"flux_direct", "double", "1", "flux of the beam through a horizontal surface"},
    {"mean_intensity_diffuse", "double", "1/sr",
     "integral of the diffuse radiance over the sphere, divided by 4 pi"},
    {"mean_intensity", "double", "1/sr", "the same with the beam"},
    {0}};

static const column error_columns[] = {
    CASE_COLUMNS,
    {"rms_abs", "double", "1/sr",
     "root mean square difference of radiance over directions and depths"},
    {"rms_rel", "double", "1",
     "mean over depths of the root mean square difference / mean exact radiance"},
    {"max_abs", "double", "1/sr", "largest difference of radiance"},
    {"reflectance_error", "double", "1",
     "relative error of the diffuse upward flux at depth 0"},
    {"transmittance_error", "double", "1",
     "relative error of the diffuse flux out of the bottom; empty for a half-space"},
    {"seconds", "double", "s",
     "time to solve this case and evaluate its radiances; differs from run to run"},
    {0}};

static const column table_columns[] = {
    {"table", "string", NULL, "the table: its number in the paper, or its name"},
    {"row", "string", NULL, "row of the table"},
    {"column", "string", NULL, "column of the table"},
    {"paper", "double", "1", "the printed figure; empty where there is none"},
    {"ours", "double", "1",
     "the same measured here: percent in 1, 2, 3, crowns and figure7, frames a second "
     "in fps, in 4 and 5 as the column says"},
    {"rms_rel", "double", "%",
     "1, 2: mean over angles and depths of the root mean square error / mean exact "
     "radiance; 3, crowns: the error with every triangle weighing the same; figure7: "
     "mean |difference| / mean"},
    {"method", "string", NULL,
     "name of the method or light model measured; 4, 5, fps: of the processor or of "
     "OpenGL's renderer that took the time"},
    {"ratio", "double", "1", "3, crowns, figure7: mean of ours / mean of Monte Carlo"},
    {"spread", "double", "1",
     "3, crowns, figure7: half the range of `ours` over the seeds"},
    {"seconds_per_cell", "double", "s",
     "crowns: processor time for a cell with leaves, without what is made once a scene; "
     "differs from run to run"},
    {"rms_leaf", "double", "%",
     "3, crowns: the error with every leaf for itself, less the reference's own noise"},
    {"seconds_per_leaf", "double", "s",
     "crowns: the same time for a leaf, from no light to the irradiance of its faces; "
     "fps: that time on the clock, or of its attenuations"},
    {0}};

static const column chart_columns[] = {
    {"method", "string", NULL, "name of the method"},
    {"setting", "string", NULL, "what it was asked for: streams=, photons=, tol=, or -"},
    {"albedo", "double", "1", "single-scattering albedo"},
    {"g", "double", "1", "asymmetry of the Henyey-Greenstein phase function"},
    {"thickness", "double", "1", "optical thickness; inf is a half-space"},
    {"mu0", "double", "1", "cosine of the beam's angle of incidence"},
    {"rms_abs", "double", "1/sr",
     "root mean square difference of radiance over directions and depths"},
    {"rms_rel", "double", "1",
     "mean over depths of the root mean square difference / mean exact radiance"},
    {"reflectance_error", "double", "1",
     "relative error of the diffuse upward flux at depth 0"},
    {"setup_seconds", "double", "s",
     "time from nothing to the first answer, less `seconds`"},
    {"seconds", "double", "s",
     "time of one more evaluation: another mu0, and radiances at all depths and "
     "directions (fluxes at all depths where the method has no radiances)"},
    {"evaluations", "integer", "1", "evaluations timed for `seconds`"},
    {0}};

static const column stability_columns[] = {
    CASE_COLUMNS,
    {"status", "string", NULL,
     "ok, inaccurate, not_finite, negative, refused or too_slow (over 10 s)"},
    {"error", "double", "1",
     "largest relative error of what is compared; empty where there is nothing to"},
    {"seconds", "double", "s",
     "processor time of this case; models are kept from the case before it, so that "
     "the first of an albedo and g has their making in it"},
    {0}};
static const column tree_grow_columns[] = {
    {"vertices", "integer", "1", "vertices of the mesh"},
    {"triangles", "integer", "1", "triangles of the mesh"},
    {"leaves", "integer", "1", "leaves: connected pieces of leaf triangles"},
    {"leaf_area", "double", "m^2", "one-sided area of all leaves, where they are opaque"},
    {"leaf_area_index", "double", "1",
     "leaf_area over the convex hull of the leaves seen from above"},
    {"width", "double", "m", "mean horizontal extent of the leaves"},
    {"height", "double", "m", "of the highest point over the lowest"},
    {0}};

static const column tree_irradiance_columns[] = {
    {"instance", "integer", "1", "number of the plant in the scene, from 0"},
    {"leaf", "integer", "1", "number of the leaf in its plant, from 0"},
    {"material", "string", NULL, "name of the leaf's material"},
    {"x", "double", "m", "the leaf's centre; z points up"},
    {"y", "double", "m", "the leaf's centre"},
    {"z", "double", "m", "the leaf's centre"},
    {"nx", "double", "1", "the normal of the leaf's front"},
    {"ny", "double", "1", "the normal of the leaf's front"},
    {"nz", "double", "1", "the normal of the leaf's front"},
    {"area", "double", "m^2", "one-sided area, where it is opaque"},
    {"band", "string", NULL, "name of the colour band"},
    {"depth", "double", "1", "optical depth below the sun, along its light"},
    {"thickness", "double", "1", "depth and what lies behind along the light"},
    {"visibility", "double", "1", "share of the sun seen from the leaf's cell"},
    {"g_factor", "double", "1", "G of the compensation; 1 without one"},
    {"model", "string", NULL, "name of the light model"},
    {"component", "string", NULL, "which light: sun, indirect, sky, sky-indirect or all"},
    {"irradiance_front", "double", "W/m^2",
     "irradiance of the front, in the units of the scene's sun and sky"},
    {"irradiance_back", "double", "W/m^2", "irradiance of the back"},
    {"stderr", "double", "W/m^2",
     "standard error of the mean of both faces; empty where the model has none"},
    {0}};

static const column tree_models_columns[] = {
    {"name", "string", NULL, "name, as --model takes it"},
    {"components", "string", NULL, "the light that it knows"},
    {"compensates", "boolean", NULL, "takes the G-factor, --compensate"},
    {"summary", "string", NULL, "what it is"},
    {"source", "string", NULL, "where it comes from"},
    {0}};

static const column no_columns[] = {{0}};
/* clang-format on */

const column *columns_of(subcommand_id subcommand) {
    static const column *const tables[SUB_COUNT] = {
        [SUB_METHODS] = methods_columns,
        [SUB_FIELD] = field_columns,
        [SUB_FLUX] = flux_columns,
        [SUB_ERROR] = error_columns,
        [SUB_TABLE] = table_columns,
        [SUB_CHART] = chart_columns,
        [SUB_STABILITY] = stability_columns,
        [SUB_TREE_GROW] = tree_grow_columns,
        [SUB_TREE_IRRADIANCE] = tree_irradiance_columns,
        [SUB_TREE_MODELS] = tree_models_columns,
        [SUB_TREE_RENDER] = no_columns,
    };

    return tables[subcommand];
}
