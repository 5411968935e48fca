/* Writing meshes: what is written reads back the same, or is not there at all.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ppscat/tree/grow.h>

#include "files.h"
#include "support/support.h"

static pps_problem problem;

static pps_mesh *read_mesh(const char *path) {
    pps_mesh *mesh;
    if (pps_mesh_read(path, NULL, &mesh, &problem)) {
        fail_msg("%s", problem.text);
    }
    return mesh;
}

static void write_mesh(const pps_mesh *mesh, const char *path, const float *color) {
    if (pps_mesh_write(mesh, path, color, &problem)) {
        fail_msg("%s", problem.text);
    }
}

/* Positions are read as floats: 4e-7 m off at 7 m, which is 3e-5 of a leaf of 1.5 cm. */
static void is_same(const pps_mesh *a, const pps_mesh *b) {
    assert_int_equal(a->n_triangles, b->n_triangles);
    assert_int_equal(a->n_leaves, b->n_leaves);
    for (size_t t = 0; t < a->n_triangles; t++) {
        for (int c = 0; c < 3; c++) {
            const double *p = a->position[a->triangle[t][c]];
            const double *q = b->position[b->triangle[t][c]];
            for (int i = 0; i < 3; i++) {
                assert_close(q[i], p[i], 1e-7, 1e-7);
            }
        }
    }
    for (size_t i = 0; i < a->n_leaves; i++) {
        assert_close(b->leaf[i].area, a->leaf[i].area, 1e-4, 0);
        for (int k = 0; k < 3; k++) {
            assert_close(b->leaf[i].normal[k], a->leaf[i].normal[k], 0, 1e-4);
        }
    }
}

static void same_materials(const pps_mesh *a, const pps_mesh *b) {
    assert_int_equal(a->n_materials, b->n_materials);
    assert_int_equal(a->n_textures, b->n_textures);
    for (size_t t = 0; t < a->n_triangles; t++) {
        const pps_material *m = &a->material[a->material_of[t]];
        const pps_material *n = &b->material[b->material_of[t]];
        assert_string_equal(m->name, n->name);
        assert_int_equal(m->leaf, n->leaf);
        assert_int_equal(m->texture >= 0, n->texture >= 0);
        for (int i = 0; i < 3; i++) {
            assert_close(n->color[i], m->color[i], 1e-5, 1e-7);
        }
    }
}

static void a_cut_out_tree_goes_through_obj(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(files_data("trees/oak_small.obj"));
    write_mesh(mesh, files_path("oak.obj"), NULL);
    pps_mesh *again = read_mesh(files_path("oak.obj"));
    is_same(mesh, again);
    same_materials(mesh, again);
    assert_close(again->material[1].alpha_min, 0.5, 0, 0);
    pps_mesh_free(again);
    /* Cut elsewhere than OBJ has it: the areas stay. */
    mesh->material[1].alpha_min = 0.9;
    assert_int_equal(pps_mesh_finish(mesh), PPS_OK);
    write_mesh(mesh, files_path("oak.obj"), NULL);
    again = read_mesh(files_path("oak.obj"));
    is_same(mesh, again);
    pps_mesh_free(again);
    pps_mesh_free(mesh);
}

static void a_grown_tree_goes_through_obj(void **state) {
    (void)state;
    pps_mesh *mesh;
    assert_int_equal(pps_species_grow("cherry", 3, &mesh, &problem), PPS_OK);
    write_mesh(mesh, files_path("cherry.obj"), NULL);
    pps_mesh *again = read_mesh(files_path("cherry.obj"));
    is_same(mesh, again);
    same_materials(mesh, again);
    pps_mesh_free(again);
    pps_mesh_free(mesh);
}

static void a_crown_goes_through_ply_with_colors(void **state) {
    (void)state;
    pps_crown crown = {PPS_CROWN_UNIFORM, 2, 50, 1};
    pps_mesh *mesh;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    float *color = calloc(3 * mesh->n_vertices, sizeof *color);
    color[0] = 0.25F; /* sRGB 0.5371, 136.96 of 255 */
    color[1] = 7;
    color[2] = -1;
    write_mesh(mesh, files_path("crown.ply"), color);
    pps_mesh *again = read_mesh(files_path("crown.ply"));
    is_same(mesh, again);
    pps_mesh_free(again);

    size_t n;
    unsigned char *bytes = files_load(files_path("crown.ply"), &n);
    const char *end = strstr((const char *)bytes, "end_header\n");
    assert_non_null(strstr((const char *)bytes, "property uchar red\n"));
    const unsigned char *rgb = (const unsigned char *)end + 11 + 12;
    assert_int_equal(rgb[0], 137);
    assert_int_equal(rgb[1], 255);
    assert_int_equal(rgb[2], 0);
    assert_int_equal(n - (size_t)((const unsigned char *)end + 11 - bytes),
                     mesh->n_vertices * 15 + mesh->n_triangles * 13);
    free(bytes);

    write_mesh(mesh, files_path("crown.obj"), color);
    again = read_mesh(files_path("crown.obj"));
    is_same(mesh, again);
    pps_mesh_free(again);
    bytes = files_load(files_path("crown.obj"), &n);
    const char *first = strstr((const char *)bytes, "\nv ");
    double p[3], c[3];
    assert_int_equal(
        sscanf(first, " v %lf %lf %lf %lf %lf %lf", p, p + 1, p + 2, c, c + 1, c + 2),
        6);
    assert_close(p[1], mesh->position[0][2], 1e-8, 0); /* y up */
    assert_close(c[0], 0.5371, 1e-4, 0);
    assert_close(c[1], 1, 0, 0);
    assert_close(c[2], 0, 0, 0);
    free(bytes);
    free(color);
    pps_mesh_free(mesh);
}

static void names_of_materials_survive_as_far_as_obj_can(void **state) {
    (void)state;
    pps_crown crown = {PPS_CROWN_UNIFORM, 1, 3, 1};
    pps_mesh *mesh;
    assert_int_equal(pps_crown_grow(&crown, &mesh), PPS_OK);
    free(mesh->material[0].name);
    mesh->material[0].name = strdup("old leaf\n2");
    write_mesh(mesh, files_path("names.obj"), NULL);
    pps_mesh *again = read_mesh(files_path("names.obj"));
    assert_string_equal(again->material[0].name, "old_leaf_2");
    pps_mesh_free(again);
    mesh->material[0].name[0] = '\0'; /* a name that says what it is */
    write_mesh(mesh, files_path("names.obj"), NULL);
    again = read_mesh(files_path("names.obj"));
    assert_string_equal(again->material[0].name, "leaf_0");
    pps_mesh_free(again);
    pps_mesh_free(mesh);
}

/* ---- failures ---- */

static void fails(const pps_mesh *mesh, const char *path, pps_status status,
                  const char *text) {
    size_t before = files_count(), n = strlen(text);
    assert_int_equal(pps_mesh_write(mesh, path, NULL, &problem), status);
    size_t m = strlen(problem.text);
    if (m < n || strcmp(problem.text + m - n, text) != 0) {
        fail_msg("\"%s\" does not end in \"%s\"", problem.text, text);
    }
    assert_int_equal(files_count(), before);
}

static void what_cannot_be_written_leaves_nothing(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(files_data("trees/oak_small.obj"));
    fails(mesh, files_path("a.stl"), PPS_ERR_ARGUMENT,
          "a.stl: a mesh is written as .obj or .ply");
    fails(mesh, "nowhere/a.ply", PPS_ERR_FILE,
          "nowhere/a.ply.part: No such file or directory");
    fails(mesh, "nowhere/a.obj", PPS_ERR_FILE,
          "nowhere/a_1.png.part: No such file or directory");
    assert_int_equal(mkdir(files_path("taken.ply"), 0700), 0);
    fails(mesh, files_path("taken.ply"), PPS_ERR_FILE, "taken.ply: Is a directory");
    rmdir(files_path("taken.ply"));
    pps_mesh_free(mesh);
}

/* /dev/full takes the place of the part file. */
static void a_full_disk_is_told(void **state) {
    (void)state;
    static const char *const PART[] = {"full.ply", "full.obj", "full.mtl",
                                       "full_1.png"};
    static const char *const NAME[] = {"full.ply", "full.obj", "full.obj", "full.obj"};
    if (access("/dev/full", W_OK)) {
        skip();
    }
    pps_mesh *mesh = read_mesh(files_data("trees/oak_small.obj"));
    for (int i = 0; i < 4; i++) {
        char part[64], text[100];
        snprintf(part, sizeof part, "%s.part", PART[i]);
        snprintf(text, sizeof text, "%s: No space left on device", part);
        size_t before = files_count();
        assert_int_equal(symlink("/dev/full", files_path(part)), 0);
        assert_int_equal(pps_mesh_write(mesh, files_path(NAME[i]), NULL, &problem),
                         PPS_ERR_FILE);
        assert_non_null(strstr(problem.text, text));
        assert_int_equal(files_count(), before);
    }
    pps_mesh_free(mesh);
}

/* ---- allocation: linked with --wrap, so that the library's calls come here ---- */

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);

static long allocations_left = -1; /* -1: without end */

static bool allowed(void) {
    if (allocations_left > 0) {
        allocations_left--;
        return true;
    }
    return allocations_left < 0;
}

void *__wrap_malloc(size_t size) { return allowed() ? __real_malloc(size) : NULL; }

void *__wrap_calloc(size_t n, size_t size) {
    return allowed() ? __real_calloc(n, size) : NULL;
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    pps_status status = PPS_ERR_MEMORY;
    pps_mesh *mesh = NULL;
    files_text("few.mtl", "newmtl leaf\nmap_Kd few.png\nmap_d few.png\n");
    files_png("few.png", 2, (const unsigned char[2][4]){{9, 9, 9, 255}, {9, 9, 9, 0}},
              true);
    const char *path = files_text(
        "few.obj", "mtllib few.mtl\nusemtl leaf\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\n"
                   "vt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    long n = 0;
    for (; status == PPS_ERR_MEMORY; n++) {
        allocations_left = n;
        status = pps_mesh_read(path, NULL, &mesh, &problem);
        allocations_left = -1;
        assert_true(!mesh || status == PPS_OK);
    }
    assert_int_equal(status, PPS_OK);
    assert_in_range(n, 20, 100);
    size_t before = files_count();
    for (n = 0, status = PPS_ERR_MEMORY; status == PPS_ERR_MEMORY; n++) {
        assert_int_equal(files_count(), before);
        allocations_left = n;
        status = pps_mesh_write(mesh, files_path("less.obj"), NULL, &problem);
        allocations_left = -1;
    }
    assert_int_equal(status, PPS_OK);
    assert_in_range(n, 8, 100);
    assert_int_equal(files_count(), before + 3);
    pps_mesh_free(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cut_out_tree_goes_through_obj),
        cmocka_unit_test(a_grown_tree_goes_through_obj),
        cmocka_unit_test(a_crown_goes_through_ply_with_colors),
        cmocka_unit_test(names_of_materials_survive_as_far_as_obj_can),
        cmocka_unit_test(what_cannot_be_written_leaves_nothing),
        cmocka_unit_test(a_full_disk_is_told),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, files_begin, files_end);
}
