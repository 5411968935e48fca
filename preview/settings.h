/* What can be set while the window is open: a table, for keys, panel, help and man page.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_SETTINGS_H
#define PREVIEW_SETTINGS_H

#include "preview/options.h"

typedef struct {
    preview_options options;
    double sun[2];                /* azimuth, elevation, degrees */
    double albedo[PPS_BANDS_MAX]; /* of the first prototype, now */
    int n_bands;
    bool any_model;  /* else sppg does not take the scene, and is passed over */
    double split_at; /* share of the window's width */
    char note[200];  /* why a setting did not change */
} settings;

/* What a change asks for; each includes those before it. */
typedef enum {
    EFFECT_NONE,
    EFFECT_DRAW,
    EFFECT_SUN,    /* the sun's light anew */
    EFFECT_LEAVES, /* the leaves' albedo, and all light */
    EFFECT_OPEN    /* the scene anew */
} setting_effect;

typedef struct {
    const char *keys; /* as the help shows them */
    int more, less;   /* GLFW's; less 0: `more` with shift */
    const char *name, *help;
    void (*write)(const settings *s, char *out, size_t size); /* the value */
    setting_effect (*change)(settings *s, int step);          /* +1 or -1 */
} setting;

/* Ends with a row without keys. */
extern const setting settings_table[];

/* Keys that set nothing: pairs of key and what it does, to NULL. */
extern const char *const settings_other_keys[][2];

/* The row that a key belongs to, and which way; NULL: none. */
const setting *setting_of_key(int key, bool shift, int *step);

/* As the row's `change`. */
setting_effect settings_turn_sun(settings *s, double azimuth, double elevation);
setting_effect settings_pass_time(settings *s, double hours);

#endif
