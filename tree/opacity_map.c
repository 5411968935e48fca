/* Deep opacity maps on the CPU.
 *
 * Two passes over the triangles, as on a GPU: the first finds where light meets the first
 * and the last surface of each texel, the second counts into the layers between. Which
 * texels a triangle covers is decided as OpenGL's rasterisers do: corners in single
 * precision, moved to the nearest 1/256 texel, and of texels whose middle lies on an edge
 * those of left and top edges, so that neighbouring triangles never both cover one.
 *
 * References: Yuksel & Keyser 2008; SPP section 5.1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/opacity.h>

#include "tree/alpha.h"
#include "tree/opacity_look.h"
#include "tree/vec.h"

enum { LAYERS = PPS_OPACITY_LAYERS, DEFAULT_TEXELS = 128, STEPS = 256 };

/* A surface is no plane: within this many texels, more when steep, it is itself. */
static const double BIAS = 0.25, STEEPEST = 6;

/* A corner on the map, from the middle of texel (0, 0): across in texels, the same in
 * whole steps of 1/256 texel, and along the light in metres. */
typedef struct {
    float across[2], along;
    int32_t x, y;
} corner;

/* A triangle on the map, its corners counter-clockwise when y points up. */
typedef struct {
    corner c[3];
    int64_t area; /* twice, in steps^2 */
    bool
        exchanged; /* the mesh has corners 1 and 2 the other way round: seen from behind */
} outline;

typedef struct {
    const pps_mesh *mesh;
    pps_opacity_map *map;
    corner *corner; /* of each vertex */
    int wood;
} painter;

/* ---- the frame ---- */

static bool sound_options(const pps_opacity_options *o) {
    return !o || ((!o->texels || (o->texels >= 4 && o->texels <= 4096)) &&
                  o->wood >= 0 && o->wood <= 1024);
}

/* The extent of the mesh along an axis. */
static void extent(const pps_mesh *mesh, const double axis[3], double range[2]) {
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double at = vec_dot(mesh->position[v], axis);
        range[0] = fmin(range[0], at);
        range[1] = fmax(range[1], at);
    }
}

pps_status pps_opacity_frame(const pps_mesh *mesh, const double to[3],
                             const pps_opacity_options *options,
                             pps_opacity_map *frame) {
    memset(frame, 0, sizeof *frame);
    if (!mesh || !sound_options(options) || !(fabs(vec_length(to) - 1) < 1e-9)) {
        return PPS_ERR_ARGUMENT;
    }
    frame->texels = options && options->texels ? options->texels : DEFAULT_TEXELS;
    for (int i = 0; i < 3; i++) {
        frame->axis[2][i] = -to[i];
    }
    vec_frame(frame->axis[2], frame->axis[0], frame->axis[1]);
    for (int i = 0; i < 2; i++) {
        double range[2];
        extent(mesh, frame->axis[i], range);
        double width = range[1] > range[0] ? range[1] - range[0] : 1;
        /* One texel stays free on either side: nothing is clipped. */
        frame->size[i] = width / (frame->texels - 2);
        frame->low[i] = range[0] - frame->size[i];
    }
    return PPS_OK;
}

/* ---- which texels a triangle covers ---- */

/* Texels from the middle of the first, by the arithmetic of a GPU: the place in clip space
 * -1..1, then in texels. */
static float texels_across(const pps_opacity_map *map, int i, const double p[3]) {
    float scale = (float)(2 / (map->texels * map->size[i])), half = 0.5F;
    float shift = (float)(-2 * map->low[i] / (map->texels * map->size[i]) - 1);
    float clip = (float)p[0] * ((float)map->axis[i][0] * scale) +
                 (float)p[1] * ((float)map->axis[i][1] * scale) +
                 (float)p[2] * ((float)map->axis[i][2] * scale) + shift;
    return clip * (half * (float)map->texels) + half * (float)map->texels - half;
}

static void place_corners(painter *p) {
    for (size_t v = 0; v < p->mesh->n_vertices; v++) {
        const double *at = p->mesh->position[v];
        const double *along = p->map->axis[2];
        corner *c = &p->corner[v];
        c->across[0] = texels_across(p->map, 0, at);
        c->across[1] = texels_across(p->map, 1, at);
        c->along = (float)at[0] * (float)along[0] + (float)at[1] * (float)along[1] +
                   (float)at[2] * (float)along[2];
        c->x = (int32_t)lrintf(c->across[0] * (float)STEPS);
        c->y = (int32_t)lrintf(c->across[1] * (float)STEPS);
    }
}

/* Twice the area of a, b and the place (x, y): positive to the left of the way a to b. */
static int64_t beside(const corner *a, const corner *b, int64_t x, int64_t y) {
    return (int64_t)(b->x - a->x) * (y - a->y) - (int64_t)(b->y - a->y) * (x - a->x);
}

/* Whether a place on the edge itself belongs to the triangle: left and top edges. */
static bool owns_edge(const corner *a, const corner *b) {
    return b->y < a->y || (b->y == a->y && b->x > a->x);
}

/* False where the triangle has no area on the map. */
static bool lay_out(const painter *p, size_t triangle, outline *o) {
    for (int i = 0; i < 3; i++) {
        o->c[i] = p->corner[p->mesh->triangle[triangle][i]];
    }
    o->area = beside(&o->c[0], &o->c[1], o->c[2].x, o->c[2].y);
    o->exchanged = o->area < 0;
    if (o->exchanged) {
        corner c = o->c[1];
        o->c[1] = o->c[2];
        o->c[2] = c;
        o->area = -o->area;
    }
    return o->area != 0;
}

/* From steps to the first texel whose middle is not below, and the last not above. */
static int64_t texel_up(int64_t steps) { return (steps + STEPS - 1) >> 8; }
static int64_t texel_down(int64_t steps) { return steps >> 8; }

static int64_t least3(int64_t a, int64_t b, int64_t c) {
    int64_t ab = a < b ? a : b;
    return ab < c ? ab : c;
}

/* ---- the passes ---- */

typedef void pass(const painter *p, size_t texel, float along);

static void widen(const painter *p, size_t texel, float along) {
    pps_opacity_map *map = p->map;
    map->first[texel] = fminf(map->first[texel], along);
    map->last[texel] = fmaxf(map->last[texel], along);
}

/* One surface more, in its layer and all behind. */
static void add(const painter *p, size_t texel, int weight, float along) {
    float first = p->map->first[texel], span = p->map->last[texel] - first;
    int layer = span > 0 ? (int)((along - first) / span * LAYERS) : 0;
    for (int k = layer < LAYERS ? layer : LAYERS - 1; k < LAYERS; k++) {
        p->map->count[texel * LAYERS + (size_t)k] += (float)weight;
    }
}

static void add_leaf(const painter *p, size_t texel, float along) {
    add(p, texel, 1, along);
}

static void add_wood(const painter *p, size_t texel, float along) {
    add(p, texel, p->wood, along);
}

static bool covers(const outline *o, int64_t x, int64_t y) {
    for (int i = 0; i < 3; i++) {
        const corner *a = &o->c[i], *b = &o->c[(i + 1) % 3];
        int64_t side = beside(a, b, x * STEPS, y * STEPS);
        if (side < 0 || (side == 0 && !owns_edge(a, b))) {
            return false;
        }
    }
    return true;
}

/* Shares of corners 1 and 2 at the middle of a texel. From the corners as they are, before
 * they moved to whole steps, for so GPUs interpolate: a triangle seen edge-on is steep. */
static void shares(const corner c[3], double x, double y, double *u, double *v) {
    double ab[2], ac[2],
        at[2] = {x - (double)c[0].across[0], y - (double)c[0].across[1]};
    for (int i = 0; i < 2; i++) {
        ab[i] = (double)c[1].across[i] - (double)c[0].across[i];
        ac[i] = (double)c[2].across[i] - (double)c[0].across[i];
    }
    double area = ab[0] * ac[1] - ab[1] * ac[0];
    *u = area != 0 ? (at[0] * ac[1] - at[1] * ac[0]) / area : 0;
    *v = area != 0 ? (ab[0] * at[1] - ab[1] * at[0]) / area : 0;
}

/* Visit the texel (x, y) if the triangle covers it and its surface is there. */
static void visit(const painter *p, size_t triangle, const outline *o, bool cut,
                  int64_t x, int64_t y, pass *each) {
    if (!covers(o, x, y)) {
        return;
    }
    double u, v;
    shares(o->c, (double)x, (double)y, &u, &v);
    double along = (double)o->c[0].along + u * (double)(o->c[1].along - o->c[0].along) +
                   v * (double)(o->c[2].along - o->c[0].along);
    if (!cut || pps_alpha_there(p->mesh, triangle, o->exchanged ? v : u,
                                o->exchanged ? u : v)) {
        each(p, (size_t)(y * p->map->texels + x), (float)along);
    }
}

static void cover(const painter *p, size_t triangle, pass *leaf, pass *wood) {
    outline o;
    bool is_wood = p->mesh->leaf_of[triangle] == PPS_NO_LEAF;
    /* On the map y runs with axis[1] and light comes towards the viewer's back, so what
     * faces the light runs clockwise. */
    if (!lay_out(p, triangle, &o) || (is_wood && !o.exchanged)) {
        return;
    }
    const corner *c = o.c;
    bool cut = pps_alpha_any(p->mesh, triangle);
    int64_t low[2] = {texel_up(least3(c[0].x, c[1].x, c[2].x)),
                      texel_up(least3(c[0].y, c[1].y, c[2].y))};
    int64_t high[2] = {texel_down(-least3(-c[0].x, -c[1].x, -c[2].x)),
                       texel_down(-least3(-c[0].y, -c[1].y, -c[2].y))};
    for (int64_t y = low[1]; y <= high[1]; y++) {
        for (int64_t x = low[0]; x <= high[0]; x++) {
            visit(p, triangle, &o, cut, x, y, is_wood ? wood : leaf);
        }
    }
}

static void paint(const painter *p) {
    size_t n = (size_t)p->map->texels * (size_t)p->map->texels;
    for (size_t t = 0; t < n; t++) {
        p->map->first[t] = INFINITY;
        p->map->last[t] = -INFINITY;
    }
    for (size_t t = 0; t < p->mesh->n_triangles; t++) {
        cover(p, t, widen, widen);
    }
    for (size_t t = 0; t < p->mesh->n_triangles; t++) {
        cover(p, t, add_leaf, add_wood);
    }
}

/* ---- life ---- */

pps_status pps_opacity_map_create(const pps_mesh *mesh, const double to[3],
                                  const pps_opacity_options *options,
                                  pps_opacity_map **out) {
    *out = NULL;
    pps_opacity_map frame;
    pps_status status = pps_opacity_frame(mesh, to, options, &frame);
    if (status) {
        return status;
    }
    size_t n = (size_t)frame.texels * (size_t)frame.texels;
    frame.first = malloc(n * sizeof *frame.first);
    frame.last = malloc(n * sizeof *frame.last);
    frame.count = calloc(n * LAYERS, sizeof *frame.count);
    pps_opacity_map *map = malloc(sizeof *map);
    painter p = {mesh, &frame, malloc((mesh->n_vertices + 1) * sizeof *p.corner),
                 options && options->wood ? options->wood : 1};
    if (frame.first && frame.last && frame.count && map && p.corner) {
        place_corners(&p);
        paint(&p);
        *map = frame;
        *out = map;
    } else {
        free(frame.first);
        free(frame.last);
        free(frame.count);
        free(map);
        status = PPS_ERR_MEMORY;
    }
    free(p.corner);
    return status;
}

void pps_opacity_map_free(pps_opacity_map *map) {
    if (map) {
        free(map->first);
        free(map->last);
        free(map->count);
        free(map);
    }
}

/* ---- looking up ---- */

/* Surfaces down to `along` in a texel: from 0 at the first, linear in each layer; without
 * `own` of them, in the layer that the place is in. */
static double count_down_to(const pps_opacity_map *map, size_t texel, double along,
                            double own) {
    double first = (double)map->first[texel], last = (double)map->last[texel];
    const float *count = map->count + texel * LAYERS;
    if (!(along > first)) { /* also where there is nothing: first is infinite */
        return 0;
    }
    if (!(last > first)) { /* all in one place, and with it `own` */
        return fmax((double)count[0] - own, 0);
    }
    double layers = (along - first) / (last - first) * LAYERS;
    int k = layers < LAYERS ? (int)layers : LAYERS - 1;
    double before = k > 0 ? (double)count[k - 1] : 0;
    double here = fmax((double)count[k] - before - own, 0);
    return before + fmin(layers - k, 1) * here;
}

/* The four texels about a point, their shares (0 off the map), and how far their middles
 * are from the point, in texels. Returns the point's length along the light. */
typedef struct {
    size_t texel;
    double share, off[2];
} near_texel;

static double four_texels(const pps_opacity_map *map, const double point[3],
                          near_texel near[4]) {
    double low[2], part[2];
    for (int i = 0; i < 2; i++) {
        double at = (vec_dot(point, map->axis[i]) - map->low[i]) / map->size[i] - 0.5;
        low[i] = floor(at);
        part[i] = at - low[i];
    }
    for (int k = 0; k < 4; k++) {
        int right = k % 2, up = k / 2;
        double x = low[0] + right, y = low[1] + up;
        bool on = x >= 0 && x < map->texels && y >= 0 && y < map->texels;
        near[k] = (near_texel){
            on ? (size_t)y * (size_t)map->texels + (size_t)x : 0,
            on ? (right ? part[0] : 1 - part[0]) * (up ? part[1] : 1 - part[1]) : 0,
            {right - part[0], up - part[1]}};
    }
    return vec_dot(point, map->axis[2]);
}

/* How fast a plane goes along the light, a texel each way; `bias` in metres. */
static void slope_of(const pps_opacity_map *map, const double *normal, double slope[2],
                     double *bias) {
    double along = vec_dot(normal, map->axis[2]), steep[2];
    for (int i = 0; i < 2; i++) {
        double s = -vec_dot(normal, map->axis[i]) / (fabs(along) > 1e-9 ? along : 1e-9);
        steep[i] = fmin(fmax(s, -STEEPEST), STEEPEST);
        slope[i] = steep[i] * map->size[i];
    }
    *bias =
        BIAS * fmax(map->size[0], map->size[1]) * (1 + fabs(steep[0]) + fabs(steep[1]));
}

bool pps_opacity_look_at(const pps_opacity_map *map, const double point[3],
                         const double *normal, pps_opacity_look *look) {
    near_texel near[4];
    double middle = four_texels(map, point, near), slope[2] = {0, 0}, bias = 0;
    bool on = false;
    *look = (pps_opacity_look){0, 0, 1, 1};
    if (normal) {
        slope_of(map, normal, slope, &bias);
    }
    for (int k = 0; k < 4; k++) {
        size_t t = near[k].texel;
        double share = near[k].share;
        if (share > 0) {
            double first = (double)map->first[t], last = (double)map->last[t];
            double along =
                middle + slope[0] * near[k].off[0] + slope[1] * near[k].off[1];
            double own = normal && along > first - bias && along < last + bias;
            double before = count_down_to(map, t, along, own);
            double all = (double)map->count[t * LAYERS + LAYERS - 1];
            on = true;
            look->depth += share * before;
            look->behind += share * fmax(all - own - before, 0);
            look->visible -= along > first + bias ? share : 0;
            look->clear -= along < last - bias ? share : 0;
        }
    }
    return on;
}

double pps_opacity_depth(const pps_opacity_map *map, const double point[3]) {
    pps_opacity_look look;
    pps_opacity_look_at(map, point, NULL, &look);
    return look.depth;
}

double pps_opacity_visibility(const pps_opacity_map *map, const double point[3],
                              double bias) {
    double nearer[3];
    pps_opacity_look look;
    vec_along(point, -bias, map->axis[2], nearer);
    pps_opacity_look_at(map, nearer, NULL, &look);
    return look.visible;
}
