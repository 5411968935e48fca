/* Branching by space colonisation: points in the space of the crown pull the nearest wood
 * towards them, and are gone once it is near.
 *
 * Reference: RLP07 (Runions, Lane and Prusinkiewicz 2007). The stems up to the crown are
 * given; the pull reaches /growth/reach; radii follow the pipe model.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/skeleton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tree/random.h"
#include "tree/vec.h"

static const double PI = 3.14159265358979323846;
static const double DEGREE = 3.14159265358979323846 / 180;

enum { MAX_NODES = 400000, MAX_ROUNDS = 4000, SMOOTHINGS = 6 };

/* What a random number is for; items count within it. */
enum { STEM = 1, FORK, LIMB, POINT, TIER, LOBE, WANDER };

static pps_uniforms draw(uint64_t seed, int use, uint64_t item, uint64_t event) {
    return pps_random(seed, PPS_RANDOM_SPECIES, (uint64_t)use << 40 | item, event);
}

/* To multiples of 2^-24 m, so that the last digits of one machine's sine or cosine do not
 * grow into another tree on the next. */
static void snap(double p[3]) {
    for (int i = 0; i < 3; i++) {
        p[i] = nearbyint(p[i] * 0x1p24) * 0x1p-24;
    }
}

static pps_status add_node(pps_skeleton *s, uint32_t parent, const double at[3]) {
    if (s->n == s->room) {
        size_t room = s->room ? 2 * s->room : 1024;
        pps_node *node = realloc(s->node, room * sizeof *node);
        if (!node) {
            return PPS_ERR_MEMORY;
        }
        s->node = node;
        s->room = room;
    }
    pps_node *node = &s->node[s->n++];
    *node = (pps_node){{at[0], at[1], at[2]}, 0, parent, PPS_NO_NODE, 0, 0};
    snap(node->at);
    return PPS_OK;
}

/* ---- stems ---- */

/* One stem: from its foot up to /stems/height, leaning outwards, in a slow S. */
static pps_status add_stem(const pps_species *species, uint64_t seed, int i,
                           pps_skeleton *s) {
    pps_uniforms r = draw(seed, STEM, (uint64_t)i, 0);
    pps_uniforms q = draw(seed, STEM, (uint64_t)i, 1);
    double azimuth = 2 * PI * (i + 0.6 * (r.u[0] - 0.5)) / species->stems.count;
    azimuth += 2 * PI * draw(seed, STEM, UINT32_MAX, 0).u[0];
    double lean = species->stems.lean * DEGREE * (0.6 + 0.8 * r.u[1]);
    double out[3] = {cos(azimuth), sin(azimuth), 0}, side[3] = {-out[1], out[0], 0};
    double foot = species->stems.count > 1 ? species->stems.spread : 0;
    double height = species->stems.height * (0.85 + 0.3 * r.u[2]);
    int steps = (int)ceil(height / (0.6 * species->growth.step));
    pps_status status = PPS_OK;
    for (int k = 0; k <= steps && !status; k++) {
        double t = (double)k / steps, z = t * height;
        double bend = species->stems.wander * height * t;
        double p[3] = {0, 0, z};
        vec_along(p, foot + z * tan(lean) * (0.5 + 0.5 * t), out, p);
        vec_along(p, 0.35 * bend * sin(2 * PI * (0.7 * t + q.u[0])) -
                         0.35 * bend * sin(2 * PI * q.u[0]),
                  side, p);
        vec_along(p, 0.25 * bend * (sin(2 * PI * (0.9 * t + q.u[1])) -
                                    sin(2 * PI * q.u[1])),
                  out, p);
        status = add_node(s, k ? (uint32_t)s->n - 1 : PPS_NO_NODE, p);
    }
    return status;
}

/* The limbs that a stem forks into at its top: evenly about it, leaning out, rising again
 * towards their ends. */
static pps_status add_forks(const pps_species *species, uint64_t seed, int stem,
                            pps_skeleton *s) {
    uint32_t top = (uint32_t)s->n - 1;
    int n = (int)species->stems.forks;
    double start = 2 * PI * draw(seed, FORK, UINT32_MAX, (uint64_t)stem).u[0];
    for (int i = 0; i < n; i++) {
        pps_uniforms r = draw(seed, FORK, (uint64_t)i, (uint64_t)stem);
        double azimuth = start + 2 * PI * (i + 0.5 * (r.u[0] - 0.5)) / n;
        double lean = species->stems.fork_lean * DEGREE * (0.7 + 0.6 * r.u[1]);
        double length = species->stems.fork_length * (0.75 + 0.5 * r.u[2]);
        /* The second in a stem starts a little lower: real forks are not in one place. */
        uint32_t parent = top - (uint32_t)(i % 3 && top > 3 ? i % 3 : 0);
        double at[3];
        memcpy(at, s->node[parent].at, sizeof at);
        int steps = (int)ceil(length / (0.6 * species->growth.step));
        for (int k = 0; k < steps; k++) {
            double t = (double)k / steps, now = lean * (1.1 - 0.35 * t);
            double turn = azimuth + species->stems.wander * sin(2 * PI * (t + r.u[3]));
            double way[3] = {sin(now) * cos(turn), sin(now) * sin(turn), cos(now)};
            vec_along(at, length / steps, way, at);
            pps_status status = add_node(s, parent, at);
            if (status) {
                return status;
            }
            parent = (uint32_t)s->n - 1;
        }
    }
    return PPS_OK;
}

/* ---- attraction points ---- */

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
        pps_uniforms r = draw(seed, LOBE, wave, 0);
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
static void point_in_crown(const pps_species *s, uint64_t seed, int use, uint64_t i,
                           double hollow, double out[3]) {
    double low = s->crown.profile[0][0],
           high = s->crown.profile[s->crown.n_profile - 1][0];
    double most = widest(s) * (1 + 2 * s->crown.roughness);
    for (uint64_t again = 0;; again++) {
        pps_uniforms r = draw(seed, use, i, again);
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
    pps_uniforms r = draw(seed, TIER, i, 0), q = draw(seed, TIER, i, 1);
    double start = draw(seed, TIER, UINT32_MAX, 0).u[0];
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
    pps_uniforms r = draw(seed, POINT, i, 0);
    tier t;
    for (uint64_t again = 1;; again++) {
        pps_uniforms pick = draw(seed, POINT, i, again);
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

/* Where the limbs go first: the middles of the tiers, or places in the crown. */
static void point_of_limb(const pps_species *s, uint64_t seed, uint64_t i,
                          double out[3]) {
    if (s->tiers.count > 0) {
        tier t = tier_at(s, seed, i);
        memcpy(out, t.center, sizeof t.center);
    } else {
        point_in_crown(s, seed, LIMB, i, 0, out);
    }
}

static void point_of_twig(const pps_species *s, uint64_t seed, uint64_t i,
                          double out[3]) {
    if (s->tiers.count > 0) {
        point_in_tier(s, seed, i, out);
    } else {
        point_in_crown(s, seed, POINT, i, s->crown.hollow, out);
    }
}

/* ---- colonisation ---- */

typedef struct {
    double at[3], distance; /* to the nearest node, squared */
    uint32_t nearest;
    bool alive;
} attractor;

/* A new node may be nearer to some points than what they had. */
static void meet(attractor *point, size_t n_points, const pps_skeleton *s,
                 size_t first) {
    for (size_t i = 0; i < n_points; i++) {
        for (size_t k = first; k < s->n && point[i].alive; k++) {
            double to[3];
            vec_sub(point[i].at, s->node[k].at, to);
            double distance = vec_dot(to, to);
            if (distance < point[i].distance) {
                point[i].distance = distance;
                point[i].nearest = (uint32_t)k;
            }
        }
    }
}

/* The mean direction that the points within reach pull each node in. */
static void pull(const pps_species *species, const attractor *point, size_t n_points,
                 const pps_skeleton *s, double (*way)[3]) {
    double reach = species->growth.reach * species->growth.reach;
    memset(way, 0, s->n * sizeof *way);
    for (size_t i = 0; i < n_points; i++) {
        if (point[i].alive && point[i].distance < reach) {
            double to[3];
            vec_sub(point[i].at, s->node[point[i].nearest].at, to);
            vec_normalize(to);
            vec_along(way[point[i].nearest], 1, to, way[point[i].nearest]);
        }
    }
}

/* Whether a new node would stand where its parent already has a child: points that pull
 * evenly from two sides would else grow the same twig again and again. */
static bool taken(const pps_skeleton *s, uint32_t parent, const double at[3],
                  double step) {
    for (size_t k = s->n; k-- > parent + 1;) {
        if (s->node[k].parent == parent) {
            double to[3];
            vec_sub(at, s->node[k].at, to);
            if (vec_dot(to, to) < 0.01 * step * step) {
                return true;
            }
        }
    }
    return false;
}

/* One round: every node that is pulled puts out a child. */
static pps_status sprout(const pps_species *species, uint64_t seed, pps_skeleton *s,
                         double (*way)[3], attractor *point, size_t n_points) {
    size_t before = s->n;
    double step = species->growth.step;
    for (uint32_t k = 0; k < before; k++) {
        double *to = way[k], at[3];
        if (vec_dot(to, to) == 0) {
            continue;
        }
        vec_normalize(to);
        pps_uniforms r = draw(seed, WANDER, s->n, 0);
        for (int i = 0; i < 3; i++) {
            to[i] += species->growth.wander * (2 * r.u[i] - 1);
        }
        to[2] += species->growth.rise;
        vec_normalize(to);
        vec_along(s->node[k].at, step, to, at);
        if (s->node[k].n_children > 0 && taken(s, k, at, step)) {
            for (size_t i = 0; i < n_points; i++) {
                point[i].alive = point[i].alive && point[i].nearest != k;
            }
            continue;
        }
        pps_status status = add_node(s, k, at);
        if (status) {
            return status;
        }
        s->node[k].n_children++;
    }
    return PPS_OK;
}

static pps_status colonise(const pps_species *species, uint64_t seed, double kill,
                           attractor *point, size_t n_points, pps_skeleton *s) {
    size_t met = 0;
    for (int round = 0; round < MAX_ROUNDS && s->n < MAX_NODES; round++) {
        meet(point, n_points, s, met);
        met = s->n;
        for (size_t i = 0; i < n_points; i++) {
            point[i].alive = point[i].alive && point[i].distance >= kill * kill;
        }
        double(*way)[3] = malloc(s->n * sizeof *way);
        if (!way) {
            return PPS_ERR_MEMORY;
        }
        pull(species, point, n_points, s, way);
        pps_status status = sprout(species, seed, s, way, point, n_points);
        free(way);
        if (status || s->n == met) {
            return status;
        }
    }
    return PPS_OK;
}

/* Limbs first, towards a few points; then twigs from them towards many. */
static pps_status branch(const pps_species *species, uint64_t seed, pps_skeleton *s) {
    size_t n_twigs = (size_t)species->crown.points;
    size_t n_limbs = (size_t)(species->tiers.count > 0 ? species->tiers.count
                                                       : species->crown.limbs);
    attractor *point = malloc((n_limbs + n_twigs) * sizeof *point);
    if (!point) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < n_limbs + n_twigs; i++) {
        point[i] = (attractor){{0, 0, 0}, INFINITY, 0, true};
        if (i < n_limbs) {
            point_of_limb(species, seed, i, point[i].at);
        } else {
            point_of_twig(species, seed, i - n_limbs, point[i].at);
        }
        snap(point[i].at);
    }
    double near = fmax(species->growth.kill, 1.5 * species->growth.step);
    pps_status status = colonise(species, seed, near, point, n_limbs, s);
    if (!status) {
        status =
            colonise(species, seed, species->growth.kill, point + n_limbs, n_twigs, s);
    }
    free(point);
    return status;
}

/* ---- shape ---- */

/* Children before parents: tips add up, and the child with the most goes on. */
static void count_tips(pps_skeleton *s) {
    for (size_t k = 0; k < s->n; k++) {
        s->node[k].n_children = s->node[k].tips = 0;
        s->node[k].main_child = PPS_NO_NODE;
    }
    for (size_t k = s->n; k-- > 0;) {
        pps_node *node = &s->node[k];
        node->tips += node->n_children == 0;
        if (node->parent != PPS_NO_NODE) {
            pps_node *parent = &s->node[node->parent];
            parent->n_children++;
            parent->tips += node->tips;
            if (parent->main_child == PPS_NO_NODE ||
                node->tips >= s->node[parent->main_child].tips) {
                parent->main_child = (uint32_t)k;
            }
        }
    }
}

/* Stems that stood in the shade of the others, with hardly a twig, are taken away: they
 * would be bare poles as thin as a twig. */
static pps_status prune(pps_skeleton *s) {
    uint32_t *now = malloc((s->n + 1) * sizeof *now), most = 0;
    if (!now) {
        return PPS_ERR_MEMORY;
    }
    for (size_t k = 0; k < s->n; k++) {
        most = s->node[k].tips > most ? s->node[k].tips : most;
    }
    size_t kept = 0;
    for (size_t k = 0; k < s->n; k++) {
        pps_node node = s->node[k];
        bool foot = node.parent == PPS_NO_NODE;
        bool gone = foot ? node.tips < most / 12 : now[node.parent] == PPS_NO_NODE;
        now[k] = gone ? PPS_NO_NODE : (uint32_t)kept;
        if (!gone) {
            node.parent = foot ? PPS_NO_NODE : now[node.parent];
            s->node[kept++] = node;
        }
    }
    s->n = kept;
    free(now);
    count_tips(s);
    return PPS_OK;
}

/* Steps in the directions of a moment leave kinks: each node moves to the middle of its
 * neighbours on the way from foot to tip; feet and tips stay. */
static pps_status smooth(pps_skeleton *s) {
    double(*moved)[3] = malloc((s->n + 1) * sizeof *moved);
    if (!moved) {
        return PPS_ERR_MEMORY;
    }
    for (int round = 0; round < SMOOTHINGS; round++) {
        for (size_t k = 0; k < s->n; k++) {
            const pps_node *node = &s->node[k];
            bool end = node->parent == PPS_NO_NODE || node->main_child == PPS_NO_NODE;
            for (int i = 0; i < 3; i++) {
                moved[k][i] = end ? node->at[i]
                                  : node->at[i] / 2 +
                                        (s->node[node->parent].at[i] +
                                         s->node[node->main_child].at[i]) /
                                            4;
            }
        }
        for (size_t k = 0; k < s->n; k++) {
            memcpy(s->node[k].at, moved[k], sizeof moved[k]);
            snap(s->node[k].at);
        }
    }
    free(moved);
    return PPS_OK;
}

/* The pipe model (SYHK64) with the power that makes the thickest stem as
 * thick as asked for: radius^power adds up over the tips. */
static void set_radii(const pps_species *species, pps_skeleton *s) {
    double most = 2, ratio = species->wood.trunk_radius / species->wood.twig_radius;
    for (size_t k = 0; k < s->n; k++) {
        most = fmax(most, s->node[k].tips);
    }
    double root = log(ratio) / log(most);
    for (size_t k = 0; k < s->n; k++) {
        s->node[k].radius = species->wood.twig_radius * pow(s->node[k].tips, root);
    }
}

/* How far the node is from the line between two others. */
static double off_line(const double p[3], const double a[3], const double b[3]) {
    double along[3], to[3], across[3];
    vec_sub(b, a, along);
    vec_normalize(along);
    vec_sub(p, a, to);
    vec_along(to, -vec_dot(to, along), along, across);
    return vec_length(across);
}

/* Nodes that hardly bend the wood between its forks are left out. */
static void simplify(const pps_species *species, pps_skeleton *s) {
    double longest = 2.2 * species->growth.step;
    uint32_t *now = malloc((s->n + 1) * sizeof *now);
    if (!now) {
        return; /* more triangles, no harm */
    }
    size_t kept = 0;
    for (uint32_t k = 0; k < s->n; k++) {
        pps_node node = s->node[k];
        bool drop = false;
        if (node.parent != PPS_NO_NODE && node.n_children == 1) {
            const pps_node *parent = &s->node[now[node.parent]];
            const pps_node *child = &s->node[node.main_child];
            double span[3];
            vec_sub(child->at, parent->at, span);
            bool flares = node.at[2] < 3 * species->wood.flare_height;
            drop = !flares && parent->n_children == 1 && vec_length(span) < longest &&
                   off_line(node.at, parent->at, child->at) < 0.3 * node.radius + 0.004;
        }
        if (drop) {
            now[k] = now[node.parent]; /* its child now hangs on the parent */
        } else {
            node.parent = node.parent == PPS_NO_NODE ? PPS_NO_NODE : now[node.parent];
            now[k] = (uint32_t)kept;
            s->node[kept++] = node;
        }
    }
    s->n = kept;
    free(now);
    count_tips(s);
}

pps_status pps_skeleton_grow(const pps_species *species, uint64_t seed,
                             pps_skeleton *out) {
    *out = (pps_skeleton){0, 0, NULL};
    pps_status status = PPS_OK;
    for (int i = 0; i < (int)species->stems.count && !status; i++) {
        status = add_stem(species, seed, i, out);
        status = status ? status : add_forks(species, seed, i, out);
    }
    status = status ? status : branch(species, seed, out);
    if (!status) {
        count_tips(out);
        status = prune(out);
        status = status ? status : smooth(out);
    }
    if (!status) {
        set_radii(species, out);
        simplify(species, out);
    }
    return status;
}
