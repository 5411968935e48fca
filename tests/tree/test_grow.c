/* Grown plants: the numbers of their species for every seed, sound wood, leaves on it.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <jansson.h>

#include <ppscat/tree/grow.h>

#include "support/support.h"
#include "tree/species.h"
#include "tree/vec.h"
#include "tree/weld.h"

static const char *const SPECIES[] = {"cherry", "maple"};
enum { CHERRY, MAPLE, N_SPECIES };

static pps_mesh *grow(const char *name, uint64_t seed) {
    pps_mesh *mesh;
    pps_problem problem = {""};
    if (pps_species_grow(name, seed, &mesh, &problem)) {
        fail_msg("%s", problem.text);
    }
    return mesh;
}

/* What the issue asks of them: triangles within 1 %, leaf-area index 2 to 4. */
static void counts_and_leaf_area_hold_for_every_seed(void **state) {
    (void)state;
    const struct {
        double triangles, least_height, most_height;
    } want[] = {{62500, 5.5, 8}, {219000, 4, 6}};
    for (int k = 0; k < N_SPECIES; k++) {
        pps_species species;
        assert_int_equal(pps_species_read(SPECIES[k], &species, NULL), PPS_OK);
        for (uint64_t seed = 1; seed <= 10; seed++) {
            pps_mesh *mesh = grow(SPECIES[k], seed);
            pps_mesh_size size;
            pps_mesh_measure(mesh, &size);
            assert_close((double)mesh->n_triangles, want[k].triangles, 2e-4, 0);
            assert_close(size.leaf_area_index, species.leaf_area_index, 1e-6, 0);
            assert_true(size.leaf_area_index >= 2 && size.leaf_area_index <= 4);
            assert_close(size.low[2], 0, 0, 1e-12);
            assert_true(size.high[2] > want[k].least_height);
            assert_true(size.high[2] < want[k].most_height);
            assert_true(fabs(size.center[0]) < 0.8 && fabs(size.center[1]) < 0.8);
            pps_mesh_free(mesh);
        }
    }
}

/* The foot stands about the origin: the mean of the wood's vertices on the ground. */
static void plants_stand_at_the_origin(void **state) {
    (void)state;
    for (int k = 0; k < N_SPECIES; k++) {
        pps_mesh *mesh = grow(SPECIES[k], 4);
        double mean[2] = {0, 0}, n = 0;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            if (mesh->position[v][2] < 1e-9) {
                mean[0] += mesh->position[v][0];
                mean[1] += mesh->position[v][1];
                n++;
            }
        }
        assert_true(n > 8);
        assert_close(mean[0] / n, 0, 0, 0.06);
        assert_close(mean[1] / n, 0, 0, 0.06);
        pps_mesh_free(mesh);
    }
}

static void a_seed_is_a_plant(void **state) {
    (void)state;
    for (int k = 0; k < N_SPECIES; k++) {
        pps_mesh *a = grow(SPECIES[k], 7), *b = grow(SPECIES[k], 7),
                 *c = grow(SPECIES[k], 8);
        assert_int_equal(a->n_vertices, b->n_vertices);
        assert_memory_equal(a->position, b->position,
                            a->n_vertices * sizeof *a->position);
        assert_memory_equal(a->triangle, b->triangle,
                            a->n_triangles * sizeof *a->triangle);
        /* Another seed, another tree: its leaves are not where these are. */
        size_t n = a->n_leaves < c->n_leaves ? a->n_leaves : c->n_leaves, far = 0;
        for (size_t i = 0; i < n; i++) {
            double apart[3];
            vec_sub(a->leaf[i].center, c->leaf[i].center, apart);
            far += vec_length(apart) > 0.3;
        }
        assert_true(far > n / 2);
        pps_mesh_free(a);
        pps_mesh_free(b);
        pps_mesh_free(c);
    }
}

/* The same tree on every machine: points of it as they were when the species was drawn.
 * After a change of a species or of how plants grow, these are to be written anew. */
static void a_seed_is_the_same_plant_everywhere(void **state) {
    (void)state;
    static const struct {
        const char *name;
        size_t n_vertices, vertex;
        double at[3];
    } want[] = {
        {"cherry", 118326, 2958, {1.9005893, -1.5827082, 2.8760089}},
        {"cherry", 118326, 59163, {-1.3511081, -0.2499497, 4.2133769}},
        {"cherry", 118326, 118325, {-2.6308388, 0.7394436, 2.1601681}},
        {"maple", 250864, 6271, {0.8178876, 0.4284600, 2.8775255}},
        {"maple", 250864, 125432, {0.3022110, 0.9931424, 3.7316670}},
        {"maple", 250864, 250863, {1.9493876, 1.0710603, 2.2784571}},
    };
    pps_mesh *mesh = NULL;
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        mesh = grow(want[i].name, 1);
        assert_int_equal(mesh->n_vertices, want[i].n_vertices);
        for (int k = 0; k < 3; k++) {
            assert_close(mesh->position[want[i].vertex][k], want[i].at[k], 0, 1e-6);
        }
        pps_mesh_free(mesh);
    }
}

static void every_number_is_documented(void **state) {
    (void)state;
    static const char *const pointers[] = {
#define X(pointer, member, low, high) pointer,
#include "tree/species.def"
#undef X
        "/crown/profile", "/wood/color", "/leaves/outline", "/leaves/reflectance",
        "/leaves/transmittance"};
    static char text[1 << 16];
    FILE *file = fopen(SPECIES_MD, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    for (size_t i = 0; i < sizeof pointers / sizeof *pointers; i++) {
        char quoted[64];
        snprintf(quoted, sizeof quoted, "`%s`", pointers[i]);
        if (!strstr(text, quoted)) {
            fail_msg("%s is not in docs/species.md", pointers[i]);
        }
    }
}

/* ---- leaves hang on wood ---- */

/* From a point to a triangle (Ericson 2005, section 5.1.5: by Voronoi regions). */
static double distance_to_triangle(const double p[3], const double a[3],
                                   const double b[3], const double c[3]) {
    double ab[3], ac[3], ap[3], bp[3], cp[3], near[3], to[3];
    vec_sub(b, a, ab);
    vec_sub(c, a, ac);
    vec_sub(p, a, ap);
    vec_sub(p, b, bp);
    vec_sub(p, c, cp);
    double d1 = vec_dot(ab, ap), d2 = vec_dot(ac, ap), d3 = vec_dot(ab, bp),
           d4 = vec_dot(ac, bp), d5 = vec_dot(ab, cp), d6 = vec_dot(ac, cp);
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    double v, w;
    if (d1 <= 0 && d2 <= 0) {
        v = w = 0;
    } else if (d3 >= 0 && d4 <= d3) {
        v = 1, w = 0;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        v = d1 / (d1 - d3), w = 0;
    } else if (d6 >= 0 && d5 <= d6) {
        v = 0, w = 1;
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        v = 0, w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        w = (d4 - d3) / (d4 - d3 + d5 - d6), v = 1 - w;
    } else {
        v = vb / (va + vb + vc), w = vc / (va + vb + vc);
    }
    vec_along(a, v, ab, near);
    vec_along(near, w, ac, near);
    vec_sub(p, near, to);
    return vec_length(to);
}

static double distance_to_wood(const pps_mesh *mesh, const double p[3]) {
    double nearest = INFINITY;
    for (size_t t = mesh->n_triangles; t-- > 0 && mesh->leaf_of[t] == PPS_NO_LEAF;) {
        const double *a = mesh->position[mesh->triangle[t][0]];
        const double *b = mesh->position[mesh->triangle[t][1]];
        const double *c = mesh->position[mesh->triangle[t][2]];
        if (fabs(a[2] - p[2]) < 1) { /* no triangle is longer than that */
            nearest = fmin(nearest, distance_to_triangle(p, a, b, c));
        }
    }
    return nearest;
}

static void every_leaf_hangs_on_wood(void **state) {
    (void)state;
    for (int k = 0; k < N_SPECIES; k++) {
        pps_species species;
        pps_mesh *mesh = grow(SPECIES[k], 3);
        assert_int_equal(pps_species_read(SPECIES[k], &species, NULL), PPS_OK);
        double most = 0, least = INFINITY;
        for (size_t i = 0; i < mesh->n_leaves; i += 41) {
            uint32_t base = mesh->triangle[mesh->leaf[i].first][0];
            double distance = distance_to_wood(mesh, mesh->position[base]);
            most = fmax(most, distance);
            least = fmin(least, distance);
        }
        /* A stalk's length, and what a twig of three sides is thinner than a round one. */
        assert_true(most <= species.leaves.stalk[1] + species.leaves.wood_below);
        assert_true(most < 0.1);
        assert_true(least > 0);
        pps_mesh_free(mesh);
    }
}

/* ---- sound triangles ---- */

static void no_triangle_is_degenerate(void **state) {
    (void)state;
    for (int k = 0; k < N_SPECIES; k++) {
        for (uint64_t seed = 1; seed <= 4; seed++) {
            pps_mesh *mesh = grow(SPECIES[k], seed);
            for (size_t v = 0; v < mesh->n_vertices; v++) {
                for (int i = 0; i < 3; i++) {
                    assert_true(isfinite(mesh->position[v][i]));
                }
                assert_true(isfinite(mesh->uv[v][0]) && isfinite(mesh->uv[v][1]));
            }
            for (size_t t = 0; t < mesh->n_triangles; t++) {
                const uint32_t *corner = mesh->triangle[t];
                double ab[3], ac[3], n[3];
                vec_sub(mesh->position[corner[1]], mesh->position[corner[0]], ab);
                vec_sub(mesh->position[corner[2]], mesh->position[corner[0]], ac);
                vec_cross(ab, ac, n);
                assert_true(vec_length(n) / 2 > 1e-8); /* a tenth of a square mm */
            }
            pps_mesh_free(mesh);
        }
    }
}

typedef struct {
    uint32_t low, high;
    int up; /* +1 when the triangle runs from low to high, else -1 */
} edge;

static int by_edge(const void *a, const void *b) {
    const edge *p = a, *q = b;
    if (p->low != q->low) {
        return p->low < q->low ? -1 : 1;
    }
    return (p->high > q->high) - (p->high < q->high);
}

/* Edges of the wood: two triangles meet in each, in opposite sense, but for the rings that
 * branches begin with; those are closed, and lie on the ground or inside other wood. */
static void wood_has_no_cracks(void **state) {
    (void)state;
    for (int k = 0; k < N_SPECIES; k++) {
        pps_mesh *mesh = grow(SPECIES[k], 2);
        uint32_t *same = malloc(mesh->n_vertices * sizeof *same);
        edge *edges = malloc(3 * mesh->n_triangles * sizeof *edges);
        int *ends = calloc(mesh->n_vertices, sizeof *ends);
        size_t n = 0, open = 0, crossed = 0;
        assert_int_equal(pps_mesh_weld(mesh, same), PPS_OK);
        for (size_t t = 0; t < mesh->n_triangles; t++) {
            for (int i = 0; i < 3 && mesh->leaf_of[t] == PPS_NO_LEAF; i++) {
                uint32_t a = same[mesh->triangle[t][i]],
                         b = same[mesh->triangle[t][(i + 1) % 3]];
                edges[n++] = (edge){a < b ? a : b, a < b ? b : a, a < b ? 1 : -1};
            }
        }
        qsort(edges, n, sizeof *edges, by_edge);
        for (size_t i = 0, count; i < n; i += count) {
            int up = 0;
            for (count = 0; i + count < n && by_edge(&edges[i], &edges[i + count]) == 0;
                 count++) {
                up += edges[i + count].up;
            }
            assert_true(count <= 2);
            crossed += count == 2 && up != 0;
            if (count == 1) {
                open++;
                ends[edges[i].low]++;
                ends[edges[i].high]++;
            }
        }
        assert_int_equal(crossed, 0);
        assert_true(open > 0 && open < n / 4);
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            assert_true(ends[v] == 0 || ends[v] == 2);
        }
        free(same);
        free(edges);
        free(ends);
        pps_mesh_free(mesh);
    }
}

/* The triangles face outwards, so the tubes' volumes are positive: a trunk of radius r and
 * its branches hold something like a cylinder of some metres. */
static void wood_faces_outwards(void **state) {
    (void)state;
    for (int k = 0; k < N_SPECIES; k++) {
        pps_species species;
        pps_mesh *mesh = grow(SPECIES[k], 5);
        double volume = 0;
        assert_int_equal(pps_species_read(SPECIES[k], &species, NULL), PPS_OK);
        for (size_t t = 0; t < mesh->n_triangles; t++) {
            double n[3];
            const uint32_t *corner = mesh->triangle[t];
            vec_cross(mesh->position[corner[1]], mesh->position[corner[2]], n);
            volume += mesh->leaf_of[t] == PPS_NO_LEAF
                          ? vec_dot(mesh->position[corner[0]], n) / 6
                          : 0;
        }
        double section =
            3.14159 * species.wood.trunk_radius * species.wood.trunk_radius;
        assert_true(volume > section * 0.5 && volume < section * 10);
        pps_mesh_free(mesh);
    }
}

static void materials_tell_leaves_from_wood(void **state) {
    (void)state;
    pps_mesh *mesh = grow("cherry", 1);
    assert_int_equal(mesh->n_materials, 2);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const pps_material *m = &mesh->material[mesh->material_of[t]];
        assert_true(m->leaf == (mesh->leaf_of[t] != PPS_NO_LEAF));
        assert_string_equal(m->name, m->leaf ? "leaf" : "wood");
    }
    pps_mesh_free(mesh);
}

static void optics_are_those_of_the_species(void **state) {
    (void)state;
    pps_leaf_optics optics;
    assert_int_equal(pps_species_optics("maple", &optics, NULL), PPS_OK);
    for (int face = 0; face < 2; face++) { /* red leaves */
        assert_true(optics.reflectance[face][0] > 5 * optics.reflectance[face][1]);
        assert_true(optics.transmittance[face][0] > 5 * optics.transmittance[face][2]);
    }
    assert_int_equal(pps_species_optics("oak", &optics, NULL), PPS_ERR_ARGUMENT);
}

/* ---- what is refused ---- */

/* A species file with one value replaced by JSON text (NULL: taken away). */
static void write_changed(const char *group, const char *member, const char *text,
                          const char *path) {
    json_t *root = json_load_file(CHERRY_JSON, 0, NULL);
    assert_non_null(root);
    json_t *object = *group ? json_object_get(root, group) : root;
    if (text) {
        json_object_set_new(object, member, json_loads(text, JSON_DECODE_ANY, NULL));
    } else {
        json_object_del(object, member);
    }
    assert_int_equal(json_dump_file(root, path, 0), 0);
    json_decref(root);
}

static void bad_values_are_refused_with_their_pointer(void **state) {
    (void)state;
    static const struct {
        const char *group, *member, *text, *says;
    } cases[] = {
        {"", "triangles", "100", "/triangles: 100 is not a whole number from 200 to"},
        {"", "triangles", "62500.5", "/triangles: 62500.5"},
        {"", "triangles", "3000", "/triangles: wood alone has"},
        {"", "leaf_area_index", "-1", "/leaf_area_index: -1 is not a number from 0.01"},
        {"", "leaf_area_index", "\"2\"", "/leaf_area_index: \"2\""},
        {"", "leaf_area_index", NULL, "/leaf_area_index is missing"},
        {"", "colour", "1", "/colour is not a member of a species"},
        {"growth", "step", "0", "/growth/step: 0 is not a number from 0.02 to 2"},
        {"growth", "stop", "0", "/growth/stop is not a member"},
        {"wood", "sides", "2", "/wood/sides: 2 is not a whole number from 3 to 64"},
        {"wood", "color", "[1, 2, 0]", "/wood/color is not three numbers"},
        {"wood", "twig_radius", "0.5", "/wood/twig_radius must be below"},
        {"leaves", "wood_below", "0.0029", "/wood/twig_radius must be below /leaves"},
        {"leaves", "cluster", "1.5", "/leaves/cluster: 1.5 is not a whole number"},
        {"leaves", "outline", "[[-1, 1], [1, 1]]", "/leaves/outline/1 does not lie"},
        {"leaves", "outline", "[[1, 1]]", "/leaves/outline is not a list of 2 to 60"},
        {"leaves", "outline", "[[1, 1], [0]]", "/leaves/outline/1 is not two numbers"},
        {"leaves", "transmittance", "[0.9, 0, 0]", "/leaves/transmittance/0: with the"},
        {"crown", "profile", "[[2, 1], [1, 1]]", "/crown/profile/1: heights"},
        {"crown", "profile", "[[2, 0], [3, 1]]", "/crown/profile/0: heights"},
        {"tiers", "least_radius", "3", "/tiers/least_radius must be"},
    };
    char path[] = "/tmp/ppscat_species_XXXXXX.json";
    int fd = mkstemps(path, 5);
    assert_true(fd >= 0);
    close(fd);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pps_mesh *mesh = (pps_mesh *)&fd;
        pps_problem problem = {""};
        write_changed(cases[i].group, cases[i].member, cases[i].text, path);
        assert_int_equal(pps_species_grow(path, 1, &mesh, &problem), PPS_ERR_FORMAT);
        assert_null(mesh);
        if (!strstr(problem.text, cases[i].says)) {
            fail_msg("'%s' does not say '%s'", problem.text, cases[i].says);
        }
        assert_non_null(strstr(problem.text, path));
    }
    remove(path);
}

static void files_that_are_no_species_are_refused(void **state) {
    (void)state;
    char path[] = "/tmp/ppscat_species_XXXXXX.json";
    pps_mesh *mesh;
    pps_problem problem;
    int fd = mkstemps(path, 5);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, "{\n\"triangles\": 3,,\n}", 20), 20);
    close(fd);
    assert_int_equal(pps_species_grow(path, 1, &mesh, &problem), PPS_ERR_FORMAT);
    assert_non_null(strstr(problem.text, "line 2"));
    remove(path);
    assert_int_equal(pps_species_grow(path, 1, &mesh, &problem), PPS_ERR_FILE);
    assert_non_null(strstr(problem.text, "cannot be read"));
    assert_int_equal(pps_species_grow("oak", 1, &mesh, &problem), PPS_ERR_ARGUMENT);
    assert_string_equal(
        problem.text,
        "no species 'oak'; there are cherry, maple, and files ending in .json");
    assert_int_equal(pps_species_grow("oak", 1, &mesh, NULL), PPS_ERR_ARGUMENT);
}

/* A file grows what the built-in species of the same text grows. */
static void a_species_file_grows_like_the_built_in_one(void **state) {
    (void)state;
    pps_mesh *a = grow("cherry", 9), *b = grow(CHERRY_JSON, 9);
    assert_int_equal(a->n_vertices, b->n_vertices);
    assert_memory_equal(a->position, b->position, a->n_vertices * sizeof *a->position);
    pps_mesh_free(a);
    pps_mesh_free(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_and_leaf_area_hold_for_every_seed),
        cmocka_unit_test(plants_stand_at_the_origin),
        cmocka_unit_test(a_seed_is_a_plant),
        cmocka_unit_test(a_seed_is_the_same_plant_everywhere),
        cmocka_unit_test(every_number_is_documented),
        cmocka_unit_test(every_leaf_hangs_on_wood),
        cmocka_unit_test(no_triangle_is_degenerate),
        cmocka_unit_test(wood_has_no_cracks),
        cmocka_unit_test(wood_faces_outwards),
        cmocka_unit_test(materials_tell_leaves_from_wood),
        cmocka_unit_test(optics_are_those_of_the_species),
        cmocka_unit_test(bad_values_are_refused_with_their_pointer),
        cmocka_unit_test(files_that_are_no_species_are_refused),
        cmocka_unit_test(a_species_file_grows_like_the_built_in_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
