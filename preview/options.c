/* Reading options: what is not understood is refused.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/options.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE_LEAST = 16, SIZE_MOST = 8192, THREADS_MOST = 4096 };

const char *options_help(void) {
    return "Usage: ppscat-preview [OPTIONS] [SCENE]\n"
           "Show a scene (.json) or a mesh in the light that a model finds; without "
           "one, "
           "a grove\nof cherries. In the window, h lists the keys.\n"
           "\n"
           "  --snapshot FILE.png    one picture, without a display\n"
           "  --bench                times of the steps, and a round of the sun\n"
           "  --model NAME           lattice (default) and the other names of `ppscat "
           "tree models`;\n"
           "                         sppg: the paper's own system; mc: Monte Carlo\n"
           "  --compensate FORM      G-factor of the models that take one: none, "
           "derived, "
           "printed\n"
           "                         (default none; sppg: derived)\n"
           "  --component LIST       of all (default), sun, indirect, sky, "
           "sky-indirect\n"
           "  --sun AZIMUTH,ELEVATION    degrees from +x towards +y, and above the "
           "horizon\n"
           "  --view AZIMUTH,ELEVATION   where the camera stands (default -60,10)\n"
           "  --size WIDTHxHEIGHT    pixels (default 1280x720)\n"
           "  --exposure X           times that of a white plane under the sky "
           "(default "
           "1)\n"
           "  --show WHAT            light (default), or in false colour sun, "
           "scattered\n"
           "  --samples N            a pixel, 1 to 8 (default 4)\n"
           "  --rays N               of mc (default 1000000)\n"
           "  -j, --jobs N           threads (default all cores)\n"
           "  -h, --help   --version\n";
}

/* ---- single values ---- */

static bool refuse(pps_problem *problem, const char *option, const char *text,
                   const char *allowed) {
    snprintf(problem->text, sizeof problem->text,
             "--%s: '%.60s' is not possible; allowed: %s", option, text, allowed);
    return false;
}

static bool read_whole(const char *text, long long low, long long high,
                       long long *out) {
    char *end;
    *out = strtoll(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && !*end && *out >= low && *out <= high;
}

static bool read_pair(const char *text, double out[2]) {
    char *comma, *end;
    out[0] = strtod(text, &comma);
    if (comma == text || *comma != ',') {
        return false;
    }
    out[1] = strtod(comma + 1, &end);
    return end != comma + 1 && !*end && isfinite(out[0]) && isfinite(out[1]);
}

/* Which of the words; -1: none. */
static int read_word(const char *text, const char *const *word, int n) {
    for (int i = 0; i < n; i++) {
        if (strcmp(text, word[i]) == 0) {
            return i;
        }
    }
    return -1;
}

/* A model that needs cells and has no field of them is none for the stage. */
static bool previewed(const pps_light_model *model) {
    return model->without_cells || !model->without_field;
}

bool options_model(const char *name, stage_options *out) {
    const pps_light_model *model = pps_light_model_find(name);
    if (strcmp(name, "sppg") == 0) {
        out->way = STAGE_INSTANCES;
    } else if (strcmp(name, "mc") == 0) {
        out->way = STAGE_MONTE_CARLO;
    } else if (model && previewed(model)) {
        out->way = model->without_cells ? STAGE_LEAVES : STAGE_GRID;
    } else {
        return false;
    }
    out->model = model;
    return true;
}

void options_model_names(char *out, size_t size) {
    size_t used = 0;
    for (size_t i = 0; i < pps_light_model_count() && used < size; i++) {
        const pps_light_model *model = pps_light_model_at(i);
        if (previewed(model)) {
            used += (size_t)snprintf(out + used, size - used, "%s, ", model->name);
        }
    }
    if (used < size) {
        snprintf(out + used, size - used, "sppg, mc");
    }
}

static bool read_components(const char *text, unsigned *out) {
    static const char *const word[] = {"all", "sun", "indirect", "sky", "sky-indirect"};
    static const unsigned bit[] = {PPS_ALL_LIGHT, PPS_SUN, PPS_SUN_INDIRECT, PPS_SKY,
                                   PPS_SKY_INDIRECT};
    *out = 0;
    for (;;) {
        char one[16];
        size_t length = strcspn(text, ",");
        if (length >= sizeof one) {
            return false;
        }
        memcpy(one, text, length);
        one[length] = '\0';
        int k = read_word(one, word, 5);
        if (k < 0) {
            return false;
        }
        *out |= bit[k];
        if (!text[length]) {
            return true;
        }
        text += length + 1;
    }
}

/* ---- options ---- */

enum {
    SNAPSHOT = 256,
    BENCH,
    MODEL,
    COMPENSATE,
    COMPONENT,
    SUN,
    VIEW,
    SIZE,
    EXPOSURE,
    SHOW,
    SAMPLES,
    RAYS,
    VERSION
};

static const struct option table[] = {
    {"snapshot", required_argument, NULL, SNAPSHOT},
    {"bench", no_argument, NULL, BENCH},
    {"model", required_argument, NULL, MODEL},
    {"compensate", required_argument, NULL, COMPENSATE},
    {"component", required_argument, NULL, COMPONENT},
    {"sun", required_argument, NULL, SUN},
    {"view", required_argument, NULL, VIEW},
    {"size", required_argument, NULL, SIZE},
    {"exposure", required_argument, NULL, EXPOSURE},
    {"show", required_argument, NULL, SHOW},
    {"samples", required_argument, NULL, SAMPLES},
    {"rays", required_argument, NULL, RAYS},
    {"jobs", required_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},
    {"version", no_argument, NULL, VERSION},
    {NULL, 0, NULL, 0}};

static bool read_snapshot(const char *text, preview_options *o, pps_problem *problem) {
    size_t length = strlen(text);
    if (length < 5 || strcmp(text + length - 4, ".png") != 0) {
        return refuse(problem, "snapshot", text, "FILE.png");
    }
    o->snapshot = text;
    return true;
}

static bool read_size(const char *text, preview_options *o, pps_problem *problem) {
    char end;
    return (sscanf(text, "%5dx%5d%c", &o->width, &o->height, &end) == 2 &&
            o->width >= SIZE_LEAST && o->width <= SIZE_MOST &&
            o->height >= SIZE_LEAST && o->height <= SIZE_MOST) ||
           refuse(problem, "size", text, "WIDTHxHEIGHT, 16 to 8192 pixels each");
}

static bool read_model(const char *text, preview_options *o, pps_problem *problem) {
    char names[300];
    if (options_model(text, &o->stage)) {
        return true;
    }
    options_model_names(names, sizeof names);
    return refuse(problem, "model", text, names);
}

static bool read_sun(const char *text, preview_options *o, pps_problem *problem) {
    o->sun_given = true;
    return (read_pair(text, o->sun) && fabs(o->sun[0]) <= 360 && o->sun[1] > 0 &&
            o->sun[1] <= 90) ||
           refuse(
               problem, "sun", text,
               "an azimuth from -360 to 360, a comma, an elevation above 0 up to 90");
}

static bool read_view(const char *text, preview_options *o, pps_problem *problem) {
    return (read_pair(text, o->view) && fabs(o->view[0]) <= 360 &&
            fabs(o->view[1]) <= 90) ||
           refuse(problem, "view", text,
                  "an azimuth from -360 to 360, a comma, an elevation from -90 to 90");
}

static bool read_exposure(const char *text, preview_options *o, pps_problem *problem) {
    char *end;
    o->exposure = strtod(text, &end);
    return (end != text && !*end && isfinite(o->exposure) && o->exposure > 0) ||
           refuse(problem, "exposure", text, "a number above 0");
}

static bool read_number(int id, const char *text, preview_options *o,
                        pps_problem *problem) {
    static const char *const forms[] = {"none", "derived", "printed"};
    static const char *const shows[] = {"light", "sun", "scattered"};
    long long n = 0;
    int k;
    switch (id) {
    case COMPENSATE:
        k = read_word(text, forms, 3);
        o->stage.compensate = (pps_compensation)k;
        return k >= 0 || refuse(problem, "compensate", text, "none, derived, printed");
    case SHOW:
        k = read_word(text, shows, 3);
        o->look.show = (stage_show)k;
        return k >= 0 || refuse(problem, "show", text, "light, sun, scattered");
    case COMPONENT:
        return read_components(text, &o->stage.sources) ||
               refuse(
                   problem, "component", text,
                   "all, sun, indirect, sky, sky-indirect, with commas between them");
    case SAMPLES:
        o->samples = (int)(read_whole(text, 1, 8, &n) ? n : 0);
        return o->samples ||
               refuse(problem, "samples", text, "whole numbers from 1 to 8");
    case RAYS:
        if (!read_whole(text, 1, 1000000000000, &n)) {
            return refuse(problem, "rays", text, "whole numbers from 1 to 1e12");
        }
        o->stage.rays = (uint64_t)n;
        return true;
    default:
        if (!read_whole(text, 1, THREADS_MOST, &n)) {
            return refuse(problem, "jobs", text, "whole numbers from 1 to 4096");
        }
        o->stage.threads = (int)n;
        return true;
    }
}

static bool read_one(int id, const char *text, preview_options *o,
                     pps_problem *problem) {
    switch (id) {
    case SNAPSHOT:
        return read_snapshot(text, o, problem);
    case BENCH:
        o->bench = true;
        return true;
    case 'h':
        o->help = true;
        return true;
    case VERSION:
        o->version = true;
        return true;
    case MODEL:
        return read_model(text, o, problem);
    case SUN:
        return read_sun(text, o, problem);
    case VIEW:
        return read_view(text, o, problem);
    case SIZE:
        return read_size(text, o, problem);
    case EXPOSURE:
        return read_exposure(text, o, problem);
    default:
        return read_number(id, text, o, problem);
    }
}

/* What does not go together. */
static bool check(const preview_options *o, bool compensate_given, const char *model,
                  pps_problem *problem) {
    const stage_options *s = &o->stage;
    if (compensate_given && s->compensate &&
        (s->way == STAGE_LEAVES || s->way == STAGE_MONTE_CARLO ||
         (s->way == STAGE_GRID && !s->model->compensates))) {
        snprintf(problem->text, sizeof problem->text,
                 "--compensate: the model %s takes no G-factor", model);
        return false;
    }
    if (o->bench && o->snapshot) {
        strcpy(problem->text, "--bench and --snapshot: one of them at a time");
        return false;
    }
    return true;
}

bool options_read(int argc, char **argv, preview_options *out, pps_problem *problem) {
    const char *model = "lattice";
    bool compensate_given = false;
    int id;
    *out = (preview_options){.width = 1280,
                             .height = 720,
                             .samples = 4,
                             .view = {-60, 10},
                             .exposure = 1,
                             .stage = {.sources = PPS_ALL_LIGHT, .map_texels = 512}};
    options_model(model, &out->stage);
    opterr = 0;
    optind = 1;
    while ((id = getopt_long(argc, argv, ":hj:", table, NULL)) != -1) {
        if (id == '?' || id == ':') {
            snprintf(problem->text, sizeof problem->text,
                     id == ':' ? "%.60s: it needs a value (see --help)"
                               : "%.60s: no such option (see --help)",
                     argv[optind - 1]);
            return false;
        }
        if (!read_one(id, optarg, out, problem)) {
            return false;
        }
        model = id == MODEL ? optarg : model;
        compensate_given = compensate_given || id == COMPENSATE;
    }
    if (out->stage.way == STAGE_INSTANCES && !compensate_given) {
        out->stage.compensate = PPS_COMPENSATE_DERIVED;
    }
    if (optind + 1 < argc) {
        snprintf(problem->text, sizeof problem->text,
                 "'%.60s': one scene at a time; it comes after '%.60s'",
                 argv[optind + 1], argv[optind]);
        return false;
    }
    out->scene = argv[optind];
    return check(out, compensate_given, model, problem);
}
