/* Every pixel of a frame against the library: the light that pps_system_shade_point finds
 * where a ray by Embree through the pixel's middle meets a leaf. Same maps, same cells.
 *
 * A pixel may differ by what single precision does to its point: the light at points
 * around it, as far away as rounding takes it, tells how much that is. Where those points
 * lie on different texels or leaves they differ much, and so may the pixel.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "preview/snapshot.h"
#include "support/support.h"
#include "tests/preview/context.h"
#include "tree/rays.h"
#include "tree/vec.h"

enum { WIDTH = CROWNS_WIDTH, HEIGHT = CROWNS_HEIGHT, OPERATIONS = 64, ROUNDINGS = 16 };

static const double PI = 3.14159265358979323846;

static pps_line through_pixel(const pps_camera *camera, int x, int y) {
    double back[3], right[3], up[3], tangent = tan(camera->field_of_view * PI / 360);
    pps_line line = {.far = INFINITY};
    vec_sub(camera->eye, camera->target, back);
    vec_normalize(back);
    vec_cross(camera->up, back, right);
    vec_normalize(right);
    vec_cross(back, right, up);
    memcpy(line.origin, camera->eye, sizeof line.origin);
    for (int i = 0; i < 3; i++) {
        line.direction[i] =
            tangent * ((2 * x + 1 - WIDTH) * right[i] + (HEIGHT - 2 * y - 1) * up[i]) /
                HEIGHT -
            back[i];
    }
    vec_normalize(line.direction);
    return line;
}

/* Radiance of a leaf without an image, in band 0, a little off the place that was hit. */
static double radiance(const stage *s, unsigned sources, const pps_hit *hit,
                       const double off[3]) {
    const pps_leaf_optics *o = &s->scene->prototype[0].optics;
    double front[PPS_BANDS_MAX], back[PPS_BANDS_MAX], point[3];
    vec_along(hit->point, 1, off, point);
    assert_int_equal(pps_system_shade_point(s->system, sources, hit->leaf, point,
                                            hit->normal, front, back),
                     PPS_OK);
    return hit->front
               ? (o->reflectance[0][0] * front[0] + o->transmittance[1][0] * back[0]) /
                     PI
               : (o->reflectance[1][0] * back[0] + o->transmittance[0][0] * front[0]) /
                     PI;
}

/* Whether a value is the library's, but for rounding: that of the arithmetic, in parts of
 * what the sun may give; that of the point, which lies on the leaf about where the ray
 * meets it; that of its length along the light. */
static bool is_same(const stage *s, unsigned sources, double closed,
                    const pps_line *line, const pps_hit *hit, double got, double want) {
    double rounding = ROUNDINGS * (double)FLT_EPSILON, across[3], along[3];
    double steep = fmax(fabs(vec_dot(hit->normal, line->direction)), 1e-3);
    double reach = rounding * (vec_length(line->origin) + hit->distance) / steep;
    double off_along = rounding * vec_length(hit->point);
    const pps_sun *sun = &s->scene->sun;
    double most = (closed + OPERATIONS * (double)FLT_EPSILON) * sun->irradiance[0] / PI;
    vec_frame(hit->normal, across, along);
    for (int k = 0; k < 16 && fabs(got - want) > most; k++) {
        double off[3], x = reach * cos(k * PI / 4), y = reach * sin(k * PI / 4),
                       z = k < 8 ? off_along : -off_along;
        for (int i = 0; i < 3; i++) {
            off[i] = x * across[i] + y * along[i] + z * sun->to[i];
        }
        most = fmax(most, fabs(radiance(s, sources, hit, off) - want));
    }
    return fabs(got - want) <= most;
}

/* Over pixels of leaves: means of the frame's light, of the library's and of their
 * distance; how many are within tolerance. */
typedef struct {
    size_t n, same;
    double got, want, off;
} likeness;

static likeness compare(const stage *s, const preview_options *o, double closed,
                        const pps_picture *frame) {
    static const double here[] = {0, 0, 0};
    pps_camera camera;
    pps_rays *rays;
    likeness like = {0};
    unsigned sources = o->stage.sources;
    pps_camera_fit(s->scene, o->view[0], o->view[1], (double)WIDTH / HEIGHT, &camera);
    assert_int_equal(pps_rays_create(s->scene, &rays), PPS_OK);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        pps_line line = through_pixel(&camera, i % WIDTH, i / WIDTH);
        pps_hit hit;
        if (pps_rays_nearest(rays, &line, &hit)) {
            double want = radiance(s, sources, &hit, here),
                   got = (double)frame->rgb[3 * i];
            like.n++;
            like.got += got;
            like.want += want;
            like.off += fabs(got - want);
            like.same += is_same(s, sources, closed, &line, &hit, got, want);
        }
    }
    pps_rays_free(rays);
    return like;
}

static void set_albedo(pps_scene *scene, double albedo) {
    for (int face = 0; face < 2; face++) {
        scene->prototype[0].optics.reflectance[face][0] = 0.6 * albedo;
        scene->prototype[0].optics.transmittance[face][0] = 0.4 * albedo;
    }
}

/* All light, or what is scattered alone. At albedo 0.75 the three exponentials of
 * `hemispheric` cancel; at 1 the shader's albedo is 1e-7 less (stage_draw.c), which `closed`
 * allows for. */
static void pixels_are_the_library_s(void **state) {
    (void)state;
    static const struct {
        const char *model;
        bool by_point;
        unsigned sources;
        double albedo, closed;
    } row[] = {{"lattice", false, PPS_ALL_LIGHT, 0.9, 0},
               {"spp", true, PPS_ALL_LIGHT, 0.9, 0},
               {"spp", true, PPS_SUN_INDIRECT, 1, 4e-4},
               {"spp-printed", true, PPS_SUN_INDIRECT, 0.95, 0},
               {"hemispheric", true, PPS_SUN_INDIRECT, 0.75, 0},
               {"sppg", true, PPS_ALL_LIGHT, 0.3, 0}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        pps_problem problem = {""};
        preview_options o = crowns_options(row[i].model, row[i].sources);
        pps_scene *scene = three_crowns();
        o.stage.by_point = row[i].by_point;
        set_albedo(scene, row[i].albedo);
        stage *s = stage_for(scene, &o);
        pps_picture *frame = snapshot_draw(s, &o, &problem);
        assert_non_null(frame);
        likeness like = compare(s, &o, row[i].closed, frame);
        double n = (double)like.n, same = (double)like.same / n;
        print_message(
            "%-11s sources %2u, albedo %.2f: mean %.5f of the library's, mean "
            "difference %.3f %%, %.2f %% of %zu pixels the same\n",
            row[i].model, row[i].sources, row[i].albedo, like.got / like.want,
            100 * like.off / like.want, 100 * same, like.n);
        assert_true(like.n > 10000);
        assert_true(same >= 0.995);
        assert_true(like.off < 0.02 * like.want);
        pps_picture_free(frame);
        stage_done(s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pixels_are_the_library_s)};
    return cmocka_run_group_tests(tests, context_setup, context_teardown);
}
