/* Reading meshes: what users bring, whole and broken.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/mesh.h>

#include "files.h"
#include "support/support.h"

static pps_problem problem;

static pps_mesh *read_with(const char *path, const pps_mesh_read_options *options) {
    pps_mesh *mesh;
    pps_status status = pps_mesh_read(path, options, &mesh, &problem);
    if (status) {
        fail_msg("%s", problem.text);
    }
    return mesh;
}

static pps_mesh *read_mesh(const char *path) { return read_with(path, NULL); }

static double leaf_area(const pps_mesh *mesh) {
    pps_mesh_size size;
    pps_mesh_measure(mesh, &size);
    return size.leaf_area;
}

/* Reading fails with this status, and a text that ends in `text`. */
static void refuses(const char *path, const pps_mesh_read_options *options,
                    pps_status status, const char *text) {
    pps_mesh *mesh = (pps_mesh *)&problem;
    memset(&problem, 0, sizeof problem);
    assert_int_equal(pps_mesh_read(path, options, &mesh, &problem), status);
    assert_null(mesh);
    size_t n = strlen(problem.text), m = strlen(text);
    if (n < m || strcmp(problem.text + n - m, text) != 0) {
        fail_msg("\"%s\" does not end in \"%s\"", problem.text, text);
    }
}

/* ---- trees of others ---- */

static void oak_small_is_read_with_its_cut_out_leaves(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(files_data("trees/oak_small.obj"));
    pps_mesh_size size;
    pps_mesh_measure(mesh, &size);
    assert_int_equal(mesh->n_triangles, 6806); /* lines that start with "f " */
    assert_int_equal(mesh->n_leaves, 1800);
    assert_int_equal(mesh->n_doubled, 0);
    assert_int_equal(mesh->n_materials, 2);
    for (size_t i = 0; i < mesh->n_leaves; i++) {
        assert_int_equal(mesh->leaf[i].n_triangles, 2);
    }
    assert_close(size.low[2], 0, 0, 1e-6); /* y of the file is z */
    assert_close(size.high[2], 44.4104, 1e-6, 0);
    /* Of 1024 x 1024 texels 268,368 have alpha >= 128: 0.2559. */
    assert_close(size.leaf_area, 4093.06 * 268368 / 1048576, 1e-5, 0);
    assert_close(size.leaf_area_index, 1, 0.02, 0);
    pps_mesh_free(mesh);
}

static void oak_medium_without_an_image_has_whole_cards(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(files_data("trees/oak_medium.glb"));
    double whole = leaf_area(mesh);
    assert_int_equal(mesh->n_leaves, 5320);
    assert_int_equal(mesh->n_textures, 0);
    pps_mesh_free(mesh);

    pps_mesh_read_options image = {.leaf_image = files_data("trees/oak_color.png")};
    mesh = read_with(files_data("trees/oak_medium.glb"), &image);
    assert_close(leaf_area(mesh), whole * 268368 / 1048576, 1e-5, 0);
    pps_mesh_free(mesh);
}

/* Cut at many places a file is a smaller mesh (OBJ ends anywhere) or refused in one line;
 * the number of those that were read. */
static size_t cut(const char *from, const char *to, size_t step) {
    size_t n, good = 0;
    unsigned char *bytes = files_load(files_data(from), &n);
    for (size_t end = 0; end < n; end += end < 120 ? 7 : step) {
        pps_mesh *mesh;
        const char *path = files_write(to, bytes, end);
        pps_status status = pps_mesh_read(path, NULL, &mesh, &problem);
        good += status == PPS_OK;
        if (status) {
            assert_null(mesh);
            assert_memory_equal(problem.text, path, strlen(path));
            assert_true(strlen(problem.text) > strlen(path) + 9); /* ": is empty" */
            assert_null(strchr(problem.text, '\n'));
        }
        pps_mesh_free(mesh);
    }
    free(bytes);
    return good;
}

static void truncated_files_are_refused_or_smaller(void **state) {
    (void)state;
    size_t n;
    unsigned char *mtl = files_load(files_data("trees/oak_small.mtl"), &n);
    files_write("oak_small.mtl", mtl, n);
    free(mtl);
    mtl = files_load(files_data("trees/oak_color.png"), &n);
    files_write("oak_color.png", mtl, n);
    free(mtl);
    assert_int_equal(cut("trees/oak_medium.glb", "cut.glb", 40009), 0);
    /* No leaf comes before half of the file. */
    assert_in_range(cut("trees/oak_small.obj", "cut.obj", 70001), 1, 6);
    for (size_t end = 0; end < 3000; end += 97) { /* so is a cut image */
        unsigned char *png = files_load(files_data("trees/oak_color.png"), &n);
        files_write("oak_color.png", png, end);
        free(png);
        files_text("card.mtl", "newmtl leaf\nmap_Kd oak_color.png\n");
        files_text("card.obj",
                   "mtllib card.mtl\nusemtl leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                   "vt 0 0\nf 1/1 2/1 3/1\n");
        pps_mesh *mesh;
        assert_int_equal(pps_mesh_read(files_path("card.obj"), NULL, &mesh, &problem),
                         PPS_ERR_FORMAT);
    }
}

/* Bytes changed at random: read or refused, never worse (run under asan). */
static void damaged_files_do_no_harm(void **state) {
    (void)state;
    static const char SOME[] = "0123456789-.{}[],\"e \n/";
    uint64_t seed = 5;
    size_t n, read = 0;
    unsigned char *bytes = files_load(files_data("trees/oak_medium.glb"), &n);
    for (int k = 0; k < 60; k++) {
        unsigned char kept[3];
        size_t at[3];
        for (int i = 0; i < 3; i++) { /* in the header and its JSON */
            at[i] = (size_t)(support_random(&seed) * 2400);
            kept[i] = bytes[at[i]];
            bytes[at[i]] = (unsigned char)SOME[(size_t)(support_random(&seed) * 21)];
        }
        pps_mesh *mesh;
        files_write("damaged.glb", bytes, n);
        read += pps_mesh_read(files_path("damaged.glb"), NULL, &mesh, &problem) == 0;
        pps_mesh_free(mesh);
        for (int i = 3; i-- > 0;) {
            bytes[at[i]] = kept[i];
        }
    }
    assert_in_range(read, 1, 40);
    free(bytes);
}

/* ---- small files ---- */

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 3 0\n"
#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
#define SQUARE_FACE "f 1/1 2/2 3/3 4/4\n"

static void problems_name_the_file_and_what_is_wrong(void **state) {
    (void)state;
    static const struct {
        const char *name, *text;
        pps_status status;
        const char *problem;
    } rows[] = {
        {"a.obj", "", PPS_ERR_FORMAT, "a.obj: is empty"},
        {"b.txt", "no mesh at all", PPS_ERR_FORMAT,
         "b.txt: not a mesh, or of a format that is not read"},
        {"c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\n", PPS_ERR_FORMAT,
         "c.obj: there is no triangle in it"},
        {"d.obj", TRIANGLE "f 1 2 9\n", PPS_ERR_FORMAT,
         "d.obj: OBJ: vertex index out of range"},
        {"e.obj", "o leaf\nv 0 0 0\nv 1 nan 0\nv 0 3 0\nf 1 2 3\n", PPS_ERR_FORMAT,
         "e.obj: vertex 2 of 'leaf' is not a finite number"},
        {"f.obj", "o leaf\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", PPS_ERR_FORMAT,
         "f.obj: no triangle in it has an area"},
        {"g.obj", "mtllib gone.mtl\nusemtl leaf\n" TRIANGLE "f 1 2 3\n", PPS_ERR_FILE,
         "g.obj: its material library 'gone.mtl': No such file or directory"},
        {"h.obj", "mtllib image.mtl\nusemtl leaf\n" SQUARE SQUARE_FACE, PPS_ERR_FILE,
         "h.obj: its image 'gone.png': No such file or directory"},
        {"i.obj", "mtllib gif.mtl\nusemtl leaf\n" SQUARE SQUARE_FACE, PPS_ERR_FORMAT,
         "i.obj: its image 'leaf.gif': it is neither PNG nor JPEG"},
        {"j.obj",
         "usemtl bark\no trunk\n" TRIANGLE "f 1 2 3\nusemtl Blatt\n" TRIANGLE
         "f 4 5 6\n",
         PPS_ERR_ARGUMENT,
         "j.obj: no material or object name matches 'leaf|leaves|foliage', so there "
         "are "
         "no leaves; its materials are 'bark', 'Blatt'"},
        {"k.gltf", "{\"asset\": {\"version\": \"2.0\"}}", PPS_ERR_FORMAT,
         "k.gltf: GLTF: No scene"},
    };
    files_text("image.mtl", "newmtl leaf\nmap_Kd gone.png\n");
    files_text("gif.mtl", "newmtl leaf\nmap_Kd leaf.gif\n");
    files_text("leaf.gif", "GIF89a and more");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        refuses(files_text(rows[i].name, rows[i].text), NULL, rows[i].status,
                rows[i].problem);
    }
    refuses("nowhere/x.obj", NULL, PPS_ERR_FILE,
            "nowhere/x.obj: No such file or directory");
    refuses(".", NULL, PPS_ERR_FILE, ".: Is a directory");
}

static void bad_options_are_refused(void **state) {
    (void)state;
    const char *path = files_text("ok.obj", "o leaf\n" TRIANGLE "f 1 2 3\n");
    pps_mesh_read_options options = {.leaf = "("};
    refuses(path, &options, PPS_ERR_ARGUMENT,
            "'(' is not a regular expression: Unmatched ( or \\(");
    options = (pps_mesh_read_options){.unit = -1};
    refuses(path, &options, PPS_ERR_ARGUMENT,
            "unit is -1; it must be a number of metres > 0");
    options = (pps_mesh_read_options){.unit = (double)NAN};
    refuses(path, &options, PPS_ERR_ARGUMENT,
            "unit is nan; it must be a number of metres > 0");
}

/* The third corner, at 3 along the file's y, tells where it went. */
static void corner_is(const char *path, pps_up up, double unit, double x, double y,
                      double z) {
    pps_mesh_read_options options = {.up = up, .unit = unit};
    pps_mesh *mesh = read_with(path, &options);
    const double *p = mesh->position[mesh->triangle[0][2]];
    assert_close(p[0], x, 0, 1e-6);
    assert_close(p[1], y, 0, 1e-6);
    assert_close(p[2], z, 0, 1e-6);
    pps_mesh_free(mesh);
}

static void what_is_up_depends_on_the_format_or_the_option(void **state) {
    (void)state;
    const char *obj = files_text("up.obj", "o leaf\n" TRIANGLE "f 1 2 3\n");
    corner_is(obj, PPS_UP_OF_FORMAT, 0, 0, 0, 3);
    corner_is(obj, PPS_UP_Y, 0.01, 0, 0, 0.03);
    corner_is(obj, PPS_UP_Z, 2, 0, 6, 0);
    corner_is(obj, PPS_UP_X, 0, 3, 0, 0);
    const char *ply = files_text(
        "up.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                  "property float y\nproperty float z\nelement face 1\n"
                  "property list uchar int vertex_indices\nend_header\n"
                  "0 0 0\n1 0 0\n0 3 0\n3 0 1 2\n");
    corner_is(ply, PPS_UP_OF_FORMAT, 0, 0, 3, 0);
    const char *stl = files_text(
        "up.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"
                  "vertex 1 0 0\nvertex 0 3 0\nendloop\nendfacet\nendsolid x\n");
    corner_is(stl, PPS_UP_OF_FORMAT, 0, 0, 3, 0);
}

/* FBX says what is up and what its unit is, in centimetres. */
static const char FBX[] =
    "; FBX 7.4.0 project file\n"
    "FBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}\n"
    "GlobalSettings: {\nVersion: 1000\nProperties70: {\n"
    "P: \"UpAxis\", \"int\", \"Integer\", \"\",%d\n"
    "P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",%d\n}\n}\n"
    "Objects: {\nGeometry: 1, \"Geometry::g\", \"Mesh\" {\n"
    "Vertices: *9 {\na: 0,0,0,1,0,0,0,3,0\n}\nPolygonVertexIndex: *3 {\na: "
    "0,1,-3\n}\n}\n"
    "Model: 2, \"Model::leaf\", \"Mesh\" {\nVersion: 232\n}\n}\n"
    "Connections: {\nC: \"OO\",2,0\nC: \"OO\",1,2\n}\n";

static void fbx_files_say_what_is_up(void **state) {
    (void)state;
    char text[2000];
    snprintf(text, sizeof text, FBX, 2, 100);
    corner_is(files_text("up.fbx", text), PPS_UP_OF_FORMAT, 0, 0, 3, 0);
    snprintf(text, sizeof text, FBX, 1, 1);
    corner_is(files_text("up.fbx", text), PPS_UP_OF_FORMAT, 0, 0, 0, 0.03);
    snprintf(text, sizeof text, FBX, 0, 1);
    corner_is(files_text("up.fbx", text), PPS_UP_OF_FORMAT, 10, 0.3, 0, 0);
}

static void object_names_count_where_material_names_say_nothing(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(
        files_text("object.obj", "o trunk\n" TRIANGLE "f 1 2 3\no Leaves.001\n" TRIANGLE
                                 "f 4 5 6\n"));
    assert_int_equal(mesh->n_leaves, 1);
    assert_int_equal(mesh->n_materials, 2);
    assert_int_equal(mesh->leaf_of[1], PPS_NO_LEAF);
    pps_mesh_free(mesh);
    /* With materials that do, they decide: this trunk of the foliage is wood. */
    mesh = read_mesh(files_text("object.obj",
                                "o foliage\nusemtl bark\n" TRIANGLE
                                "f 1 2 3\nusemtl LEAF\n" TRIANGLE "f 4 5 6\n"));
    assert_int_equal(mesh->n_leaves, 1);
    pps_mesh_free(mesh);
}

static void cards_back_to_back_are_one_leaf(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(
        files_text("double.obj",
                   "usemtl leaf\n" SQUARE "f 1 2 3 4\nf 4 3 2 1\n" SQUARE
                   "f 5 6 7\nf 5 7 8\nf 7 6 5\nf 8 7 5\nusemtl leaf_back\nf 5 7 6\n"));
    assert_int_equal(mesh->n_leaves, 1);
    assert_int_equal(mesh->n_triangles, 2);
    assert_int_equal(mesh->n_doubled, 7);
    assert_close(mesh->leaf[0].area, 1, 1e-12, 0);
    assert_close(mesh->leaf[0].normal[1], -1, 1e-12, 0); /* the first one's, y up */
    pps_mesh_free(mesh);
}

static void wood_under_a_leaf_is_kept(void **state) {
    (void)state;
    pps_mesh *mesh = read_mesh(files_text(
        "both.obj", "usemtl leaf\n" TRIANGLE "f 1 2 3\nusemtl bark\nf 3 2 1\n"));
    assert_int_equal(mesh->n_triangles, 2);
    assert_int_equal(mesh->n_leaves, 1);
    pps_mesh_free(mesh);
}

/* ---- cut-out alpha ---- */

/* A texel row: a quarter of the square is there by alpha, half by luminance. */
static const unsigned char ROW[4][4] = {
    {255, 255, 255, 255}, {255, 255, 255, 127}, {0, 0, 0, 0}, {60, 60, 60, 100}};

static double area_of_square(const char *material) {
    files_text("alpha.mtl", material);
    pps_mesh *mesh = read_mesh(
        files_text("alpha.obj", "mtllib alpha.mtl\nusemtl leaf\n" SQUARE SQUARE_FACE));
    double area = leaf_area(mesh);
    pps_mesh_free(mesh);
    return area;
}

static void obj_leaves_are_cut_by_their_images(void **state) {
    (void)state;
    files_png("rgba.png", 4, ROW, true);
    files_png("rgb.png", 4, ROW, false);
    static const struct {
        const char *mtl;
        double area;
    } rows[] = {
        {"newmtl leaf\n", 1},
        {"newmtl leaf\nmap_Kd rgb.png\n", 1},
        {"newmtl leaf\nmap_Kd rgba.png\n", 0.25},
        {"newmtl leaf\nmap_Kd rgba.png\nmap_d rgba.png\n", 0.25},
        {"newmtl leaf\nmap_Kd rgb.png\nmap_d rgba.png\n", 0.25},
        {"newmtl leaf\nmap_Kd rgb.png\nmap_d rgb.png\n", 0.5}, /* by luminance */
        {"newmtl leaf\nmap_Kd rgba.png\nmap_d rgb.png\n", 0.5},
        {"newmtl leaf\nmap_d rgb.png\n", 0.5},
        {"newmtl leaf\nmap_Kd C:\\textures\\rgba.png\n", 0.25}, /* another machine's */
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_close(area_of_square(rows[i].mtl), rows[i].area, 0.03, 0);
    }
}

static void wood_may_lack_its_image(void **state) {
    (void)state;
    files_text("bark.mtl", "newmtl bark\nmap_Kd gone.jpg\nnewmtl leaf\n");
    pps_mesh *mesh = read_mesh(
        files_text("bark.obj", "mtllib bark.mtl\nusemtl bark\n" SQUARE SQUARE_FACE
                               "usemtl leaf\n" SQUARE "f 5/5 6/6 7/7\n"));
    assert_int_equal(mesh->n_textures, 0);
    assert_int_equal(mesh->n_leaves, 1);
    pps_mesh_free(mesh);
}

/* A square card as glTF: `material`, `nodes` and the image are JSON; the file of numbers ends
 * in a PNG of ROW, from byte 92. */
static pps_mesh *read_gltf_with(const char *material, const char *nodes,
                                const char *image) {
    static const float BUFFER[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, /* positions */
                                   0, 1, 1, 1, 1, 0, 0, 0};            /* v down */
    static const unsigned short INDEX[] = {0, 1, 2, 0, 2, 3};
    unsigned char bytes[1000];
    char json[2500];
    size_t length;
    unsigned char *png = files_load(files_png("my rgba.png", 4, ROW, true), &length);
    memcpy(bytes, BUFFER, sizeof BUFFER);
    memcpy(bytes + sizeof BUFFER, INDEX, sizeof INDEX);
    memcpy(bytes + 92, png, length);
    free(png);
    files_write("card.bin", bytes, 92 + length);
    snprintf(
        json, sizeof json,
        "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": "
        "[\"KHR_texture_transform\"], \"scene\": 0, \"scenes\": [{\"nodes\": "
        "[0]}],"
        "\"nodes\": [%s], \"materials\": [{\"name\": \"leaf\", %s}],"
        "\"images\": [%s], \"textures\": [{\"source\": 0}],"
        "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, "
        "\"TEXCOORD_0\": 1}, \"indices\": 2, \"material\": 0}]}],"
        "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, "
        "\"type\": \"VEC3\"}, {\"bufferView\": 1, \"componentType\": 5126, \"count\": "
        "4, "
        "\"type\": \"VEC2\"}, {\"bufferView\": 2, \"componentType\": 5123, \"count\": "
        "6, "
        "\"type\": \"SCALAR\"}],"
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}, {\"buffer\": 0, "
        "\"byteOffset\": 48, \"byteLength\": 32}, {\"buffer\": 0, \"byteOffset\": 80, "
        "\"byteLength\": 12}, {\"buffer\": 0, \"byteOffset\": 92, \"byteLength\": "
        "%zu}], "
        "\"buffers\": [{\"uri\": \"card.bin\", \"byteLength\": %zu}]}",
        nodes, material, image, length, 92 + length);
    return read_mesh(files_text("card.gltf", json));
}

static pps_mesh *read_gltf(const char *material, const char *nodes) {
    return read_gltf_with(material, nodes, "{\"uri\": \"my%20rgba.png\"}");
}

#define IMAGE "\"baseColorTexture\": {\"index\": 0}"

static void gltf_alpha_is_as_its_mode_says(void **state) {
    (void)state;
    static const struct {
        const char *material;
        double area;
    } rows[] = {
        {"\"pbrMetallicRoughness\": {" IMAGE "}", 1},
        {"\"alphaMode\": \"OPAQUE\", \"pbrMetallicRoughness\": {" IMAGE "}", 1},
        {"\"alphaMode\": \"MASK\", \"pbrMetallicRoughness\": {" IMAGE "}", 0.25},
        {"\"alphaMode\": \"BLEND\", \"pbrMetallicRoughness\": {" IMAGE "}", 0.25},
        {"\"alphaMode\": \"MASK\", \"alphaCutoff\": 0.45, \"pbrMetallicRoughness\": "
         "{" IMAGE "}",
         0.5},
        {"\"alphaMode\": \"MASK\", \"alphaCutoff\": 0.3, \"pbrMetallicRoughness\": "
         "{" IMAGE "}",
         0.75},
        {"\"alphaMode\": \"MASK\", \"alphaCutoff\": 0.3, \"pbrMetallicRoughness\": "
         "{" IMAGE ", \"baseColorFactor\": [1, 1, 1, 0.7]}",
         0.5},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        pps_mesh *mesh = read_gltf(rows[i].material, "{\"mesh\": 0}");
        assert_close(leaf_area(mesh), rows[i].area, 0.03, 0);
        pps_mesh_free(mesh);
    }
}

static void images_inside_gltf_are_found(void **state) {
    (void)state;
    pps_mesh *mesh = read_gltf_with(
        "\"alphaMode\": \"MASK\", \"pbrMetallicRoughness\": {" IMAGE "}",
        "{\"mesh\": 0}", "{\"bufferView\": 3, \"mimeType\": \"image/png\"}");
    assert_close(leaf_area(mesh), 0.25, 0.03, 0);
    assert_int_equal(mesh->texture[0].width, 4);
    /* Left to right as in the image. */
    assert_int_equal(mesh->texture[0].rgba[4 * 3], 60);
    pps_mesh_free(mesh);
}

static void textures_may_be_moved_and_scaled(void **state) {
    (void)state;
    pps_mesh *mesh = read_gltf(
        "\"alphaMode\": \"MASK\", \"alphaCutoff\": 0.45, \"pbrMetallicRoughness\": {"
        "\"baseColorTexture\": {\"index\": 0, \"extensions\": "
        "{\"KHR_texture_transform\": "
        "{\"scale\": [0.25, 1], \"offset\": [0.5, 0]}}}}",
        "{\"mesh\": 0}");
    assert_close(leaf_area(mesh), 0, 0, 0.03); /* texel 2 alone */
    pps_mesh_free(mesh);
}

static void nodes_move_turn_scale_mirror_and_repeat(void **state) {
    (void)state;
    pps_mesh *mesh = read_gltf("\"doubleSided\": true",
                               "{\"translation\": [10, 0, 0], \"children\": [1, 2]},"
                               "{\"mesh\": 0, \"scale\": [2, 2, 2], \"rotation\": [0, "
                               "0.7071068, 0, 0.7071068]},"
                               "{\"mesh\": 0, \"scale\": [1, 1, -1]}");
    assert_int_equal(mesh->n_leaves, 2);
    /* Card 0 .. 1 by x and y: doubled, a quarter turn about the vertical: -z 0 .. 2, which
     * is y here; its front, file +z, looks along +x. */
    const pps_leaf *leaf = &mesh->leaf[0];
    const double center[3] = {10, 1, 1}, front[3] = {1, 0, 0}, mirrored[3] = {0, 1, 0};
    for (int i = 0; i < 3; i++) {
        assert_close(leaf[0].center[i], center[i], 0, 1e-6);
        assert_close(leaf[0].normal[i], front[i], 0, 1e-6);
        assert_close(leaf[1].normal[i], mirrored[i], 0, 1e-6); /* file -z */
    }
    assert_close(leaf[0].area, 4, 1e-6, 0);
    assert_close(leaf[1].center[0], 10.5, 1e-6, 0);
    pps_mesh_free(mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oak_small_is_read_with_its_cut_out_leaves),
        cmocka_unit_test(oak_medium_without_an_image_has_whole_cards),
        cmocka_unit_test(truncated_files_are_refused_or_smaller),
        cmocka_unit_test(damaged_files_do_no_harm),
        cmocka_unit_test(problems_name_the_file_and_what_is_wrong),
        cmocka_unit_test(bad_options_are_refused),
        cmocka_unit_test(what_is_up_depends_on_the_format_or_the_option),
        cmocka_unit_test(fbx_files_say_what_is_up),
        cmocka_unit_test(object_names_count_where_material_names_say_nothing),
        cmocka_unit_test(cards_back_to_back_are_one_leaf),
        cmocka_unit_test(wood_under_a_leaf_is_kept),
        cmocka_unit_test(obj_leaves_are_cut_by_their_images),
        cmocka_unit_test(wood_may_lack_its_image),
        cmocka_unit_test(gltf_alpha_is_as_its_mode_says),
        cmocka_unit_test(images_inside_gltf_are_found),
        cmocka_unit_test(textures_may_be_moved_and_scaled),
        cmocka_unit_test(nodes_move_turn_scale_mirror_and_repeat),
    };
    return cmocka_run_group_tests(tests, files_begin, files_end);
}
