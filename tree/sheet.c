/* Several pictures on one sheet, each under its caption.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>

#include <ppscat/tree/picture.h>

#include "tree/bar.h"
#include "tree/font.h"

/* Pixels: of a dot, of a line of text, between panels. */
typedef struct {
    int dot, line, gap;
    int width, height; /* of a panel */
    int columns, rows;
    int top; /* of the first row's captions */
} layout;

static bool alike(const pps_sheet *sheet, layout *l) {
    for (size_t i = 0; i < sheet->n; i++) {
        const pps_picture *p = sheet->panel[i];
        if (p && l->width == 0) {
            l->width = p->width;
            l->height = p->height;
        } else if (p && (p->width != l->width || p->height != l->height)) {
            return false;
        }
    }
    return l->width > 0;
}

static pps_status lay_out(const pps_sheet *sheet, layout *l) {
    *l = (layout){.columns = sheet->columns};
    if (sheet->columns < 1 || !alike(sheet, l)) {
        return PPS_ERR_ARGUMENT;
    }
    size_t columns = (size_t)l->columns;
    l->rows = (int)((sheet->n + columns - 1) / columns);
    l->dot = l->height >= 600 ? l->height / 300 : 1;
    l->line = (PPS_FONT_HEIGHT + 5) * l->dot;
    l->gap = 4 * l->dot;
    l->top = sheet->key && sheet->key->title ? l->line : 0;
    return PPS_OK;
}

/* Centred in `room` pixels from x on; smaller, and in the end cut off, if it is too long. */
static void write_line(const layout *l, int x, int room, int y, const char *text,
                       pps_picture *out) {
    int dot = l->dot;
    while (dot > 1 && pps_font_width(text, dot) > room) {
        dot--;
    }
    char fits[256];
    int letters = room / pps_font_width("m", dot);
    size_t n = letters < (int)sizeof fits ? (size_t)letters : sizeof fits - 1;
    n = strlen(text) < n ? strlen(text) : n;
    memcpy(fits, text, n);
    fits[n] = '\0';
    pps_font_write(out, x + (room - pps_font_width(fits, dot)) / 2, y + 3 * dot, dot,
                   fits);
}

static void place_panel(const pps_picture *panel, int left, int top, pps_picture *out) {
    size_t row = 3 * (size_t)panel->width;
    for (int y = 0; y < panel->height; y++) {
        size_t to = (size_t)(top + y) * (size_t)out->width + (size_t)left;
        memcpy(out->rgb + 3 * to, panel->rgb + (size_t)y * row, row * sizeof *out->rgb);
    }
}

static void fill_white(pps_picture *out) {
    size_t n = 3 * (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < n; i++) {
        out->rgb[i] = 1;
    }
}

/* The key takes columns at the right. */
static pps_status make_room(const pps_sheet *sheet, const layout *l,
                            pps_picture **out) {
    int width = l->columns * (l->width + l->gap) - l->gap;
    int height =
        l->top + l->rows * (l->line + l->height) + (sheet->footer ? l->line : 0);
    pps_picture plain = {width, height, NULL};
    return pps_picture_create(width + (sheet->key ? pps_bar_width(&plain) : 0), height,
                              out);
}

static void draw_key(const pps_false_color *key, const layout *l, pps_picture *out) {
    pps_false_color untitled = *key;
    untitled.title = NULL;
    pps_bar_draw(&untitled, out);
    if (key->title) {
        write_line(l, 0, out->width, 0, key->title, out);
    }
}

pps_status pps_sheet_draw(const pps_sheet *sheet, pps_picture **out) {
    layout l;
    *out = NULL;
    pps_status status = lay_out(sheet, &l);
    if (!status) {
        status = make_room(sheet, &l, out);
    }
    if (status) {
        return status;
    }
    fill_white(*out);
    if (sheet->key) {
        draw_key(sheet->key, &l, *out);
    }
    for (size_t i = 0; i < sheet->n; i++) {
        int left = (int)(i % (size_t)l.columns) * (l.width + l.gap);
        int top = l.top + (int)(i / (size_t)l.columns) * (l.line + l.height);
        write_line(&l, left, l.width, top, sheet->caption[i], *out);
        if (sheet->panel[i]) {
            place_panel(sheet->panel[i], left, top + l.line, *out);
        }
    }
    if (sheet->footer) {
        write_line(&l, 0, l.columns * (l.width + l.gap) - l.gap,
                   l.top + l.rows * (l.line + l.height), sheet->footer, *out);
    }
    return PPS_OK;
}
