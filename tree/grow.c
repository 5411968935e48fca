/* A plant from a species and a seed: skeleton, wood, and as many leaves as the triangles
 * asked for leave room for.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>

#include "tree/grow_leaves.h"
#include "tree/grow_textures.h"
#include "tree/grow_wood.h"

enum { LEAF, WOOD, N_MATERIALS };

static char *copy_string(const char *s) {
    size_t size = strlen(s) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, s, size) : NULL;
}

/* A texture for a material, if it could be made. */
static void add_texture(pps_mesh *mesh, pps_material *material, pps_texture texture) {
    if (texture.rgba) {
        material->texture = (int)mesh->n_textures;
        mesh->texture[mesh->n_textures++] = texture;
    }
}

/* The colour of leaves is that of white light on both sides. */
static pps_status add_materials(const pps_species *s, uint64_t seed, pps_mesh *mesh) {
    mesh->n_materials = N_MATERIALS;
    mesh->material = calloc(N_MATERIALS, sizeof *mesh->material);
    mesh->texture = calloc(N_MATERIALS, sizeof *mesh->texture);
    if (!mesh->material || !mesh->texture) {
        return PPS_ERR_MEMORY;
    }
    pps_material *leaf = &mesh->material[LEAF], *wood = &mesh->material[WOOD];
    *leaf = (pps_material){copy_string("leaf"), true, {0}, -1, 0};
    *wood = (pps_material){copy_string("wood"), false, {0}, -1, 0};
    for (int i = 0; i < 3; i++) {
        leaf->color[i] = s->leaves.reflectance[i] + s->leaves.transmittance[i];
        wood->color[i] = s->wood.color[i];
    }
    if (s->leaves.heart > 0) {
        add_texture(mesh, leaf, pps_grow_petal(s));
    }
    if (s->wood.lenticels > 0) {
        add_texture(mesh, wood, pps_grow_bark(s, seed));
    }
    return leaf->name && wood->name ? PPS_OK : PPS_ERR_MEMORY;
}

static pps_status too_much_wood(const char *name, const pps_species *s, size_t wood,
                                pps_problem *problem) {
    if (problem) {
        snprintf(
            problem->text, sizeof problem->text,
            "%.100s: /triangles: wood alone has %zu of the %.0f triangles; ask for "
            "more, or for fewer /crown/points",
            name, wood, s->triangles);
    }
    return PPS_ERR_FORMAT;
}

static pps_status no_place_for_leaves(const char *name, pps_problem *problem) {
    if (problem) {
        snprintf(problem->text, sizeof problem->text,
                 "%.100s: /leaves/wood_below: no wood is that thin", name);
    }
    return PPS_ERR_FORMAT;
}

static pps_status build(const char *name, const pps_species *s, uint64_t seed,
                        const pps_skeleton *skeleton, pps_mesh *mesh,
                        pps_problem *problem) {
    pps_builder b = {mesh, 0, 0, false};
    pps_wood_build(s, seed, skeleton, WOOD, &b);
    if (b.failed) {
        return PPS_ERR_MEMORY;
    }
    size_t wanted = (size_t)s->triangles, wood = mesh->n_triangles;
    size_t each = pps_leaf_triangles(s);
    if (wood + each > wanted) {
        return too_much_wood(name, s, wood, problem);
    }
    size_t n = (wanted - wood + each / 2) / each;
    pps_status status = pps_leaves_build(s, seed, skeleton, n, LEAF, &b);
    if (status == PPS_ERR_ARGUMENT) {
        return no_place_for_leaves(name, problem);
    }
    status = status ? status : add_materials(s, seed, mesh);
    return status ? status : pps_mesh_finish(mesh);
}

pps_status pps_species_grow(const char *name, uint64_t seed, pps_mesh **out,
                            pps_problem *problem) {
    pps_species species;
    pps_skeleton skeleton;
    *out = NULL;
    pps_status status = pps_species_read(name, &species, problem);
    if (status) {
        return status;
    }
    pps_mesh *mesh = calloc(1, sizeof *mesh);
    status = pps_skeleton_grow(&species, seed, &skeleton);
    status = !mesh ? PPS_ERR_MEMORY : status;
    if (!status) {
        status = build(name, &species, seed, &skeleton, mesh, problem);
    }
    free(skeleton.node);
    if (status) {
        pps_mesh_free(mesh);
        return status;
    }
    *out = mesh;
    return PPS_OK;
}

pps_status pps_species_optics(const char *name, pps_leaf_optics *out,
                              pps_problem *problem) {
    pps_species species;
    pps_status status = pps_species_read(name, &species, problem);
    *out = (pps_leaf_optics){.reflectance = {{0}}};
    for (int band = 0; band < 3 && !status; band++) {
        for (int face = 0; face < 2; face++) {
            out->reflectance[face][band] = species.leaves.reflectance[band];
            out->transmittance[face][band] = species.leaves.transmittance[band];
        }
    }
    return status;
}
