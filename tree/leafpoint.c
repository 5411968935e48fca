/* Random points on leaves: a triangle by its area, a point on it, again where it is cut out.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/leafpoint.h"

#include <math.h>

#include "tree/alpha.h"
#include "tree/vec.h"

/* A leaf that is there nowhere is given up after so many draws. */
enum { MOST_DRAWS = 1000 };

/* Roberts (2018): powers of 1/1.2207.., the root of x^4 = x + 1; their multiples spread
 * evenly over the unit cube. */
static const double SPREAD[3] = {0.8191725133961645, 0.6710436067037893,
                                 0.5497004779019703};

typedef struct {
    const double *a;
    double ab[3], ac[3], normal[3], area; /* normal of length 2 area */
} triangle;

static triangle triangle_at(const pps_mesh *mesh, size_t t) {
    const uint32_t *corner = mesh->triangle[t];
    triangle out = {.a = mesh->position[corner[0]]};
    vec_sub(mesh->position[corner[1]], out.a, out.ab);
    vec_sub(mesh->position[corner[2]], out.a, out.ac);
    vec_cross(out.ab, out.ac, out.normal);
    out.area = vec_length(out.normal) / 2;
    return out;
}

/* The triangle in which the area summed from the first reaches u of the whole. */
static size_t pick_triangle(const pps_mesh *mesh, const pps_leaf *leaf, double u) {
    double whole = 0, sum = 0;
    if (leaf->n_triangles == 1) {
        return leaf->first;
    }
    for (uint32_t i = 0; i < leaf->n_triangles; i++) {
        whole += triangle_at(mesh, leaf->first + i).area;
    }
    for (uint32_t i = 0; i + 1 < leaf->n_triangles; i++) {
        sum += triangle_at(mesh, leaf->first + i).area;
        if (u * whole < sum) {
            return leaf->first + i;
        }
    }
    return leaf->first + leaf->n_triangles - 1;
}

/* The point of a leaf that three uniform numbers stand for; false where it is cut out. */
static bool place(const pps_scene *scene, const pps_scene_leaf *at, const double r[3],
                  pps_leaf_point *out) {
    const pps_instance *instance = &scene->instance[at->instance];
    const pps_mesh *mesh = scene->prototype[instance->prototype].mesh;
    size_t number = pick_triangle(mesh, &mesh->leaf[at->leaf], r[0]);
    bool fold = r[1] + r[2] > 1; /* the other half of the parallelogram */
    double u = fold ? 1 - r[1] : r[1], v = fold ? 1 - r[2] : r[2], own[3];
    triangle t = triangle_at(mesh, number);
    vec_along(t.a, u, t.ab, own);
    vec_along(own, v, t.ac, own);
    out->instance = at->instance;
    out->triangle = (uint32_t)number;
    out->u = u;
    out->v = v;
    vec_normalize(t.normal);
    pps_instance_point(instance, own, out->point);
    pps_instance_direction(instance, t.normal, out->normal);
    return pps_alpha_there(mesh, number, u, v);
}

void pps_leaf_point_draw(const pps_scene *scene, size_t leaf, uint64_t seed,
                         pps_random_stream stream, uint64_t item, pps_leaf_point *out) {
    pps_scene_leaf at;
    pps_scene_leaf_at(scene, leaf, &at);
    for (uint64_t draw = 0; draw < MOST_DRAWS; draw++) {
        pps_uniforms r = pps_random(seed, stream, item, FIRST_POINT_EVENT + draw);
        if (place(scene, &at, r.u, out)) {
            return;
        }
    }
}

/* A draw that falls where the leaf is cut out is drawn again with another shift: with the
 * same one, points behind holes would be drawn more often than others. */
void pps_leaf_point_spread(const pps_scene *scene, size_t leaf, uint64_t seed,
                           pps_random_stream stream, uint64_t k, pps_leaf_point *out) {
    pps_scene_leaf at;
    pps_scene_leaf_at(scene, leaf, &at);
    for (uint64_t draw = 0; draw < MOST_DRAWS; draw++) {
        pps_uniforms shift = pps_random(seed, stream, leaf, FIRST_POINT_EVENT + draw);
        double r[3];
        for (int i = 0; i < 3; i++) {
            double x = shift.u[i] + (double)k * SPREAD[i];
            r[i] = x - floor(x);
        }
        if (place(scene, &at, r, out)) {
            return;
        }
    }
}
