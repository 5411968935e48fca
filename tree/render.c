/* Pictures of a scene by primary rays.
 *
 * Leaves shine by the irradiance they are given. Wood and ground, which have none, take
 * the sun where they see it, and the light of sky and leaves from a few directions.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/picture.h>

#include "tree/bar.h"
#include "tree/random.h"
#include "tree/rays.h"
#include "tree/srgb.h"
#include "tree/texture.h"
#include "tree/vec.h"
#include "tree/weld.h"

static const double PI = 3.14159265358979323846;
static const double CREASE = 0.4; /* cosine: sharper edges than this stay sharp */

enum { MOST_SAMPLES = 16, LIGHT_SAMPLES = 16 };

/* What pictures need of a prototype: smooth normals of its wood's vertices, its textures
 * in linear light, and the mean of each material's texture. */
typedef struct {
    double (*normal)[3], (*mean)[3];
    float **linear;
} dress;

typedef struct {
    const pps_scene *scene;
    const pps_irradiance *irradiance;
    const pps_false_color *false_color;
    pps_scene once; /* the scene without its repetitions */
    pps_rays *seen,
        *light;   /* the same, unless the scene repeats: shown once, lit amid all */
    dress *dress; /* of each prototype */
} painter;

/* The directions that one pixel gathers light from: evenly spread over its samples. */
typedef struct {
    double shift[2];
    size_t next, n;
} spread;

/* ---- preparations ---- */

/* Normals of the wood's triangles add up at their corners, by area. */
static pps_status smooth_normals(const pps_mesh *mesh, double (*normal)[3]) {
    uint32_t *same = malloc((mesh->n_vertices + 1) * sizeof *same);
    if (!same || pps_mesh_weld(mesh, same)) {
        free(same);
        return PPS_ERR_MEMORY;
    }
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *corner = mesh->triangle[t];
        double ab[3], ac[3], n[3];
        vec_sub(mesh->position[corner[1]], mesh->position[corner[0]], ab);
        vec_sub(mesh->position[corner[2]], mesh->position[corner[0]], ac);
        vec_cross(ab, ac, n);
        for (int i = 0; i < 3 && mesh->leaf_of[t] == PPS_NO_LEAF; i++) {
            vec_along(normal[same[corner[i]]], 1, n, normal[same[corner[i]]]);
        }
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        memcpy(normal[v], normal[same[v]], sizeof normal[v]);
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        vec_normalize(normal[v]);
    }
    free(same);
    return PPS_OK;
}

static pps_status dress_up(const pps_mesh *mesh, dress *out) {
    out->normal = calloc(mesh->n_vertices + 1, sizeof *out->normal);
    out->mean = calloc(mesh->n_materials + 1, sizeof *out->mean);
    out->linear = calloc(mesh->n_textures + 1, sizeof *out->linear);
    if (!out->normal || !out->mean || !out->linear) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < mesh->n_textures; i++) {
        out->linear[i] = pps_texture_linear(&mesh->texture[i]);
        if (!out->linear[i]) {
            return PPS_ERR_MEMORY;
        }
    }
    for (size_t m = 0; m < mesh->n_materials; m++) {
        pps_texture_mean(mesh, &mesh->material[m], out->mean[m]);
    }
    return smooth_normals(mesh, out->normal);
}

static void painter_free(painter *p) {
    for (size_t i = 0; p->dress && i < p->scene->n_prototypes; i++) {
        free(p->dress[i].normal);
        free(p->dress[i].mean);
        size_t n = p->scene->prototype[i].mesh->n_textures;
        for (size_t t = 0; p->dress[i].linear && t < n; t++) {
            free(p->dress[i].linear[t]);
        }
        free(p->dress[i].linear);
    }
    free(p->dress);
    if (p->light != p->seen) {
        pps_rays_free(p->light);
    }
    pps_rays_free(p->seen);
}

static pps_status painter_init(const pps_scene *scene, painter *p) {
    p->scene = scene;
    p->dress = calloc(scene->n_prototypes, sizeof *p->dress);
    p->once = *scene;
    p->once.period[0] = p->once.period[1] = 0;
    pps_status status = p->dress ? pps_rays_create(&p->once, &p->seen) : PPS_ERR_MEMORY;
    if (!status && scene->period[0] > 0) {
        status = pps_rays_create(scene, &p->light);
    } else {
        p->light = p->seen;
    }
    for (size_t i = 0; i < scene->n_prototypes && !status; i++) {
        status = dress_up(scene->prototype[i].mesh, &p->dress[i]);
    }
    return status;
}

/* ---- light ---- */

/* The band that a colour (0 red, 1 green, 2 blue) is taken from; -1: none. */
static int band_of(const pps_scene *scene, int color) {
    return scene->n_bands == 1 ? 0 : color < scene->n_bands ? color : -1;
}

static const pps_prototype *prototype_of(const painter *p, const pps_hit *hit) {
    return &p->scene->prototype[p->scene->instance[hit->instance].prototype];
}

/* The colour of the texture where a line hits; white where there is none. */
static void texture_at(const painter *p, const pps_hit *hit, double rgb[3]) {
    const pps_prototype *prototype = prototype_of(p, hit);
    const pps_mesh *mesh = prototype->mesh;
    int t = mesh->material[mesh->material_of[hit->triangle]].texture;
    rgb[0] = rgb[1] = rgb[2] = 1;
    if (mesh->uv && t >= 0) {
        const uint32_t *corner = mesh->triangle[hit->triangle];
        double at[2];
        for (int i = 0; i < 2; i++) {
            at[i] = (1 - hit->u - hit->v) * (double)mesh->uv[corner[0]][i] +
                    hit->u * (double)mesh->uv[corner[1]][i] +
                    hit->v * (double)mesh->uv[corner[2]][i];
        }
        const dress *own = &p->dress[prototype - p->scene->prototype];
        pps_texture_at(&mesh->texture[t], own->linear[t], at[0], at[1], rgb);
    }
}

/* (R of the face seen x its irradiance + T of the other x the other's)/pi. The optics are
 * the leaf's mean, so its texture gives the pattern only: divided by its own mean. */
static void leaf_radiance(const painter *p, const pps_hit *hit, double rgb[3]) {
    const pps_prototype *prototype = prototype_of(p, hit);
    const pps_mesh *mesh = prototype->mesh;
    size_t at = hit->leaf * (size_t)p->scene->n_bands;
    int face = hit->front ? PPS_FRONT : PPS_BACK, other = 1 - face;
    const double *own = (hit->front ? p->irradiance->front : p->irradiance->back) + at;
    const double *through =
        (hit->front ? p->irradiance->back : p->irradiance->front) + at;
    double pattern[3];
    const double *mean = p->dress[prototype - p->scene->prototype]
                             .mean[mesh->material_of[hit->triangle]];
    texture_at(p, hit, pattern);
    double grey =
        (pattern[0] + pattern[1] + pattern[2]) / (mean[0] + mean[1] + mean[2]);
    for (int c = 0; c < 3; c++) {
        int b = band_of(p->scene, c);
        rgb[c] = 0;
        if (b >= 0) {
            double light = prototype->optics.reflectance[face][b] * own[b] +
                           prototype->optics.transmittance[other][b] * through[b];
            double share = p->scene->n_bands == 1 ? grey : pattern[c] / mean[c];
            rgb[c] = light / PI * (isfinite(share) ? share : 1); /* black texture */
        }
    }
}

static void sky_radiance(const pps_scene *scene, double z, double rgb[3]) {
    for (int c = 0; c < 3; c++) {
        int b = band_of(scene, c);
        rgb[c] = b < 0 ? 0 : pps_sky_radiance(&scene->sky, b, z);
    }
}

/* The sun's irradiance on a plane through a point: 0 where something is in between. */
static void sun_on(const painter *p, const double point[3], const double geometric[3],
                   const double normal[3], double rgb[3]) {
    const pps_sun *sun = &p->scene->sun;
    double cosine = fmax(0, vec_dot(normal, sun->to));
    if (cosine > 0) {
        pps_line line = pps_rays_leave(p->light, point, geometric, sun->to);
        cosine = pps_rays_occluded(p->light, &line) ? 0 : cosine;
    }
    for (int c = 0; c < 3; c++) {
        int b = band_of(p->scene, c);
        rgb[c] = b < 0 ? 0 : cosine * sun->irradiance[b];
    }
}

/* The ground as the surroundings of other things see it: in the sun or not, under the
 * whole sky. */
static void ground_glimpse(const painter *p, const double point[3], double rgb[3]) {
    static const double up[3] = {0, 0, 1};
    sun_on(p, point, up, up, rgb);
    for (int c = 0; c < 3; c++) {
        int b = band_of(p->scene, c);
        if (b >= 0) {
            const pps_sky *sky = &p->scene->sky;
            double all = PI * (sky->horizon[b] + 2 * sky->zenith[b]) / 3;
            rgb[c] = (rgb[c] + all) * p->scene->ground.reflectance[b] / PI;
        }
    }
}

/* Where a line that meets nothing else meets the ground; false: nowhere. */
static bool on_ground(const pps_scene *scene, const pps_line *line, double point[3]) {
    double drop = scene->ground.height - line->origin[2];
    if (!scene->ground.present || !(drop * line->direction[2] > 0)) {
        return false;
    }
    vec_along(line->origin, drop / line->direction[2], line->direction, point);
    return true;
}

/* Radiance that comes along a line from sky, leaves and ground; wood is black. */
static void light_along(const painter *p, const pps_line *line, double rgb[3]) {
    pps_hit hit;
    double point[3];
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (pps_rays_nearest(p->light, line, &hit)) {
        if (hit.leaf != SIZE_MAX) {
            leaf_radiance(p, &hit, rgb);
        }
    } else if (on_ground(p->scene, line, point)) {
        ground_glimpse(p, point, rgb);
    } else {
        sky_radiance(p->scene, line->direction[2], rgb);
    }
}

/* Irradiance of a plane: sun and, by n cosine-weighted directions, all the rest. */
static void irradiance_at(const painter *p, const double point[3],
                          const double geometric[3], const double normal[3], spread *s,
                          size_t n, double rgb[3]) {
    double x[3], y[3];
    vec_frame(normal, x, y);
    sun_on(p, point, geometric, normal, rgb);
    for (size_t i = 0; i < n; i++, s->next++) {
        double u = s->shift[0] + (double)s->next / (double)s->n;
        double v = s->shift[1] + (double)s->next * 0.6180339887498949;
        u -= floor(u);
        double across = sqrt(u), to[3] = {0, 0, 0}, light[3];
        vec_along(to, across * cos(2 * PI * v), x, to);
        vec_along(to, across * sin(2 * PI * v), y, to);
        vec_along(to, sqrt(1 - u), normal, to);
        vec_normalize(to);
        pps_line line = pps_rays_leave(p->light, point, geometric, to);
        light_along(p, &line, light);
        for (int c = 0; c < 3; c++) {
            rgb[c] += PI / (double)n * light[c];
        }
    }
}

/* ---- surfaces ---- */

/* The wood's own normal where it is smooth, on the side the line comes from. */
static void wood_normal(const painter *p, const pps_hit *hit, const double view[3],
                        double geometric[3], double smooth[3]) {
    const pps_prototype *prototype = prototype_of(p, hit);
    const double(*normal)[3] =
        (const double(*)[3])p->dress[prototype - p->scene->prototype].normal;
    const uint32_t *corner = prototype->mesh->triangle[hit->triangle];
    double own[3] = {0, 0, 0};
    vec_along(own, 1 - hit->u - hit->v, normal[corner[0]], own);
    vec_along(own, hit->u, normal[corner[1]], own);
    vec_along(own, hit->v, normal[corner[2]], own);
    vec_normalize(own);
    pps_instance_direction(&p->scene->instance[hit->instance], own, smooth);
    if (vec_dot(smooth, hit->normal) < CREASE) {
        memcpy(smooth, hit->normal, 3 * sizeof *smooth);
    }
    double side = vec_dot(hit->normal, view) > 0 ? -1 : 1;
    for (int i = 0; i < 3; i++) {
        geometric[i] = side * hit->normal[i];
        smooth[i] *= side;
    }
}

static void wood_radiance(const painter *p, const pps_hit *hit, const double view[3],
                          spread *s, size_t n, double rgb[3]) {
    const pps_mesh *mesh = prototype_of(p, hit)->mesh;
    const double *color = mesh->material[mesh->material_of[hit->triangle]].color;
    double geometric[3], normal[3], pattern[3];
    wood_normal(p, hit, view, geometric, normal);
    irradiance_at(p, hit->point, geometric, normal, s, n, rgb);
    texture_at(p, hit, pattern);
    double grey = 0;
    for (int c = 0; c < 3; c++) {
        grey += color[c] * pattern[c] / 3;
    }
    for (int c = 0; c < 3; c++) {
        rgb[c] *= (p->scene->n_bands == 1 ? grey : color[c] * pattern[c]) / PI;
    }
}

static void ground_radiance(const painter *p, const double point[3], spread *s,
                            size_t n, double rgb[3]) {
    static const double up[3] = {0, 0, 1};
    irradiance_at(p, point, up, up, s, n, rgb);
    for (int c = 0; c < 3; c++) {
        int b = band_of(p->scene, c);
        rgb[c] *= b < 0 ? 0 : p->scene->ground.reflectance[b] / PI;
    }
}

static void look(const painter *p, const pps_line *line, spread *s, size_t n,
                 double rgb[3]) {
    pps_hit hit;
    double point[3];
    if (pps_rays_nearest(p->seen, line, &hit)) {
        if (hit.leaf != SIZE_MAX) {
            leaf_radiance(p, &hit, rgb);
        } else {
            wood_radiance(p, &hit, line->direction, s, n, rgb);
        }
    } else if (on_ground(p->scene, line, point)) {
        ground_radiance(p, point, s, n, rgb);
    } else {
        sky_radiance(p->scene, line->direction[2], rgb);
    }
}

/* Leaves by their value, wood dark, the rest white. */
static void look_false(const painter *p, const pps_line *line, double rgb[3]) {
    pps_hit hit;
    if (!pps_rays_nearest(p->seen, line, &hit)) {
        rgb[0] = rgb[1] = rgb[2] = 1;
    } else if (hit.leaf == SIZE_MAX) {
        rgb[0] = rgb[1] = rgb[2] = 0.04;
    } else {
        pps_bar_color(p->false_color, p->false_color->value[hit.leaf], rgb);
    }
}

/* ---- pixels ---- */

/* The camera as axes: a pixel's direction is -back + x right + y up, x and y in tangents
 * of the view's angles. */
typedef struct {
    double eye[3], right[3], up[3], back[3];
    double tangent; /* of half the picture's height */
} view;

static bool view_init(const pps_camera *camera, view *v) {
    memcpy(v->eye, camera->eye, sizeof v->eye);
    vec_sub(camera->eye, camera->target, v->back);
    vec_cross(camera->up, v->back, v->right);
    bool good = vec_length(v->right) > 1e-12 * vec_length(v->back) &&
                camera->field_of_view > 0 && camera->field_of_view < 180;
    vec_normalize(v->back);
    vec_normalize(v->right);
    vec_cross(v->back, v->right, v->up);
    v->tangent = tan(camera->field_of_view * PI / 360);
    return good;
}

/* Through the place (x, y) of a picture, in pixels, y down. `width` of its columns show
 * the view; when these are not all, the view is made smaller to be as wide as before. */
static pps_line line_through(const view *v, const pps_picture *picture, int width,
                             double x, double y) {
    double tangent = v->tangent * picture->width / width;
    double across = (2 * x - width) / picture->height * tangent;
    double down = (2 * y - picture->height) / picture->height * tangent;
    pps_line line = {.near = 0, .far = INFINITY};
    memcpy(line.origin, v->eye, sizeof line.origin);
    for (int i = 0; i < 3; i++) {
        line.direction[i] = across * v->right[i] - down * v->up[i] - v->back[i];
    }
    vec_normalize(line.direction);
    return line;
}

static void paint_pixel(const painter *p, const view *v, int samples, int width, int x,
                        int y, pps_picture *picture) {
    size_t pixel = (size_t)y * (size_t)picture->width + (size_t)x;
    size_t n = (size_t)samples * (size_t)samples;
    size_t each = (LIGHT_SAMPLES + n - 1) / n;
    pps_uniforms r = pps_random(0, PPS_RANDOM_RENDER, pixel, 0);
    spread s = {{r.u[0], r.u[1]}, 0, n * each};
    double sum[3] = {0, 0, 0};
    for (int k = 0; k < samples * samples; k++) {
        double rgb[3];
        int column = k % samples, row = k / samples;
        pps_line line = line_through(v, picture, width, x + (column + 0.5) / samples,
                                     y + (row + 0.5) / samples);
        if (p->false_color) {
            look_false(p, &line, rgb);
        } else {
            look(p, &line, &s, each, rgb);
        }
        vec_along(sum, 1, rgb, sum);
    }
    for (int c = 0; c < 3; c++) {
        picture->rgb[3 * pixel + (size_t)c] = (float)(sum[c] / (double)n);
    }
}

static pps_status paint(painter *p, const pps_scene *scene, const pps_camera *camera,
                        int samples, int width, pps_picture *picture) {
    view v;
    if (samples < 1 || samples > MOST_SAMPLES || !view_init(camera, &v)) {
        return PPS_ERR_ARGUMENT;
    }
    pps_status status = painter_init(scene, p);
    if (!status) {
#pragma omp parallel for schedule(dynamic, 4)
        for (int y = 0; y < picture->height; y++) {
            for (int x = 0; x < width; x++) {
                paint_pixel(p, &v, samples, width, x, y, picture);
            }
        }
    }
    painter_free(p);
    return status;
}

pps_status pps_render(const pps_scene *scene, const pps_irradiance *irradiance,
                      const pps_camera *camera, int samples, pps_picture *picture) {
    if (irradiance->n_leaves != scene->n_leaves ||
        irradiance->n_bands != scene->n_bands) {
        return PPS_ERR_ARGUMENT;
    }
    painter p = {.irradiance = irradiance};
    return paint(&p, scene, camera, samples, picture->width, picture);
}

pps_status pps_render_false(const pps_scene *scene, const pps_false_color *color,
                            const pps_camera *camera, int samples,
                            pps_picture *picture) {
    if (!(color->low < color->high) || !isfinite(color->high - color->low)) {
        return PPS_ERR_ARGUMENT;
    }
    painter p = {.false_color = color};
    int width = picture->width - (color->bare ? 0 : pps_bar_width(picture));
    pps_status status = paint(&p, scene, camera, samples, width, picture);
    if (!status && !color->bare) {
        pps_bar_draw(color, picture);
    }
    return status;
}
