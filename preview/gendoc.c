/* Build-time: the man page, from the tables of options and settings.
 *
 *     ppscat-preview-gendoc > ppscat-preview.1
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>

#include "preview/settings.h"

/* Text for roff: no line begins with a control character, minus signs stay what they
 * are. */
static void roff(const char *text) {
    if (*text == '.' || *text == '\'') {
        fputs("\\&", stdout);
    }
    for (; *text; text++) {
        if (*text == '-') {
            fputs("\\-", stdout);
        } else if (*text == '\\') {
            fputs("\\e", stdout);
        } else {
            putchar(*text);
        }
    }
}

static void tagged(const char *tag, const char *text) {
    fputs(".TP\n.B ", stdout);
    roff(tag);
    putchar('\n');
    roff(text);
    putchar('\n');
}

static void options(void) {
    puts(".SH OPTIONS");
    for (const preview_option *o = options_table; o->name; o++) {
        fputs(".TP\n.B \\-\\-", stdout);
        roff(o->name);
        if (o->metavar) {
            fputs(" \\fI", stdout);
            roff(o->metavar);
            fputs("\\fR", stdout);
        }
        putchar('\n');
        roff(o->help);
        putchar('\n');
    }
}

static void keys(void) {
    puts(".SH KEYS AND MOUSE\n"
         "The panel shows these settings. The first key of a row is more or next, the\n"
         "second less or before; of pairs of arrows and brackets they are the other "
         "way\n"
         "round.");
    for (const setting *row = settings_table; row->keys; row++) {
        char text[200];
        snprintf(text, sizeof text, "%s: %s", row->name, row->help);
        tagged(row->keys, text);
    }
    for (int i = 0; settings_other_keys[i][0]; i++) {
        tagged(settings_other_keys[i][0], settings_other_keys[i][1]);
    }
}

int main(void) {
    puts(
        ".TH PPSCAT\\-PREVIEW 1 \"\" \"ppscat " PPS_VERSION_STRING
        "\" \"User Commands\"\n"
        ".SH NAME\n"
        "ppscat\\-preview \\- plants in the light that a model finds, in a window or a "
        "picture\n"
        ".SH SYNOPSIS\n"
        ".B ppscat\\-preview\n"
        ".RI [ OPTION ]...\n"
        ".RI [ SCENE ]\n"
        ".SH DESCRIPTION\n"
        "Shows a scene (.json) or a mesh (what Assimp reads); without one, a grove of\n"
        "cherries. The file is read again when it changes. Needs OpenGL 3.3; a "
        "software\n"
        "driver will do.");
    options();
    keys();
    puts(
        ".SH EXIT STATUS\n"
        "0 done; 2 bad usage or a broken scene; 1 anything else. One line on standard\n"
        "error says why.\n"
        ".SH SEE ALSO\n"
        ".BR ppscat (1)");
    return 0;
}
