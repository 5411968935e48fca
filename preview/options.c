/* Reading options: what is not understood is refused.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/options.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SIZE_LEAST = 16, SIZE_MOST = 8192, THREADS_MOST = 4096 };

enum {
#define OPTION(id, name, metavar, help) id,
#include "preview/options.def"
#undef OPTION
    N_OPTIONS
};

const preview_option options_table[] = {
#define OPTION(id, name, metavar, help) {name, metavar, help},
#include "preview/options.def"
#undef OPTION
    {NULL, NULL, NULL}};

/* ---- words ---- */

#define ROW(name, value) {name, value},
const option_word component_words[] = {PPS_LIGHT_COMPONENT_LIST(ROW){NULL, 0}};
const option_word compensation_words[] = {PPS_COMPENSATION_LIST(ROW){NULL, 0}};
#undef ROW
const option_word show_words[] = {
    {"light", SHOW_LIGHT}, {"sun", SHOW_SUN}, {"scattered", SHOW_SCATTERED}, {NULL, 0}};
const option_word scattered_words[] = {{"pixel", true}, {"cell", false}, {NULL, 0}};

size_t words_count(const option_word *table) {
    size_t n = 0;
    while (table[n].word) {
        n++;
    }
    return n;
}

size_t words_find(const option_word *table, unsigned value) {
    size_t i = 0;
    while (table[i].word && table[i].value != value) {
        i++;
    }
    return i;
}

/* ---- help ---- */

enum { INDENT = 29, COLUMNS = 79 };

/* Words of a text from column INDENT on, the cursor being at `column`. */
static void print_wrapped(FILE *out, const char *text, int column) {
    while (*text) {
        int word = (int)strcspn(text, " ");
        if (column + 1 + word > COLUMNS || column > INDENT + COLUMNS) {
            fputc('\n', out);
            column = 0;
        }
        int gap = column < INDENT ? INDENT - column : 1;
        fprintf(out, "%*s%.*s", gap, "", word, text);
        column += gap + word;
        text += word + (text[word] == ' ');
    }
    fputc('\n', out);
}

void options_help(FILE *out) {
    fputs(
        "Usage: ppscat-preview [OPTIONS] [SCENE]\n"
        "Show a scene (.json) or a mesh in the light that a model finds; without one,\n"
        "a grove of cherries. In the window, h lists the keys.\n\n",
        out);
    for (const preview_option *o = options_table; o->name; o++) {
        int column = fprintf(out, "  --%s%s%s", o->name, o->metavar ? " " : "",
                             o->metavar ? o->metavar : "");
        if (column >= INDENT) {
            fputc('\n', out);
            column = 0;
        }
        print_wrapped(out, o->help, column);
    }
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

/* What the first `length` characters stand for; NULL: they are no word of the table. */
static const option_word *find_word(const option_word *table, const char *text,
                                    size_t length) {
    for (; table->word; table++) {
        if (strlen(table->word) == length && memcmp(table->word, text, length) == 0) {
            return table;
        }
    }
    return NULL;
}

static bool refuse_word(pps_problem *problem, const char *option, const char *text,
                        const option_word *table, const char *also) {
    char allowed[200];
    size_t used = 0;
    for (const option_word *row = table; row->word && used < sizeof allowed; row++) {
        used += (size_t)snprintf(allowed + used, sizeof allowed - used, "%s%s",
                                 row == table ? "" : ", ", row->word);
    }
    if (used < sizeof allowed) {
        snprintf(allowed + used, sizeof allowed - used, "%s", also);
    }
    return refuse(problem, option, text, allowed);
}

static bool read_word(const char *option, const char *text, const option_word *table,
                      unsigned *out, pps_problem *problem) {
    const option_word *row = find_word(table, text, strlen(text));
    if (!row) {
        return refuse_word(problem, option, text, table, "");
    }
    *out = row->value;
    return true;
}

/* Some words, with commas between them: all that they stand for. */
static bool read_words(const char *option, const char *text, const option_word *table,
                       unsigned *out, pps_problem *problem) {
    const char *at = text;
    for (*out = 0;; at++) {
        size_t length = strcspn(at, ",");
        const option_word *row = find_word(table, at, length);
        if (!row) {
            return refuse_word(problem, option, text, table,
                               ", with commas between them");
        }
        *out |= row->value;
        at += length;
        if (!*at) {
            return true;
        }
    }
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

void options_second(const preview_options *o, stage_options *second) {
    stage_way way = second->way;
    const pps_light_model *model = second->model;
    *second = o->stage;
    second->way = way;
    second->model = model;
    second->compensate =
        way == STAGE_INSTANCES ? PPS_COMPENSATE_DERIVED : PPS_COMPENSATE_NONE;
}

const char *options_model_name(const stage_options *o) {
    return o->way == STAGE_INSTANCES     ? "sppg"
           : o->way == STAGE_MONTE_CARLO ? "mc"
                                         : o->model->name;
}

bool options_lit(const stage_options *o) {
    bool all = o->way == STAGE_INSTANCES || o->way == STAGE_MONTE_CARLO;
    return all || o->sources & o->model->sources;
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

/* ---- options ---- */

/* As getopt_long has it, from the table; room for N_OPTIONS + 1. */
static void list_options(struct option *out) {
    for (int i = 0; i < N_OPTIONS; i++) {
        out[i] = (struct option){
            options_table[i].name,
            options_table[i].metavar ? required_argument : no_argument, NULL, 256 + i};
    }
    out[N_OPTIONS] = (struct option){0};
}

static bool read_snapshot(const char *text, preview_options *o, pps_problem *problem) {
    size_t length = strlen(text);
    if (length < 5 || strcmp(text + length - 4, ".png") != 0) {
        return refuse(problem, "snapshot", text, "FILE.png");
    }
    char folder[4096];
    const char *slash = strrchr(text, '/');
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - text) + 1 : 1,
             slash ? text : ".");
    struct stat about;
    bool is_folder = stat(text, &about) == 0 && S_ISDIR(about.st_mode);
    if (is_folder || access(folder, W_OK) != 0) { /* known before anything is drawn */
        snprintf(problem->text, sizeof problem->text,
                 "--snapshot: cannot write '%.200s': %s", text,
                 strerror(is_folder ? EISDIR : errno));
        return false;
    }
    o->snapshot = text;
    return true;
}

static bool read_size(const char *text, preview_options *o, pps_problem *problem) {
    char width[8];
    size_t length = strcspn(text, "x");
    long long n[2];
    snprintf(width, sizeof width, "%.*s", (int)(length < 7 ? length : 7), text);
    if (!text[length] || !read_whole(width, SIZE_LEAST, SIZE_MOST, &n[0]) ||
        !read_whole(text + length + 1, SIZE_LEAST, SIZE_MOST, &n[1])) {
        return refuse(problem, "size", text, "WIDTHxHEIGHT, 16 to 8192 pixels each");
    }
    o->width = (int)n[0];
    o->height = (int)n[1];
    return true;
}

static bool read_model(const char *option, const char *text, stage_options *out,
                       pps_problem *problem) {
    char names[300];
    if (options_model(text, out)) {
        return true;
    }
    options_model_names(names, sizeof names);
    return refuse(problem, option, text, names);
}

/* One number for all bands, or one a band. */
static bool read_albedo(const char *text, preview_options *o, pps_problem *problem) {
    const char *at = text;
    char *end;
    int n = 0;
    for (; n < PPS_BANDS_MAX; n++) {
        o->albedo[n] = strtod(at, &end);
        if (end == at || !(o->albedo[n] >= 0 && o->albedo[n] <= 1)) {
            break;
        }
        if (!*end) {
            for (int b = n + 1; b < PPS_BANDS_MAX; b++) {
                o->albedo[b] = n == 0 ? o->albedo[0] : (double)NAN;
            }
            return true;
        }
        if (*end != ',') {
            break;
        }
        at = end + 1;
    }
    return refuse(problem, "albedo", text,
                  "numbers from 0 to 1, with commas between them, at most 4");
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

/* A number from low to high. */
static bool read_real(const char *option, const char *text, double low, double high,
                      double *out, pps_problem *problem) {
    char *end, allowed[80];
    *out = strtod(text, &end);
    if (end != text && !*end && *out >= low && *out <= high) {
        return true;
    }
    snprintf(allowed, sizeof allowed, "a number from %g to %g", low, high);
    return refuse(problem, option, text, allowed);
}

static bool read_exposure(const char *text, preview_options *o, pps_problem *problem) {
    char *end;
    o->exposure = strtod(text, &end);
    return (end != text && !*end && isfinite(o->exposure) && o->exposure > 0) ||
           refuse(problem, "exposure", text, "a number above 0");
}

static bool read_choice(int id, const char *text, preview_options *o,
                        pps_problem *problem) {
    const char *name = options_table[id].name;
    unsigned value = 0;
    bool good;
    switch (id) {
    case COMPENSATE:
        good = read_word(name, text, compensation_words, &value, problem);
        o->stage.compensate = (pps_compensation)value;
        break;
    case SHOW:
        good = read_word(name, text, show_words, &value, problem);
        o->look.show = (stage_show)value;
        break;
    default:
        good = read_word(name, text, scattered_words, &value, problem);
        o->stage.by_point = value;
        break;
    }
    return good;
}

static bool read_number(int id, const char *text, preview_options *o,
                        pps_problem *problem) {
    long long n = 0;
    switch (id) {
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
    case APART:
        o->stage.apart = true;
        return true;
    case HELP:
        o->help = true;
        return true;
    case VERSION:
        o->version = true;
        return true;
    case MODEL:
        return read_model("model", text, &o->stage, problem);
    case SPLIT:
        o->split = true;
        return read_model("split", text, &o->second, problem);
    case COMPENSATE:
    case SHOW:
    case SCATTERED:
        return read_choice(id, text, o, problem);
    case COMPONENT:
        return read_words("component", text, component_words, &o->stage.sources,
                          problem);
    case ALBEDO:
        return read_albedo(text, o, problem);
    case SUN:
        return read_sun(text, o, problem);
    case LATITUDE:
        return read_real("latitude", text, -90, 90, &o->latitude, problem);
    case VIEW:
        return read_view(text, o, problem);
    case ZOOM:
        return read_real("zoom", text, 1, 1000, &o->zoom, problem);
    case SIZE:
        return read_size(text, o, problem);
    case EXPOSURE:
        return read_exposure(text, o, problem);
    case DETAIL:
        return read_real("detail", text, 0, 100, &o->look.detail, problem);
    case RELIEF:
        return read_real("relief", text, 0, 1, &o->look.relief, problem);
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
    if (!options_lit(s) && !(o->split && options_lit(&o->second))) {
        snprintf(problem->text, sizeof problem->text,
                 "--component: the model %s knows none of this light", model);
        return false;
    }
    if (s->apart && s->way != STAGE_LEAVES &&
        !(o->split && o->second.way == STAGE_LEAVES)) {
        snprintf(problem->text, sizeof problem->text,
                 "--apart: it is for the model leaf; this is %s", model);
        return false;
    }
    if (o->bench && o->snapshot) {
        strcpy(problem->text, "--bench and --snapshot: one of them at a time");
        return false;
    }
    if (o->bench && o->split) {
        strcpy(problem->text, "--bench and --split: times are of one model");
        return false;
    }
    return true;
}

bool options_read(int argc, char **argv, preview_options *out, pps_problem *problem) {
    const char *model = "lattice";
    bool compensate_given = false;
    int id;
    *out = (preview_options){
        .width = 1280,
        .height = 720,
        .samples = 4,
        .view = {-60, 10},
        .exposure = 1.5,
        .zoom = 1,
        .latitude = 50,
        .albedo = {NAN, NAN, NAN, NAN},
        .look = {.relief = 0.5},
        .stage = {.sources = PPS_ALL_LIGHT, .by_point = true, .map_texels = 512}};
    struct option known[N_OPTIONS + 1];
    list_options(known);
    options_model(model, &out->stage);
    opterr = 0;
    optind = 1;
    while ((id = getopt_long(argc, argv, ":hj:", known, NULL)) != -1) {
        if (id == '?' || id == ':') {
            snprintf(problem->text, sizeof problem->text,
                     id == ':' ? "%.60s: it needs a value (see --help)"
                               : "%.60s: no such option (see --help)",
                     argv[optind - 1]);
            return false;
        }
        id = id == 'h' ? HELP : id == 'j' ? JOBS : id - 256;
        if (!read_one(id, optarg, out, problem)) {
            return false;
        }
        model = id == MODEL ? optarg : model;
        compensate_given = compensate_given || id == COMPENSATE;
    }
    if (out->stage.way == STAGE_INSTANCES && !compensate_given) {
        out->stage.compensate = PPS_COMPENSATE_DERIVED;
    }
    if (out->split) {
        stage_options second = out->second;
        options_second(out, &second);
        out->second = second;
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
