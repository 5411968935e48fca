/* What is lit and by what: plants, instances of them, sun, sky and ground.
 *
 * Light comes in up to four colour bands, all linear. A scene is a plain value that owns
 * its meshes; from a file (docs/tree-files.md) or filled by hand and then indexed.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_TREE_SCENE_H
#define PPSCAT_TREE_SCENE_H

#include <ppscat/tree/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PPS_BANDS_MAX = 4, PPS_FRONT = 0, PPS_BACK = 1 };

/* Of the light that falls on a face (0 front, 1 back): the share that leaves that face
 * again, and the share that leaves the other one; both spread as Lambert's law has it. */
typedef struct pps_leaf_optics {
    double reflectance[2][PPS_BANDS_MAX], transmittance[2][PPS_BANDS_MAX];
} pps_leaf_optics;

typedef struct pps_prototype {
    char *name;
    pps_mesh *mesh; /* owned */
    pps_leaf_optics optics;
} pps_prototype;

/* A prototype scaled, turned about the vertical by yaw degrees, and moved. */
typedef struct pps_instance {
    int prototype;
    double translation[3], yaw, scale;
} pps_instance;

typedef struct pps_sun {
    double to[3];                     /* unit vector towards the sun */
    double irradiance[PPS_BANDS_MAX]; /* normal to itself; 0: no sun */
} pps_sun;

/* Radiance from direction z = sin(elevation): horizon + (zenith - horizon) z for z >= 0,
 * `below` for z < 0 (only where there is no ground). */
typedef struct pps_sky {
    double zenith[PPS_BANDS_MAX], horizon[PPS_BANDS_MAX], below[PPS_BANDS_MAX];
} pps_sky;

/* An infinite Lambertian plane. */
typedef struct pps_ground {
    bool present;
    double height;
    double reflectance[PPS_BANDS_MAX];
} pps_ground;

typedef struct pps_scene {
    int n_bands;
    char *band[PPS_BANDS_MAX]; /* names, e.g. "red" */
    size_t n_prototypes, n_instances;
    pps_prototype *prototype;
    pps_instance *instance;
    pps_sun sun;
    pps_sky sky;
    pps_ground ground;
    double period[2]; /* metres along x and y; 0, 0: open, else the scene repeats */
    /* Filled by pps_scene_index: leaves of all instances in one row, leaf j of instance i
     * is number first_leaf[i] + j. */
    size_t n_leaves, *first_leaf;
} pps_scene;

/* Read a scene (.json, docs/tree-files.md), or a bare mesh, which gets the light of
 * pps_scene_of_mesh. A name without dot and slash is one of those that come with the
 * library: CHERRY16, .. FILE, FORMAT (the problem names the line, or the JSON pointer),
 * MEMORY; ARGUMENT: a bare mesh without leaves, or no scene of that name. */
PPS_API pps_status pps_scene_read(const char *name, pps_scene **out,
                                  pps_problem *problem);

/* One mesh, which the scene then owns, in the light of a clear day: bands red, green and
 * blue, a sun 50 degrees high to the front left of the plant, blue sky, ground at the
 * plant's foot; optics from the leaves' own colour. The mesh is freed when this fails. */
PPS_API pps_status pps_scene_of_mesh(pps_mesh *mesh, pps_scene **out);

/* Optics from a mesh's colours, [3] linear red, green, blue: the share that is not absorbed
 * is the leaves' mean colour (image times material, where the surface is), half of it
 * reflected and half transmitted by both faces. White leaves without an image are taken as
 * green ones. */
PPS_API void pps_mesh_optics(const pps_mesh *mesh, pps_leaf_optics *optics);

/* What leaves scatter of light in a band, mean of both faces. */
PPS_API double pps_leaf_albedo(const pps_leaf_optics *optics, int band);

/* Unit vector towards the sun; x is east, y north, z up. Degrees, north and east positive;
 * time as ISO 8601 with its zone, "2026-06-21T12:00:00+02:00", years 1900 to 2100. Good to
 * 0.02 degree, without refraction (Meeus 1998, chapter 25). ARGUMENT. */
PPS_API pps_status pps_sun_direction(double latitude, double longitude,
                                     const char *time, double to[3],
                                     pps_problem *problem);

/* One mesh, which the scene then owns, at the origin; sun overhead of irradiance 1, no
 * sky, no ground, one band, the same albedo/2 reflected and transmitted by both faces.
 * The mesh is freed when this fails. */
PPS_API pps_status pps_scene_single(pps_mesh *mesh, double albedo, pps_scene **out);

/* Check a scene and number its leaves; again after any change of the instances. */
PPS_API pps_status pps_scene_index(pps_scene *scene);
PPS_API void pps_scene_free(pps_scene *scene); /* NULL is fine */

/* Of a leaf: its instance, its number there, and place, normal and area in the scene. */
typedef struct pps_scene_leaf {
    size_t instance, leaf;
    double center[3], normal[3], area;
} pps_scene_leaf;
PPS_API void pps_scene_leaf_at(const pps_scene *scene, size_t i, pps_scene_leaf *out);

/* From an instance's own space to the scene; a direction keeps its length. */
PPS_API void pps_instance_point(const pps_instance *instance, const double own[3],
                                double out[3]);
PPS_API void pps_instance_direction(const pps_instance *instance, const double own[3],
                                    double out[3]);

/* The box of everything in the scene, and of its leaves alone. */
typedef struct pps_box {
    double low[3], high[3];
} pps_box;
PPS_API void pps_scene_box(const pps_scene *scene, pps_box *all, pps_box *leaves);

/* The radiance of the sky from a unit direction. */
PPS_API double pps_sky_radiance(const pps_sky *sky, int band, double z);

#ifdef __cplusplus
}
#endif
#endif
