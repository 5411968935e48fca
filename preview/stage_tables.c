/* The tables that shaders read: cells, light, and what may stand in the sun.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "preview/stage_own.h"

static const double PI = 3.14159265358979323846;

/* ---- cells ---- */

pps_status stage_fill_static(stage *s) {
    static const uint32_t none = 0;
    bool cells = stage_cells_known(s);
    gl_table_fill(&s->cell_of, GL_R32UI, cells ? s->system->cell_of : &none,
                  (cells ? s->scene->n_leaves : 1) * sizeof none);
    return PPS_OK;
}

/* Scattered light of some sources: (flux, diffuse) of three bands a cell. */
static void put_cell(const stage *s, size_t c, unsigned sources, float *out) {
    static const unsigned kind[] = {PPS_SKY_INDIRECT, PPS_SUN_INDIRECT};
    for (int color = 0; color < 3; color++) {
        int b = stage_band(s->scene, color);
        size_t at = c * (size_t)s->scene->n_bands + (size_t)(b > 0 ? b : 0);
        float *texel = out + 4 * color;
        memset(texel, 0, 4 * sizeof *texel);
        for (int k = 0; k < 2; k++) {
            if (b >= 0 && (sources & kind[k])) {
                for (size_t i = 0; i < 3; i++) {
                    texel[i] += s->system->flux[k][3 * at + i];
                }
                texel[3] += s->system->diffuse[k][at];
            }
        }
    }
}

/* The mean over cells with light of a quarter of the fluence, and of the sky's share:
 * what wood is taken to be in. */
static void find_around(stage *s) {
    double sum[3] = {0, 0, 0}, open = 0, n = 0;
    size_t directions = (size_t)s->system->directions.n;
    for (size_t c = 0; c < s->system->n_cells; c++) {
        double seen = 0;
        float scattered[12];
        for (size_t j = 0; j < directions; j++) {
            seen += (double)s->system->sky[c * directions + j] / (double)directions;
        }
        if (seen > 0) {
            put_cell(s, c, s->options.sources, scattered);
            for (size_t b = 0; b < 3; b++) {
                sum[b] += (double)scattered[4 * b + 3] / 4;
            }
            open += seen;
            n++;
        }
    }
    for (int k = 0; k < 3; k++) {
        int b = stage_band(s->scene, k);
        const pps_sky *sky = &s->scene->sky;
        double all = b < 0 || !(s->options.sources & PPS_SKY)
                         ? 0
                         : PI * (sky->horizon[b] + sky->zenith[b]) / 2;
        s->around[k] = n > 0 ? (float)((sum[k] + open * all) / n) : 0;
    }
}

static pps_status fill_cells(stage *s) {
    size_t n = s->system->n_cells, directions = (size_t)s->system->directions.n;
    size_t stride = (directions + 3) / 4 * 4;
    unsigned sources =
        s->options.sources & ~(unsigned)(stage_by_point(s) ? PPS_SUN_INDIRECT : 0);
    float *scattered = calloc(16 * n + 1, sizeof *scattered);
    float *sky = calloc(stride * n + 1, sizeof *sky);
    pps_status status = scattered && sky ? PPS_OK : PPS_ERR_MEMORY;
    for (size_t c = 0; c < n && !status; c++) {
        put_cell(s, c, sources, scattered + 16 * c);
        scattered[16 * c + 12] = s->system->g[c];
        memcpy(sky + stride * c, s->system->sky + directions * c,
               directions * sizeof *sky);
    }
    if (!status) {
        gl_table_fill(&s->scattered, GL_RGBA32F, scattered, 16 * n * sizeof *scattered);
        gl_table_fill(&s->sky_shares, GL_RGBA32F, sky, stride * n * sizeof *sky);
        find_around(s);
    }
    free(scattered);
    free(sky);
    return status;
}

/* Irradiance of front and back of every leaf; wood is in their mean. */
static pps_status fill_leaves(stage *s) {
    size_t n = s->scene->n_leaves;
    float *light = calloc(8 * n + 1, sizeof *light);
    double sum[3] = {0, 0, 0};
    if (!light) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < 3 * n; i++) {
        int color = (int)(i % 3), b = stage_band(s->scene, color);
        if (b >= 0) {
            size_t leaf = i / 3, at = leaf * (size_t)s->scene->n_bands + (size_t)b;
            light[8 * leaf + (size_t)color] = (float)s->leaves->front[at];
            light[8 * leaf + 4 + (size_t)color] = (float)s->leaves->back[at];
            sum[color] += s->leaves->front[at] + s->leaves->back[at];
        }
    }
    for (int k = 0; k < 3; k++) {
        s->around[k] = (float)(sum[k] / (2 * (double)n));
    }
    gl_table_fill(&s->leaf_light, GL_RGBA32F, light, 8 * n * sizeof *light);
    free(light);
    return PPS_OK;
}

pps_status stage_fill_light(stage *s) {
    static const float dark[24] = {0};
    if (stage_cells_known(s)) {
        gl_table_fill(&s->leaf_light, GL_RGBA32F, dark, sizeof dark);
        return fill_cells(s);
    }
    gl_table_fill(&s->scattered, GL_RGBA32F, dark, sizeof dark);
    gl_table_fill(&s->sky_shares, GL_RGBA32F, dark, sizeof dark);
    return fill_leaves(s);
}

/* ---- the sun ---- */

/* Instances of one prototype and yaw share a map. */
typedef struct {
    size_t n, *of; /* of: [instance] */
    size_t *first; /* [pose] an instance that has it */
} pose_list;

static pps_status find_poses(const pps_scene *scene, pose_list *out) {
    size_t n = scene->n_instances;
    *out = (pose_list){0, calloc(n + 1, sizeof *out->of),
                       calloc(n + 1, sizeof *out->first)};
    if (!out->of || !out->first) {
        free(out->of);
        free(out->first);
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        size_t p = 0;
        for (; p < out->n; p++) {
            const pps_instance *a = &scene->instance[i],
                               *b = &scene->instance[out->first[p]];
            if (a->prototype == b->prototype &&
                fabs(remainder(a->yaw - b->yaw, 360)) < 1e-9) {
                break;
            }
        }
        if (p == out->n) {
            out->first[out->n++] = i;
        }
        out->of[i] = p;
    }
    return PPS_OK;
}

static void free_poses(pose_list *poses) {
    free(poses->of);
    free(poses->first);
}

pps_status stage_count_poses(const pps_scene *scene, size_t *out) {
    pose_list poses;
    pps_status status = find_poses(scene, &poses);
    if (!status) {
        *out = poses.n;
        free_poses(&poses);
    }
    return status;
}

/* Where a pose's map has its texels: rows that give them, and the light's way. */
static void put_pose(const pps_opacity_map *frame, float *out) {
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            out[4 * i + k] = (float)(frame->axis[i][k] / frame->size[i]);
        }
        out[4 * i + 3] = (float)(-frame->low[i] / frame->size[i] - 0.5);
    }
    for (int k = 0; k < 3; k++) {
        out[8 + k] = (float)frame->axis[2][k];
    }
    out[11] = (float)fmax(frame->size[0], frame->size[1]);
}

static pps_status draw_maps(const stage *s, const double to[3], const pose_list *poses,
                            stage_sun *out) {
    float *row = calloc(12 * poses->n, sizeof *row);
    if (!row) {
        return PPS_ERR_MEMORY;
    }
    for (size_t p = 0; p < poses->n; p++) {
        const pps_instance *at = &s->scene->instance[poses->first[p]];
        pps_instance back = {.yaw = -at->yaw, .scale = 1};
        pps_opacity_options options = {.texels = out->maps.texels};
        pps_opacity_map frame;
        double own[3];
        pps_instance_direction(&back, to, own);
        pps_status status = pps_opacity_frame(s->scene->prototype[at->prototype].mesh,
                                              own, &options, &frame);
        if (status) {
            free(row);
            return status;
        }
        gpu_maps_draw(&out->maps, (int)p, &s->mesh[at->prototype], &frame, 0);
        put_pose(&frame, row + 12 * p);
    }
    gl_table_fill(&out->poses, GL_RGBA32F, row, 12 * poses->n * sizeof *row);
    free(row);
    return PPS_OK;
}

/* Casters: instances, and after them those of neighbouring periods that give shade. */
static pps_status put_casters(const stage *s, const pose_list *poses, stage_sun *out) {
    const pps_scene *scene = s->scene;
    size_t n = s->system ? s->system->n_casters : scene->n_instances;
    float *row = calloc(8 * n, sizeof *row);
    if (!row) {
        return PPS_ERR_MEMORY;
    }
    for (size_t k = 0; k < n; k++) {
        double offset[2] = {0, 0};
        size_t i = s->system ? pps_system_caster(s->system, k, offset) : k;
        const pps_instance *at = &scene->instance[i];
        float *r = row + 8 * k;
        r[0] = (float)(at->translation[0] + offset[0]);
        r[1] = (float)(at->translation[1] + offset[1]);
        r[2] = (float)at->translation[2];
        r[3] = (float)(1 / at->scale);
        r[4] = (float)cos(at->yaw * PI / 180);
        r[5] = (float)sin(at->yaw * PI / 180);
        r[6] = (float)poses->of[i];
        r[7] = (float)i;
    }
    gl_table_fill(&out->casters, GL_RGBA32F, row, 8 * n * sizeof *row);
    free(row);
    return PPS_OK;
}

/* Lists of casters: of each instance, then of the ground (every instance). Without a
 * system an instance's list is itself alone: its leaves have their light already. */
static pps_status put_shade(const stage *s, bool ground_only, stage_sun *out) {
    size_t n = s->scene->n_instances;
    const size_t *first = ground_only || !s->system ? NULL : s->system->shade_first;
    size_t n_lists = first ? first[n] : n, total = n + 2 + n_lists + n;
    uint32_t *row = calloc(total, sizeof *row);
    if (!row) {
        return PPS_ERR_MEMORY;
    }
    for (size_t i = 0; i <= n; i++) {
        row[i] = (uint32_t)(n + 2 + (first ? first[i] : i));
    }
    row[n + 1] = (uint32_t)total;
    for (size_t k = 0; k < n_lists; k++) {
        row[n + 2 + k] = first ? s->system->shade_list[k] : (uint32_t)k;
    }
    for (size_t i = 0; i < n; i++) {
        row[n + 2 + n_lists + i] = (uint32_t)i;
    }
    gl_table_fill(&out->shade, GL_R32UI, row, total * sizeof *row);
    free(row);
    return PPS_OK;
}

pps_status stage_fill_sun(const stage *s, const double to[3], bool ground_only,
                          stage_sun *out) {
    pose_list poses;
    pps_status status = find_poses(s->scene, &poses);
    if (status) {
        return status;
    }
    status = draw_maps(s, to, &poses, out);
    if (!status) {
        status = put_casters(s, &poses, out);
    }
    if (!status) {
        status = put_shade(s, ground_only, out);
    }
    free_poses(&poses);
    return status;
}

void stage_sun_free(stage_sun *sun) {
    gpu_maps_free(&sun->maps);
    gl_table_free(&sun->casters);
    gl_table_free(&sun->poses);
    gl_table_free(&sun->shade);
}

static void use_array(GLuint texture, GLuint program, const char *name, int unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    gl_set_int(program, name, unit);
}

void stage_use_sun(const stage_sun *sun, GLuint program) {
    glUseProgram(program);
    use_array(sun->maps.span, program, "spans", UNIT_SPANS);
    use_array(sun->maps.count[0], program, "near_counts", UNIT_NEAR);
    use_array(sun->maps.count[1], program, "far_counts", UNIT_FAR);
    gl_table_use(&sun->casters, program, "casters", UNIT_CASTERS);
    gl_table_use(&sun->poses, program, "poses", UNIT_POSES);
    gl_table_use(&sun->shade, program, "shade", UNIT_SHADE);
    gl_set_int(program, "map_texels", sun->maps.texels);
}
