/* Scene files: what they may hold, and the exact words for what they may not.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/grow.h>
#include <ppscat/tree/scene.h>

#include "files.h"
#include "support/allocation.h"
#include "support/support.h"

static const double PI = 3.14159265358979323846;

static pps_problem problem;

/* A crown of few leaves, and light; a row adds what it is about. */
#define CROWN "\"crown\": \"uniform\", \"leaf_area_index\": 1, \"leaves\": 4"
#define PLANT "\"prototypes\": {\"a\": {" CROWN "}}"
#define LIGHT "\"sky\": 1"
#define WITH(text) "{" PLANT ", " LIGHT ", " text "}"
#define ONE(text) WITH("\"instances\": [{" text "}]")
#define PROTOTYPE(text) "{\"prototypes\": {\"a\": {" text "}}, " LIGHT "}"
#define SUN(text) "{" PLANT ", \"sun\": {" text "}}"
#define GREY(text)                                                                     \
    "{\"bands\": [\"all\"], \"prototypes\": {\"a\": {" text "}}, " LIGHT "}"

static pps_scene *read_scene(const char *path) {
    pps_scene *scene;
    if (pps_scene_read(path, &scene, &problem)) {
        fail_msg("%s", problem.text);
    }
    return scene;
}

static pps_scene *read_text(const char *text) {
    return read_scene(files_text("scene.json", text));
}

/* ---- problems ---- */

static const struct {
    const char *text, *problem; /* after the file's name */
} PROBLEMS[] = {
    /* syntax: line and column */
    {"", ":1:0: '[' or '{' expected near end of file"},
    {"{\"sky\": 1,\n \"sun\" 2}", ":2:8: ':' expected near '2'"},
    {"{\"sky\": 1, \"sky\": 2}", ":1:16: duplicate object key near '\"sky\"'"},
    {"{} x", ":1:4: end of file expected near 'x'"},
    /* the whole */
    {"[1]", ": is an array; it must be an object"},
    {"{\"sky\": 1}", ": /prototypes: is missing; it must be an object of prototypes by "
                     "name, not empty"},
    {"{\"prototypes\": {}, \"sky\": 1}", ": /prototypes: is an object; it must be an "
                                         "object of prototypes by name, not empty"},
    {"{" PLANT "}", ": there is no light: give \"sun\", \"sky\" or both"},
    {WITH("\"skyy\": 1"),
     ": /skyy: there is no such key; the closest allowed is \"sky\""},
    {WITH("\"prototype/s~\": 1"),
     ": /prototype~1s~0: there is no such key; the closest allowed is \"prototypes\""},
    /* bands */
    {WITH("\"bands\": []"),
     ": /bands: is an array; it must be an array of 1 to 4 names"},
    {WITH("\"bands\": \"red\""),
     ": /bands: is \"red\"; it must be an array of 1 to 4 names"},
    {WITH("\"bands\": [\"red\", 2]"),
     ": /bands/1: is 2; it must be a string, not empty"},
    {WITH("\"bands\": [\"red\", \"\"]"),
     ": /bands/1: is \"\"; it must be a string, not empty"},
    {WITH("\"bands\": [\"red\", \"red\"]"),
     ": /bands/1: is \"red\", which comes twice"},
    /* prototypes */
    {"{\"prototypes\": {\"a\": 1}, \"sky\": 1}",
     ": /prototypes/a: is 1; it must be an object"},
    {PROTOTYPE(""),
     ": /prototypes/a: must have one of the keys \"mesh\", \"species\" and \"crown\""},
    {PROTOTYPE("\"mesh\": \"a.obj\", \"crown\": \"tall\""),
     ": /prototypes/a: must have one of the keys \"mesh\", \"species\" and \"crown\""},
    {PROTOTYPE(CROWN ", \"leafs\": 3"),
     ": /prototypes/a/leafs: there is no such key; the closest allowed is \"leaves\""},
    {PROTOTYPE("\"crown\": \"round\", \"leaf_area_index\": 1"),
     ": /prototypes/a/crown: is \"round\"; it must be \"uniform\", \"clumped\", "
     "\"tall\" or "
     "\"hollow\""},
    {PROTOTYPE("\"crown\": \"tall\""),
     ": /prototypes/a/leaf_area_index: is missing; it must be a number > 0"},
    {PROTOTYPE("\"crown\": \"tall\", \"leaf_area_index\": 0"),
     ": /prototypes/a/leaf_area_index: is 0; it must be a number > 0"},
    {PROTOTYPE("\"crown\": \"tall\", \"leaf_area_index\": 1, \"leaves\": 1.5"),
     ": /prototypes/a/leaves: is 1.5; it must be a whole number from 1 to 10000000"},
    {PROTOTYPE(CROWN ", \"seed\": -1"),
     ": /prototypes/a/seed: is -1; it must be a whole number from 0 to "
     "9223372036854775807"},
    {PROTOTYPE("\"species\": 1"),
     ": /prototypes/a/species: is 1; it must be a string, not empty"},
    {PROTOTYPE("\"species\": \"cherry\", \"sed\": 1"),
     ": /prototypes/a/sed: there is no such key; the closest allowed is \"seed\""},
    {PROTOTYPE("\"mesh\": null"),
     ": /prototypes/a/mesh: is null; it must be a string, not empty"},
    {PROTOTYPE("\"mesh\": \"none.obj\", \"leafs\": 1"),
     ": /prototypes/a/leafs: there is no such key; the closest allowed is \"leaf\""},
    {PROTOTYPE("\"mesh\": \"none.obj\", \"up\": \"w\""),
     ": /prototypes/a/up: is \"w\"; it must be \"x\", \"y\" or \"z\""},
    {PROTOTYPE("\"mesh\": \"none.obj\", \"unit\": 0"),
     ": /prototypes/a/unit: is 0; it must be a number > 0"},
    {PROTOTYPE("\"mesh\": \"none.obj\", \"leaf\": 5"),
     ": /prototypes/a/leaf: is 5; it must be a string, not empty"},
    {PROTOTYPE("\"mesh\": \"none.obj\", \"leaf_image\": 5"),
     ": /prototypes/a/leaf_image: is 5; it must be a string, not empty"},
    /* optics */
    {PROTOTYPE(CROWN ", \"optics\": 1"),
     ": /prototypes/a/optics: is 1; it must be an object"},
    {PROTOTYPE(CROWN ", \"optics\": {\"reflectance\": 0.5}"),
     ": /prototypes/a/optics/transmittance: is missing; it must be an array of 3 "
     "numbers, "
     "or one number"},
    {PROTOTYPE(CROWN ", \"optics\": {\"reflectance\": [0.5, 1], \"transmittance\": 0}"),
     ": /prototypes/a/optics/reflectance: is an array of 2; it must be an array of 3 "
     "numbers, or one number"},
    {PROTOTYPE(CROWN
               ", \"optics\": {\"reflectance\": [0, 2, 0], \"transmittance\": 0}"),
     ": /prototypes/a/optics/reflectance/1: is 2; it must be a number from 0 to 1"},
    {PROTOTYPE(CROWN
               ", \"optics\": {\"reflectance\": 0.7, \"transmittance\": [0, 0, 0.5]}"),
     ": /prototypes/a/optics: reflectance + transmittance of band \"blue\" is 1.2; it "
     "must "
     "be <= 1"},
    {PROTOTYPE(CROWN
               ", \"optics\": {\"front\": {\"reflectance\": 0, \"transmittance\": 0}}"),
     ": /prototypes/a/optics/back: is missing; it must be an object"},
    {PROTOTYPE(CROWN ", \"optics\": {\"front\": {}, \"reflectance\": 0}"),
     ": /prototypes/a/optics/reflectance: there is no such key; the closest allowed is "
     "\"front\""},
    {PROTOTYPE(CROWN ", \"optics\": {\"front\": {\"reflectence\": 0}, \"back\": {}}"),
     ": /prototypes/a/optics/front/reflectence: there is no such key; the closest "
     "allowed "
     "is \"reflectance\""},
    {GREY(CROWN),
     ": /prototypes/a/optics: is missing; it must be given where the bands are not "
     "\"red\", \"green\", \"blue\""},
    /* instances */
    {WITH("\"instances\": []"),
     ": /instances: is an array; it must be an array of instances, not empty"},
    {WITH("\"instances\": {}"),
     ": /instances: is an object; it must be an array of instances, not empty"},
    {"{\"prototypes\": {\"a\": {" CROWN "}, \"b\": {" CROWN "}}, " LIGHT "}",
     ": /instances: is missing; it must be an array of instances, not empty"},
    {"{\"prototypes\": {\"a\": {" CROWN "}, \"b\": {" CROWN "}}, " LIGHT
     ", \"instances\": [{}]}",
     ": /instances/0/prototype: is missing; it must be \"a\" or \"b\""},
    {ONE("\"prototype\": \"oak\""),
     ": /instances/0/prototype: is \"oak\"; it must be \"a\""},
    {WITH("\"instances\": [{}, 3]"), ": /instances/1: is 3; it must be an object"},
    {ONE("\"translate\": 0"),
     ": /instances/0/translate: there is no such key; the closest allowed is "
     "\"translation\""},
    {ONE("\"translation\": 3"),
     ": /instances/0/translation: is 3; it must be an array of 3 numbers"},
    {ONE("\"translation\": [0, \"1\", 0]"),
     ": /instances/0/translation/1: is \"1\"; it must be a number"},
    {ONE("\"yaw\": true"), ": /instances/0/yaw: is true; it must be a number"},
    {WITH("\"instances\": [{}, {}, {}, {\"scale\": -1}]"),
     ": /instances/3/scale: is -1; it must be a number > 0"},
    /* grids */
    {ONE("\"grid\": 4, \"spacing\": 1"),
     ": /instances/0/grid: is 4; it must be an array of 2 whole numbers"},
    {ONE("\"grid\": [0, 4], \"spacing\": 1"),
     ": /instances/0/grid/0: is 0; it must be a whole number from 1 to 1000"},
    {ONE("\"grid\": [4, 4]"), ": /instances/0/spacing: is missing; it must be an array "
                              "of 2 numbers, or one number"},
    {ONE("\"grid\": [4, 4], \"spacing\": -1"),
     ": /instances/0/spacing: is -1; it must be a number > 0"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"jitter\": 0.6"),
     ": /instances/0/jitter: is 0.6; it must be a number from 0 to 0.5"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"seed\": 0.5"),
     ": /instances/0/seed: is 0.5; it must be a whole number from 0 to "
     "9223372036854775807"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"center\": [0, 0]"),
     ": /instances/0/center: is an array of 2; it must be an array of 3 numbers"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"yaw_step\": 0"),
     ": /instances/0/yaw_step: is 0; it must be a number > 0 and <= 360"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"scale\": [2, 1]"),
     ": /instances/0/scale: is [2, 1]; the lower end comes first"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"scale\": 0"),
     ": /instances/0/scale: is 0; it must be a number > 0"},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"yaw\": 0"),
     ": /instances/0/yaw: there is no such key; the closest allowed is \"grid\""},
    {ONE("\"grid\": [4, 4], \"spacing\": 1, \"prototype\": \"b\""),
     ": /instances/0/prototype: is \"b\"; it must be \"a\""},
    {WITH("\"instances\": [{}, {\"grid\": [1000, 1000], \"spacing\": 1}]"),
     ": /instances/1: makes 1000001 instances; the most are 1000000"},
    /* sun */
    {"{" PLANT ", \"sun\": 1}", ": /sun: is 1; it must be an object"},
    {SUN(""), ": /sun/direction: is missing; it must be an array of 3 numbers"},
    {SUN("\"direction\": [0, 0, 0]"),
     ": /sun/direction: has no direction: its length is 0"},
    {SUN("\"direction\": [0, 0, 1], \"irradiance\": -1"),
     ": /sun/irradiance: is -1; it must be a number >= 0"},
    {SUN("\"direction\": [0, 0, 1], \"iradiance\": 1"),
     ": /sun/iradiance: there is no such key; the closest allowed is \"irradiance\""},
    {SUN("\"direction\": [0, 0, 1], \"latitude\": 1"),
     ": /sun: has both a direction and a place or time; give one"},
    {SUN("\"latitude\": 91, \"longitude\": 0, \"time\": \"2026-06-21T12:00Z\""),
     ": /sun/latitude: is 91; it must be a number from -90 to 90"},
    {SUN("\"latitude\": 50, \"time\": \"2026-06-21T12:00Z\""),
     ": /sun/longitude: is missing; it must be a number from -180 to 360"},
    {SUN("\"latitude\": 50, \"longitude\": 0, \"time\": \"2026-06-21T12:00\""),
     ": /sun/time: is \"2026-06-21T12:00\"; it must be a date and time with its zone, "
     "as "
     "2026-06-21T12:00:00Z or 2026-06-21T12:00+02:00, of the years 1900 to 2100"},
    {SUN("\"latitude\": 0, \"longitude\": 0, \"time\": \"2026-03-20T23:52:32Z\""),
     ": /sun/time: the sun is 86.30 degrees below the horizon then"},
    {SUN("\"direction\": [0, 0, -1]}, \"ground\": {\"reflectance\": 0"),
     ": /sun/direction: is from below the ground"},
    /* sky, ground, period */
    {"{" PLANT ", \"sky\": \"blue\"}",
     ": /sky: is \"blue\"; it must be an array of 3 numbers, or one number"},
    {"{" PLANT ", \"sky\": {\"zenith\": 1}}",
     ": /sky/horizon: is missing; it must be an array of 3 numbers, or one number"},
    {"{" PLANT ", \"sky\": {\"zenith\": 1, \"horizon\": 1, \"nadir\": 1}}",
     ": /sky/nadir: there is no such key; the closest allowed is \"zenith\""},
    {"{" PLANT ", \"sky\": {\"zenith\": 1, \"horizon\": 1, \"below\": -1}}",
     ": /sky/below: is -1; it must be a number >= 0"},
    {WITH("\"ground\": true"), ": /ground: is true; it must be an object"},
    {WITH("\"ground\": {}"), ": /ground/reflectance: is missing; it must be an array "
                             "of 3 numbers, or one number"},
    {WITH("\"ground\": {\"reflectance\": 1.1}"),
     ": /ground/reflectance: is 1.1; it must be a number from 0 to 1"},
    {WITH("\"ground\": {\"reflectance\": 0, \"height\": []}"),
     ": /ground/height: is an array; it must be a number"},
    {WITH("\"ground\": {\"reflectance\": 0, \"hight\": 0}"),
     ": /ground/hight: there is no such key; the closest allowed is \"height\""},
    {WITH("\"period\": 0"), ": /period: is 0; it must be a number > 0"},
    {WITH("\"period\": [1, 2, 3]"),
     ": /period: is an array of 3; it must be an array of 2 numbers, or one number"},
};

static void every_problem_is_told_in_its_own_words(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof PROBLEMS / sizeof *PROBLEMS; i++) {
        const char *path = files_text("scene.json", PROBLEMS[i].text);
        pps_scene *scene = (pps_scene *)&problem;
        char want[600];
        snprintf(want, sizeof want, "%s%s", path, PROBLEMS[i].problem);
        assert_int_equal(pps_scene_read(path, &scene, &problem), PPS_ERR_FORMAT);
        assert_null(scene);
        assert_string_equal(problem.text, want);
    }
}

/* What meshes and species say is passed on with the place in the scene. */
static void problems_of_plants_are_told_with_their_place(void **state) {
    (void)state;
    char want[600];
    pps_scene *scene;
    const char *path = files_text("scene.json", PROTOTYPE("\"mesh\": \"no.obj\""));
    assert_int_equal(pps_scene_read(path, &scene, &problem), PPS_ERR_FILE);
    snprintf(want, sizeof want, "%s: /prototypes/a/mesh: %s: No such file or directory",
             path, files_path("no.obj"));
    assert_string_equal(problem.text, want);

    files_text("bark.obj", "usemtl bark\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    path = files_text("scene.json", PROTOTYPE("\"mesh\": \"bark.obj\""));
    assert_int_equal(pps_scene_read(path, &scene, &problem), PPS_ERR_FORMAT);
    snprintf(want, sizeof want,
             "%s: /prototypes/a/mesh: %s: no material or object name matches "
             "'leaf|leaves|foliage', so there are no leaves; its materials are 'bark'",
             path, files_path("bark.obj"));
    assert_string_equal(problem.text, want);

    path = files_text("scene.json", PROTOTYPE("\"species\": \"willow\""));
    assert_int_equal(pps_scene_read(path, &scene, &problem), PPS_ERR_FORMAT);
    snprintf(want, sizeof want, "%s: /prototypes/a/species: ", path);
    assert_memory_equal(problem.text, want, strlen(want));
    assert_non_null(strstr(problem.text, "willow"));

    assert_int_equal(pps_scene_read("nowhere/s.json", &scene, &problem), PPS_ERR_FILE);
    assert_string_equal(problem.text, "nowhere/s.json: No such file or directory");
}

/* Those that come with the library are read by name, the same as their files. */
static void scenes_that_come_along_have_names(void **state) {
    (void)state;
    pps_scene *named = read_scene("CHERRY16");
    pps_scene *file = read_scene(PPS_DATA_DIR "/scenes/CHERRY16.json");
    assert_int_equal(named->n_leaves, file->n_leaves);
    assert_memory_equal(named->sun.to, file->sun.to, sizeof named->sun.to);
    pps_scene_free(named);
    pps_scene_free(file);
    assert_int_equal(pps_scene_read("CHERRY17", &named, &problem), PPS_ERR_ARGUMENT);
    assert_null(named);
    assert_string_equal(problem.text,
                        "no scene 'CHERRY17'; there are CHERRY16, CHERRY64, MAPLE16, "
                        "MAPLE64, spp-figure5, spp-figure7, leaf-figure7-1500, "
                        "leaf-figure7-4000, leaf-figure7-9000, leaf-trees-1, "
                        "leaf-trees-4, leaf-trees-100, and files ending in .json");
}

/* ---- what is read ---- */

static void the_least_scene_is_one_plant_and_light(void **state) {
    (void)state;
    pps_scene *scene = read_text("{\"comment\": \"x\", " PLANT ", " LIGHT "}");
    assert_int_equal(scene->n_bands, 3);
    assert_string_equal(scene->band[2], "blue");
    assert_int_equal(scene->n_instances, 1);
    assert_int_equal(scene->n_leaves, 4);
    assert_string_equal(scene->prototype[0].name, "a");
    assert_close(scene->instance[0].scale, 1, 0, 0);
    assert_close(scene->sun.irradiance[0], 0, 0, 0);
    assert_close(scene->sky.zenith[2], 1, 0, 0);
    assert_close(scene->sky.horizon[0], 1, 0, 0);
    assert_close(scene->sky.below[0], 0, 0, 0);
    assert_false(scene->ground.present);
    assert_close(scene->period[0], 0, 0, 0);
    /* The crown's own colour, halved. */
    assert_close(scene->prototype[0].optics.reflectance[1][1], 0.25, 1e-15, 0);
    pps_scene_free(scene);
}

static void every_key_is_read(void **state) {
    (void)state;
    pps_scene *scene = read_text(
        "{\"bands\": [\"a\", \"b\"], \"prototypes\": {"
        "\"p\": {" CROWN ", \"seed\": 3, \"optics\": {\"reflectance\": [0.1, 0.2], "
        "\"transmittance\": 0.3, \"comment\": \"\"}},"
        "\"q\": {" CROWN ", \"optics\": {\"front\": {\"reflectance\": 0.1, "
        "\"transmittance\": 0.2}, \"back\": {\"reflectance\": 0.3, \"transmittance\": "
        "[0.4, 0.5]}}}},"
        "\"instances\": [{\"prototype\": \"q\", \"translation\": [1, 2, 3], \"yaw\": "
        "40, "
        "\"scale\": 1.5}, {\"prototype\": \"p\"}],"
        "\"sun\": {\"direction\": [3, 0, 4], \"irradiance\": [7, 8]},"
        "\"sky\": {\"zenith\": 1, \"horizon\": [2, 3], \"below\": 4},"
        "\"ground\": {\"height\": -1, \"reflectance\": [0.2, 0.3]}, \"period\": [5, "
        "6]}");
    assert_int_equal(scene->n_bands, 2);
    const pps_leaf_optics *p = &scene->prototype[0].optics;
    const pps_leaf_optics *q = &scene->prototype[1].optics;
    for (int face = 0; face < 2; face++) {
        assert_close(p->reflectance[face][1], 0.2, 0, 0);
        assert_close(p->transmittance[face][0], 0.3, 0, 0);
    }
    assert_close(q->reflectance[PPS_FRONT][0], 0.1, 0, 0);
    assert_close(q->transmittance[PPS_FRONT][1], 0.2, 0, 0);
    assert_close(q->reflectance[PPS_BACK][1], 0.3, 0, 0);
    assert_close(q->transmittance[PPS_BACK][1], 0.5, 0, 0);
    assert_int_equal(scene->instance[0].prototype, 1);
    assert_close(scene->instance[0].translation[2], 3, 0, 0);
    assert_close(scene->instance[0].yaw, 40, 0, 0);
    assert_close(scene->instance[0].scale, 1.5, 0, 0);
    assert_int_equal(scene->instance[1].prototype, 0);
    assert_close(scene->sun.to[0], 0.6, 1e-15, 0);
    assert_close(scene->sun.to[2], 0.8, 1e-15, 0);
    assert_close(scene->sun.irradiance[1], 8, 0, 0);
    assert_close(scene->sky.zenith[1], 1, 0, 0);
    assert_close(scene->sky.horizon[1], 3, 0, 0);
    assert_close(scene->sky.below[1], 4, 0, 0);
    assert_true(scene->ground.present);
    assert_close(scene->ground.height, -1, 0, 0);
    assert_close(scene->ground.reflectance[1], 0.3, 0, 0);
    assert_close(scene->period[1], 6, 0, 0);
    pps_scene_free(scene);
}

static void meshes_are_found_beside_the_scene(void **state) {
    (void)state;
    files_text("card.obj",
               "o x\nusemtl blatt\nv 0 0 0\nv 100 0 0\nv 0 0 100\nf 1 2 3\n");
    pps_scene *scene = read_text(PROTOTYPE(
        "\"mesh\": \"card.obj\", \"leaf\": \"Blatt\", \"up\": \"z\", \"unit\": 0.01"));
    assert_close(scene->prototype[0].mesh->leaf[0].area, 0.5, 1e-6, 0);
    assert_close(scene->prototype[0].mesh->leaf[0].normal[1], -1, 1e-12, 0);
    pps_scene_free(scene);
}

static void species_bring_their_optics(void **state) {
    (void)state;
    pps_leaf_optics optics;
    pps_scene *scene = read_text(PROTOTYPE("\"species\": \"cherry\", \"seed\": 2"));
    assert_int_equal(pps_species_optics("cherry", &optics, NULL), PPS_OK);
    assert_memory_equal(&scene->prototype[0].optics, &optics, sizeof optics);
    pps_scene_free(scene);
}

static void place_and_time_give_the_sun(void **state) {
    (void)state;
    double to[3];
    pps_scene *scene = read_text(SUN("\"latitude\": 50.1, \"longitude\": 14.4, "
                                     "\"time\": \"2026-06-21T16:00+02:00\""));
    pps_sun_direction(50.1, 14.4, "2026-06-21T14:00:00Z", to, NULL);
    for (int i = 0; i < 3; i++) {
        assert_close(scene->sun.to[i], to[i], 1e-12, 0);
    }
    assert_close(scene->sun.irradiance[2], 1, 0, 0);
    pps_scene_free(scene);
}

static void grids_are_jittered_turned_and_scaled_within_bounds(void **state) {
    (void)state;
    static const char TEXT[] =
        ONE("\"grid\": [8, 4], \"spacing\": [5, 6], \"jitter\": 0.2, \"yaw_step\": 72, "
            "\"scale\": [0.85, 1.15], \"seed\": 7, \"center\": [100, 0, 2]");
    pps_scene *scene = read_text(TEXT), *again = read_text(TEXT);
    assert_int_equal(scene->n_instances, 32);
    assert_memory_equal(scene->instance, again->instance, 32 * sizeof *scene->instance);
    bool turned[5] = {false};
    double low = 2, high = 0, farthest = 0;
    for (int k = 0; k < 32; k++) {
        const pps_instance *one = &scene->instance[k];
        double x = (one->translation[0] - 100) / 5 - (k % 8 - 3.5);
        double y = one->translation[1] / 6 - ((k - k % 8) / 8.0 - 1.5);
        farthest = fmax(farthest, fmax(fabs(x), fabs(y)));
        assert_close(one->translation[2], 2, 0, 0);
        assert_close(fmod(one->yaw, 72), 0, 0, 0);
        assert_in_range((int)one->yaw, 0, 288);
        turned[(int)one->yaw / 72] = true;
        low = fmin(low, one->scale);
        high = fmax(high, one->scale);
    }
    for (int i = 0; i < 5; i++) {
        assert_true(turned[i]);
    }
    assert_in_range((int)(farthest * 1000), 180, 200);
    assert_true(low >= 0.85 && high <= 1.15 && high - low > 0.2);
    pps_scene_free(again);
    pps_scene_free(scene);
    scene = read_text(ONE("\"grid\": [1, 2], \"spacing\": 3, \"yaw_step\": 360"));
    assert_close(scene->instance[1].translation[1], 1.5, 0, 0);
    assert_close(scene->instance[1].yaw, 0, 0, 0);
    assert_close(scene->instance[1].scale, 1, 0, 0);
    pps_scene_free(scene);
}

static void the_scenes_that_come_along_are_read(void **state) {
    (void)state;
    static const struct {
        const char *name;
        size_t instances, triangles;
    } rows[] = {
        {"scenes/single-tree.json", 1, 6806},
        {"scenes/periodic-forest.json", 4, 6806},
        {"scenes/CHERRY16.json", 16, 62500},
        {"scenes/CHERRY64.json", 64, 62500},
        {"scenes/spp-figure5.json", 1, 219000},
        {"scenes/spp-figure7.json", 1, 219000},
        {"scenes/leaf-figure7-1500.json", 1, 3000},
        {"scenes/leaf-figure7-4000.json", 1, 8000},
        {"scenes/leaf-figure7-9000.json", 1, 18000},
        {"scenes/MAPLE16.json", 16, 219000},
        {"scenes/MAPLE64.json", 64, 219000},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        pps_scene *scene = read_scene(files_data(rows[i].name));
        assert_int_equal(scene->n_instances, rows[i].instances);
        assert_close((double)scene->prototype[0].mesh->n_triangles,
                     (double)rows[i].triangles, 0.01, 0);
        pps_scene_free(scene);
    }
}

static void a_bare_mesh_stands_in_daylight(void **state) {
    (void)state;
    pps_scene *scene = read_scene(files_data("trees/oak_small.obj"));
    assert_int_equal(scene->n_bands, 3);
    assert_int_equal(scene->n_leaves, 1800);
    assert_true(scene->ground.present);
    assert_close(scene->ground.height, 0, 0, 1e-6);
    /* 50 degrees high; most of the light on the ground is the sun's. */
    assert_close(asin(scene->sun.to[2]) * 180 / PI, 50, 0.02, 0);
    for (int b = 0; b < 3; b++) {
        double sun = scene->sun.irradiance[b] * scene->sun.to[2];
        double sky = PI * (scene->sky.horizon[b] +
                           2 / 3.0 * (scene->sky.zenith[b] - scene->sky.horizon[b]));
        assert_in_range((int)(100 * sky / (sun + sky)), 15, 35);
    }
    /* Leaves are green. */
    const pps_leaf_optics *o = &scene->prototype[0].optics;
    assert_true(o->reflectance[0][1] > 1.5 * o->reflectance[0][0]);
    assert_true(o->reflectance[0][0] > 1.5 * o->reflectance[0][2]);
    pps_scene_free(scene);

    pps_scene *none;
    files_text("bark.obj", "usemtl bark\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_int_equal(pps_scene_read(files_path("bark.obj"), &none, &problem),
                     PPS_ERR_ARGUMENT);
    assert_null(none);
}

static void white_leaves_without_an_image_are_taken_as_green(void **state) {
    (void)state;
    pps_scene *scene = read_scene(files_data("trees/oak_medium.glb"));
    const pps_leaf_optics *o = &scene->prototype[0].optics;
    assert_close(o->reflectance[1][0], 0.06, 1e-12, 0);
    assert_close(o->transmittance[0][1], 0.12, 1e-12, 0);
    pps_scene_free(scene);
}

/* ---- hard times ---- */

#define LARGE                                                                          \
    "{\"bands\": [\"red\", \"green\", \"blue\"], \"prototypes\": {\"a\": {" CROWN      \
    "}, \"b\": {\"crown\": \"tall\", \"leaf_area_index\": 2, \"leaves\": 3, "          \
    "\"seed\": 1, "                                                                    \
    "\"optics\": {\"reflectance\": [0.1, 0.2, 0.3], \"transmittance\": 0.1}}},\n"      \
    "\"instances\": [{\"prototype\": \"a\", \"yaw\": 1, \"translation\": [1, 2, 3]}, " \
    "{\"prototype\": \"b\", \"grid\": [2, 2], \"spacing\": 3, \"jitter\": 0.1}],\n"    \
    "\"sun\": {\"latitude\": 50, \"longitude\": 10, \"time\": "                        \
    "\"2026-06-21T12:00Z\"},\n"                                                        \
    "\"sky\": {\"zenith\": 1, \"horizon\": [1, 2, 3]}, \"ground\": {\"reflectance\": " \
    "0}, "                                                                             \
    "\"period\": [9, 9]}"

/* Letters changed, dropped or doubled at random: read, or refused in one line. */
static void damaged_scenes_do_no_harm(void **state) {
    (void)state;
    static const char SOME[] = "{}[]\",:0123456789.-eE \n\\utrfabnlsx";
    char text[] = LARGE;
    uint64_t seed = 11;
    size_t n = strlen(text), read = 0;
    for (int k = 0; k < 4000; k++) {
        size_t at = (size_t)(support_random(&seed) * (double)n);
        char kept = text[at];
        text[at] = SOME[(size_t)(support_random(&seed) * (double)(sizeof SOME - 1))];
        pps_scene *scene;
        size_t length = k % 4 ? n : at;
        const char *path = files_write("damaged.json", text, length);
        pps_status status = pps_scene_read(path, &scene, &problem);
        read += status == PPS_OK;
        if (status) {
            assert_int_equal(status, PPS_ERR_FORMAT);
            assert_null(scene);
            assert_memory_equal(problem.text, path, strlen(path));
            assert_null(strchr(problem.text, '\n'));
            assert_true(strlen(problem.text) > strlen(path) + 10);
        }
        pps_scene_free(scene);
        text[at] = kept;
    }
    assert_in_range(read, 100, 2000);
}

/* But Jansson's own: it takes those for mistakes in the file. */
static void every_allocation_may_fail(void **state) {
    (void)state;
    const char *path = files_text("scene.json", LARGE);
    pps_scene *scene = NULL;
    pps_status status = PPS_ERR_MEMORY;
    long n = 0;
    for (; status == PPS_ERR_MEMORY; n++) {
        allocations_left = n;
        status = pps_scene_read(path, &scene, &problem);
        allocations_left = -1;
        assert_true(!scene || status == PPS_OK);
    }
    if (status) {
        fail_msg("%s", problem.text);
    }
    assert_in_range(n, 30, 1000);
    pps_scene_free(scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_problem_is_told_in_its_own_words),
        cmocka_unit_test(problems_of_plants_are_told_with_their_place),
        cmocka_unit_test(scenes_that_come_along_have_names),
        cmocka_unit_test(the_least_scene_is_one_plant_and_light),
        cmocka_unit_test(every_key_is_read),
        cmocka_unit_test(meshes_are_found_beside_the_scene),
        cmocka_unit_test(species_bring_their_optics),
        cmocka_unit_test(place_and_time_give_the_sun),
        cmocka_unit_test(grids_are_jittered_turned_and_scaled_within_bounds),
        cmocka_unit_test(the_scenes_that_come_along_are_read),
        cmocka_unit_test(a_bare_mesh_stands_in_daylight),
        cmocka_unit_test(white_leaves_without_an_image_are_taken_as_green),
        cmocka_unit_test(damaged_scenes_do_no_harm),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, files_begin, files_end);
}
