/* The table of settings, and what each does.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/settings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "preview/sun_path.h"

static const double DEGREE_STEP = 5, HOUR_STEP = 0.25, ALBEDO_STEP = 0.05;

/* ---- words ---- */

/* Of a value that no word stands for, as sources that the command line has put together. */
static const char *word_of(const option_word *table, unsigned value) {
    const char *word = table[words_find(table, value)].word;
    return word ? word : "some parts";
}

/* The value of the next word, round the table; the first after a value without a word. */
static unsigned next_word(const option_word *table, unsigned value, int step) {
    size_t n = words_count(table), at = words_find(table, value);
    return table[at < n ? (at + n + (size_t)step) % n : 0].value;
}

/* ---- models ---- */

enum { NOT_SPLIT = -1 };

/* Rows of the library's table, then sppg and mc. */
static int n_models(void) { return (int)pps_light_model_count() + 2; }

static const char *model_at(int i) {
    int n = (int)pps_light_model_count();
    return i < n ? pps_light_model_at((size_t)i)->name : i == n ? "sppg" : "mc";
}

static int number_of(const stage_options *o) {
    int i = 0;
    while (strcmp(model_at(i), options_model_name(o)) != 0) {
        i++;
    }
    return i;
}

/* But for those without cells to show, and what does not take the scene. */
static bool take_model(const settings *s, int i, stage_options *out) {
    return options_model(model_at(i), out) &&
           (s->any_model || out->way != STAGE_INSTANCES);
}

static setting_effect change_model(settings *s, int step) {
    stage_options *o = &s->options.stage;
    int n = n_models(), at = number_of(o);
    do {
        at = (at + step + n) % n;
    } while (!take_model(s, at, o));
    o->compensate = o->way == STAGE_INSTANCES ? PPS_COMPENSATE_DERIVED : 0;
    options_second(&s->options, &s->options.second);
    return EFFECT_OPEN;
}

static void write_model(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%s", options_model_name(&s->options.stage));
}

static setting_effect change_split(settings *s, int step) {
    preview_options *o = &s->options;
    int n = n_models(), at = o->split ? number_of(&o->second) : NOT_SPLIT;
    do {
        at = at + step < NOT_SPLIT ? n - 1 : at + step >= n ? NOT_SPLIT : at + step;
    } while (at != NOT_SPLIT && !take_model(s, at, &o->second));
    o->split = at != NOT_SPLIT;
    if (o->split) {
        options_second(o, &o->second);
    }
    return EFFECT_OPEN;
}

static void write_split(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%s",
             s->options.split ? options_model_name(&s->options.second) : "off");
}

static setting_effect change_split_at(settings *s, int step) {
    s->split_at = fmin(fmax(s->split_at + 0.05 * step, 0), 1);
    return EFFECT_DRAW;
}

static void write_split_at(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%.0f %%", 100 * s->split_at);
}

static bool takes_g(const stage_options *o) {
    return o->way == STAGE_INSTANCES || (o->way == STAGE_GRID && o->model->compensates);
}

static setting_effect change_g(settings *s, int step) {
    stage_options *o = &s->options.stage;
    if (!takes_g(o)) {
        snprintf(s->note, sizeof s->note, "%s takes no G-factor",
                 options_model_name(o));
        return EFFECT_DRAW;
    }
    o->compensate =
        (pps_compensation)next_word(compensation_words, o->compensate, step);
    return EFFECT_OPEN;
}

static void write_g(const settings *s, char *out, size_t size) {
    const stage_options *o = &s->options.stage;
    snprintf(out, size, "%s",
             takes_g(o) ? word_of(compensation_words, o->compensate) : "-");
}

static setting_effect change_scattered(settings *s, int step) {
    (void)step;
    s->options.stage.by_point = !s->options.stage.by_point;
    s->options.second.by_point = s->options.stage.by_point;
    return EFFECT_OPEN;
}

static void write_scattered(const settings *s, char *out, size_t size) {
    snprintf(out, size, "by %s", word_of(scattered_words, s->options.stage.by_point));
}

/* ---- light ---- */

static setting_effect change_component(settings *s, int step) {
    unsigned next = next_word(component_words, s->options.stage.sources, step);
    s->options.stage.sources = s->options.second.sources = next;
    if (!options_lit(&s->options.stage)) {
        snprintf(s->note, sizeof s->note, "%s knows none of this light",
                 options_model_name(&s->options.stage));
    }
    return EFFECT_SUN;
}

static void write_component(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%s", word_of(component_words, s->options.stage.sources));
}

static setting_effect change_albedo(settings *s, int band, int step) {
    if (band >= s->n_bands) {
        snprintf(s->note, sizeof s->note, "the scene has %d colour band%s", s->n_bands,
                 s->n_bands > 1 ? "s" : "");
        return EFFECT_DRAW;
    }
    double next = ALBEDO_STEP * round(s->albedo[band] / ALBEDO_STEP + step);
    s->options.albedo[band] = s->albedo[band] = fmin(fmax(next, 0), 1);
    return EFFECT_LEAVES;
}

static void write_albedo(const settings *s, int band, char *out, size_t size) {
    if (band < s->n_bands) {
        snprintf(out, size, "%.2f%s", s->albedo[band],
                 isnan(s->options.albedo[band]) ? " (scene)" : "");
    } else {
        snprintf(out, size, "-");
    }
}

#define ALBEDO_OF(color, band)                                                         \
    static setting_effect change_##color(settings *s, int step) {                      \
        return change_albedo(s, band, step);                                           \
    }                                                                                  \
    static void write_##color(const settings *s, char *out, size_t size) {             \
        write_albedo(s, band, out, size);                                              \
    }
ALBEDO_OF(red, 0)
ALBEDO_OF(green, 1)
ALBEDO_OF(blue, 2)

setting_effect settings_turn_sun(settings *s, double azimuth, double elevation) {
    s->sun[0] = remainder(s->sun[0] + azimuth, 360);
    s->sun[1] = fmin(fmax(s->sun[1] + elevation, 1), 90);
    return EFFECT_SUN;
}

setting_effect settings_pass_time(settings *s, double hours) {
    if (!sun_pass(s->sun, s->options.latitude, hours)) {
        snprintf(s->note, sizeof s->note, "the sun is down at that time");
        return EFFECT_DRAW;
    }
    return EFFECT_SUN;
}

static setting_effect change_time(settings *s, int step) {
    return settings_pass_time(s, HOUR_STEP * step);
}

static void write_time(const settings *s, char *out, size_t size) {
    int minutes = (int)lround(60 * sun_hour(s->sun, s->options.latitude));
    snprintf(out, size, "%02d:%02d", minutes / 60 % 24, minutes % 60);
}

static setting_effect change_azimuth(settings *s, int step) {
    return settings_turn_sun(s, DEGREE_STEP * step, 0);
}

static void write_azimuth(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%.0f", s->sun[0]);
}

static setting_effect change_elevation(settings *s, int step) {
    return settings_turn_sun(s, 0, DEGREE_STEP * step);
}

static void write_elevation(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%.0f", s->sun[1]);
}

/* ---- the picture ---- */

static setting_effect change_exposure(settings *s, int step) {
    s->options.exposure *= step > 0 ? 1.2 : 1 / 1.2;
    return EFFECT_DRAW;
}

static void write_exposure(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%.2f", s->options.exposure);
}

static setting_effect change_show(settings *s, int step) {
    s->options.look.show =
        (stage_show)next_word(show_words, s->options.look.show, step);
    return EFFECT_DRAW;
}

static void write_show(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%s", word_of(show_words, s->options.look.show));
}

static setting_effect change_detail(settings *s, int step) {
    double *detail = &s->options.look.detail;
    *detail = step > 0 ? (*detail < 1 ? 1 : fmin(2 * *detail, 16))
                       : (*detail <= 1 ? 0 : *detail / 2);
    return EFFECT_DRAW;
}

static void write_detail(const settings *s, char *out, size_t size) {
    if (s->options.look.detail > 0) {
        snprintf(out, size, "%g pixels", s->options.look.detail);
    } else {
        snprintf(out, size, "every leaf");
    }
}

static setting_effect change_relief(settings *s, int step) {
    double *relief = &s->options.look.relief;
    *relief = fmin(fmax(*relief + 0.25 * step, 0), 1);
    return EFFECT_DRAW;
}

static void write_relief(const settings *s, char *out, size_t size) {
    snprintf(out, size, "%.2f", s->options.look.relief);
}

/* ---- the table ---- */

#define KEY(letter) GLFW_KEY_##letter, 0
const setting settings_table[] = {
    {"m M", KEY(M), "model", "the model that lights the leaves", write_model,
     change_model},
    {"x X", KEY(X), "split with", "a second model, right of a line", write_split,
     change_split},
    {", .", GLFW_KEY_PERIOD, GLFW_KEY_COMMA, "split at", "where that line is",
     write_split_at, change_split_at},
    {"g G", KEY(G), "G-factor", "of models that take one: none, derived, printed",
     write_g, change_g},
    {"p P", KEY(P), "scattered sun",
     "by pixel or by cell, in models that count surfaces", write_scattered,
     change_scattered},
    {"c C", KEY(C), "light", "all of it, or one component", write_component,
     change_component},
    {"1 !", KEY(1), "albedo, red", "of leaves, in the first band", write_red,
     change_red},
    {"2 @", KEY(2), "albedo, green", "in the second", write_green, change_green},
    {"3 #", KEY(3), "albedo, blue", "in the third", write_blue, change_blue},
    {"t T", KEY(T), "time of day", "solar, at the place's latitude", write_time,
     change_time},
    {"left right", GLFW_KEY_LEFT, GLFW_KEY_RIGHT, "sun, azimuth",
     "degrees from +x towards +y", write_azimuth, change_azimuth},
    {"up down", GLFW_KEY_UP, GLFW_KEY_DOWN, "sun, elevation",
     "degrees above the horizon", write_elevation, change_elevation},
    {"[ ]", GLFW_KEY_RIGHT_BRACKET, GLFW_KEY_LEFT_BRACKET, "exposure",
     "times that of a white plane under the sky", write_exposure, change_exposure},
    {"f F", KEY(F), "show",
     "light, or in false colour the sun's share or what is scattered", write_show,
     change_show},
    {"d D", KEY(D), "detail", "fewer leaves where they are smaller than this",
     write_detail, change_detail},
    {"n N", KEY(N), "relief", "how deep veins and folds of leaves look", write_relief,
     change_relief},
    {NULL, 0, 0, NULL, NULL, NULL, NULL}};

const char *const settings_other_keys[][2] = {
    {"left drag", "go round"},
    {"right drag", "move the sun; with shift let time go by"},
    {"middle drag", "pan (or shift and left); drag the split's line"},
    {"wheel", "come nearer; over the panel change a value"},
    {"click", "on the panel: < is less, the rest of a row is more"},
    {"Tab", "hide the panel, show it"},
    {"0", "the albedos of the scene"},
    {"Home", "the view at the start"},
    {"s", "save a picture"},
    {"r", "read the scene again"},
    {"drop a file", "open it"},
    {"h", "this list"},
    {"q, Esc", "leave"},
    {NULL, NULL}};

const setting *setting_of_key(int key, bool shift, int *step) {
    for (const setting *row = settings_table; row->keys; row++) {
        if (key == row->more || (row->less && key == row->less)) {
            *step = key == row->more && !(shift && !row->less) ? 1 : -1;
            return row;
        }
    }
    return NULL;
}
