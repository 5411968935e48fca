/* Letters of 5 x 7 dots, two more rows for what hangs below the line. A letter is its rows
 * from the top, a row its dots from the left as bits, 16 to 1.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/font.h"

#include <string.h>

enum { FIRST = ' ', LAST = '~', ROWS = 9 };

/* clang-format off */
static const unsigned char LETTER[LAST - FIRST + 1][ROWS] = {
#include "tree/font.def"
};
/* clang-format on */

int pps_font_width(const char *text, int scale) {
    return (int)strlen(text) * PPS_FONT_WIDTH * scale;
}

static void dot(pps_picture *picture, int x, int y, int scale) {
    for (int i = 0; i < scale * scale; i++) {
        int column = x + i % scale, row = y + i / scale;
        if (column >= 0 && column < picture->width && row >= 0 &&
            row < picture->height) {
            memset(&picture->rgb[3 * (row * picture->width + column)], 0,
                   3 * sizeof *picture->rgb);
        }
    }
}

void pps_font_write(pps_picture *picture, int x, int y, int scale, const char *text) {
    for (; *text; text++, x += PPS_FONT_WIDTH * scale) {
        int letter = *text >= FIRST && *text <= LAST ? *text - FIRST : '?' - FIRST;
        for (int i = 0; i < 5 * ROWS; i++) {
            if (LETTER[letter][i / 5] >> (4 - i % 5) & 1) {
                dot(picture, x + i % 5 * scale, y + i / 5 * scale, scale);
            }
        }
    }
}
