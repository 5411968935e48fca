/* Text as a picture, the picture as a texture.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "preview/panel.h"

#include <math.h>
#include <string.h>

#include <ppscat/tree/picture.h>

#include "tree/font.h" /* its source is compiled into the preview too */

enum { LINES_MOST = 40, COLUMNS_MOST = 120, MARGIN = 4 };

bool panel_create(panel *out, pps_problem *problem) {
    *out = (panel){.program = gl_program("screen_vert", "panel_frag", problem)};
    glGenVertexArrays(1, &out->vertices);
    glGenTextures(1, &out->texture);
    glBindTexture(GL_TEXTURE_2D, out->texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return out->program != 0;
}

void panel_free(panel *p) {
    glDeleteProgram(p->program);
    glDeleteVertexArrays(1, &p->vertices);
    glDeleteTextures(1, &p->texture);
    *p = (panel){0};
}

/* The text in black on white. */
static pps_picture *write_lines(const char *text, int scale) {
    char line[LINES_MOST][COLUMNS_MOST + 1];
    int n = 0, widest = 0;
    while (*text && n < LINES_MOST) {
        size_t length = strcspn(text, "\n");
        size_t kept = length < COLUMNS_MOST ? length : COLUMNS_MOST;
        memcpy(line[n], text, kept);
        line[n][kept] = '\0';
        int width = pps_font_width(line[n++], scale);
        widest = width > widest ? width : widest;
        text += length + (text[length] == '\n');
    }
    int margin = MARGIN * scale, step = (PPS_FONT_HEIGHT + 2) * scale;
    pps_picture *picture;
    if (pps_picture_create(widest + 2 * margin, n * step + 2 * margin, &picture)) {
        return NULL;
    }
    for (int i = 0; i < 3 * picture->width * picture->height; i++) {
        picture->rgb[i] = 1;
    }
    for (int i = 0; i < n; i++) {
        pps_font_write(picture, margin, margin + i * step + scale, scale, line[i]);
    }
    return picture;
}

panel_place panel_draw(const panel *p, int width, int height, int scale, int x, int y,
                       const char *text) {
    pps_picture *picture = write_lines(text, scale);
    if (!picture) {
        return (panel_place){0, 0, 0, 0};
    }
    x = x < 0 ? width + x - picture->width : x;
    y = y < 0 ? height + y - picture->height : y;
    panel_place place = {x, y, picture->width, picture->height};
    y = height - picture->height - y; /* OpenGL counts from the bottom */
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, p->texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, picture->width, picture->height, 0, GL_RGB,
                 GL_FLOAT, picture->rgb);
    glViewport(x, y, picture->width, picture->height);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glUseProgram(p->program);
    gl_set_int(p->program, "picture", 0);
    glBindVertexArray(p->vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glDisable(GL_BLEND);
    glViewport(0, 0, width, height);
    pps_picture_free(picture);
    return place;
}

bool panel_at(const panel_place *place, int scale, double x, double y, int *line,
              int *column) {
    double step = (PPS_FONT_HEIGHT + 2) * scale, margin = MARGIN * scale;
    x -= place->x;
    y -= place->y;
    *line = (int)floor((y - margin) / step);
    *column = (int)floor((x - margin) / (PPS_FONT_WIDTH * scale));
    return x >= 0 && x < place->width && y >= 0 && y < place->height;
}
