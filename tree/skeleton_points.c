/* The space of the crown: points that wood grows towards, in the outline or on tiers.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>

#include "tree/skeleton_parts.h"

static const double PI = 3.14159265358979323846;

static double profile_radius(const pps_species *s, double z) {
    const double(*at)[2] = s->crown.profile;
    size_t n = s->crown.n_profile;
    if (z <= at[0][0] || z >= at[n - 1][0]) {
        return z <= at[0][0] ? at[0][1] : at[n - 1][1];
    }
    size_t i = 1;
    while (at[i][0] < z) {
        i++;
    }
    double t = (z - at[i - 1][0]) / (at[i][0] - at[i - 1][0]);
    return at[i - 1][1] + t * (at[i][1] - at[i - 1][1]);
}

/* The crown's outline towards an azimuth at a height: the profile, uneven by a few waves
 * of a size and phase of the seed's own. */
static double crown_radius(const pps_species *s, uint64_t seed, double azimuth,
                           double z) {
    double uneven = 0;
    for (uint64_t wave = 0; wave < 4; wave++) {
        pps_uniforms r = pps_grow_random(seed, PPS_GROW_LOBE, wave, 0);
        uneven += (0.4 + r.u[2]) * cos((double)(wave + 1) * azimuth +
                                       2 * PI * (r.u[0] + (r.u[1] - 0.5) * z));
    }
    return profile_radius(s, z) * (1 + s->crown.roughness * uneven / 2);
}

static double widest(const pps_species *s) {
    double radius = 0;
    for (size_t i = 0; i < s->crown.n_profile; i++) {
        radius = fmax(radius, s->crown.profile[i][1]);
    }
    return radius;
}

/* Evenly in the crown, the inner part `hollow` of its radius left out but for the top. */
static void point_in_crown(const pps_species *s, uint64_t seed, pps_grow_use use,
                           uint64_t i, double hollow, double out[3]) {
    double low = s->crown.profile[0][0],
           high = s->crown.profile[s->crown.n_profile - 1][0];
    double most = widest(s) * (1 + 2 * s->crown.roughness);
    for (uint64_t again = 0;; again++) {
        pps_uniforms r = pps_grow_random(seed, use, i, again);
        double azimuth = 2 * PI * r.u[0], rho = most * sqrt(r.u[1]);
        double z = low + (high - low) * r.u[2], top = (z - low) / (high - low);
        double edge = crown_radius(s, seed, azimuth, z);
        if (rho <= edge && (rho >= hollow * edge || top > 0.75)) {
            out[0] = rho * cos(azimuth);
            out[1] = rho * sin(azimuth);
            out[2] = z;
            return;
        }
    }
}

/* A tier: a level disc that droops towards its edge. */
typedef struct {
    double center[3], radius;
} tier;

/* The tiers stand on /tiers/levels levels, one after the other a golden angle on, mostly
 * at the crown's edge: out there they take the light. */
static tier tier_at(const pps_species *s, uint64_t seed, uint64_t i) {
    double low = s->crown.profile[0][0],
           high = s->crown.profile[s->crown.n_profile - 1][0];
    pps_uniforms r = pps_grow_random(seed, PPS_GROW_TIER, i, 0),
                 q = pps_grow_random(seed, PPS_GROW_TIER, i, 1);
    double start = pps_grow_random(seed, PPS_GROW_TIER, UINT32_MAX, 0).u[0];
    double level = floor(((double)i + r.u[3]) / s->tiers.count * s->tiers.levels);
    double z = low + (high - low) * (level + 0.3 + 0.4 * q.u[0]) / s->tiers.levels;
    double azimuth = 2 * PI * (0.381966 * (double)i + 0.12 * q.u[1] + start);
    tier t = {.radius = s->tiers.radius[0] +
                        r.u[0] * (s->tiers.radius[1] - s->tiers.radius[0])};
    double room = fmax(0, crown_radius(s, seed, azimuth, z) - t.radius);
    double rho = room * (r.u[1] < 0.3 ? 0.5 * r.u[2] : 0.7 + 0.3 * r.u[2]);
    t.center[0] = rho * cos(azimuth);
    t.center[1] = rho * sin(azimuth);
    t.center[2] = z;
    return t;
}

/* Evenly over the tiers: the draw of a tier is accepted by its area. */
static void point_in_tier(const pps_species *s, uint64_t seed, uint64_t i,
                          double out[3]) {
    pps_uniforms r = pps_grow_random(seed, PPS_GROW_POINT, i, 0);
    tier t;
    for (uint64_t again = 1;; again++) {
        pps_uniforms pick = pps_grow_random(seed, PPS_GROW_POINT, i, again);
        t = tier_at(s, seed, (uint64_t)(pick.u[0] * s->tiers.count));
        double ratio = t.radius / s->tiers.radius[1];
        if (pick.u[1] < ratio * ratio) {
            break;
        }
    }
    double turn = 2 * PI * r.u[0], share = sqrt(r.u[1]);
    out[0] = t.center[0] + share * t.radius * cos(turn);
    out[1] = t.center[1] + share * t.radius * sin(turn);
    out[2] = t.center[2] + s->tiers.thickness * (r.u[2] + r.u[3] - 1) -
             s->tiers.droop * share * share * t.radius;
}

void pps_grow_limb_point(const pps_species *s, uint64_t seed, uint64_t i,
                         double out[3]) {
    if (s->tiers.count > 0) {
        tier t = tier_at(s, seed, i);
        memcpy(out, t.center, sizeof t.center);
    } else {
        point_in_crown(s, seed, PPS_GROW_LIMB, i, 0, out);
    }
}

void pps_grow_twig_point(const pps_species *s, uint64_t seed, uint64_t i,
                         double out[3]) {
    if (s->tiers.count > 0) {
        point_in_tier(s, seed, i, out);
    } else {
        point_in_crown(s, seed, PPS_GROW_POINT, i, s->crown.hollow, out);
    }
}
