/* A species: the numbers that its plants grow from. docs/species.md says what they mean.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_SPECIES_H
#define PPS_TREE_SPECIES_H

#include <ppscat/tree/grow.h>

enum { PPS_PROFILE_POINTS = 32, PPS_OUTLINE_POINTS = 60 };

/* Lengths in metres, angles in degrees. */
typedef struct pps_species {
    double triangles, leaf_area_index;
    struct {
        double count, height, lean, spread, wander, forks, fork_length, fork_lean;
    } stems;
    struct {
        double limbs, points, hollow, roughness;
        size_t n_profile;
        double profile[PPS_PROFILE_POINTS][2]; /* height, radius; heights ascend */
    } crown;
    struct {
        double count, levels, radius[2], thickness, droop;
    } tiers;
    struct {
        double step, reach, kill, rise, wander;
    } growth;
    struct {
        double trunk_radius, twig_radius, flare, flare_height, sides, lenticels;
        double color[3];
    } wood;
    struct {
        double whorl, cup, curl, heart, cluster, divergence, phase, forward[2],
            stalk[2];
        double upright, pitch, jitter, size_spread, wood_below;
        size_t n_outline;
        double outline[PPS_OUTLINE_POINTS][2]; /* counter-clockwise about the base */
        double reflectance[3], transmittance[3];
    } leaves;
} pps_species;

/* A built-in species, or a file when the name has a '/' or ends in ".json".
 * ARGUMENT: no such species; FILE; FORMAT: the problem names the line or the pointer. */
pps_status pps_species_read(const char *name, pps_species *out, pps_problem *problem);

#endif
