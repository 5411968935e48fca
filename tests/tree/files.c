/* Files that tests make.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/support.h"
#include "tree/image.h"
#include "tree/path.h"

static char folder[] = "files-XXXXXX";

/* Call `act` on every file of the folder; their number. */
static size_t each(int (*act)(const char *path)) {
    size_t n = 0;
    DIR *directory = opendir(folder);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        if (entry->d_name[0] != '.') {
            n++;
            if (act) {
                act(files_path(entry->d_name));
            }
        }
    }
    if (directory) {
        closedir(directory);
    }
    return n;
}

int files_begin(void **state) {
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

int files_end(void **state) {
    (void)state;
    each(remove);
    return rmdir(folder);
}

size_t files_count(void) { return each(NULL); }

static const char *join(const char *left, const char *right) {
    static char path[8][600];
    static size_t next;
    char *out = path[next++ % 8];
    snprintf(out, sizeof path[0], "%s/%s", left, right);
    return out;
}

const char *files_path(const char *name) { return join(folder, name); }

const char *files_data(const char *name) { return join(PPS_DATA_DIR, name); }

const char *files_write(const char *name, const void *bytes, size_t n) {
    const char *path = files_path(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    assert_int_equal(fclose(file), 0);
    return path;
}

const char *files_text(const char *name, const char *text) {
    return files_write(name, text, strlen(text));
}

const char *files_png(const char *name, int n, const unsigned char (*rgba)[4],
                      bool alpha) {
    const char *path = files_path(name);
    pps_texture image = {n, 1, malloc(4 * (size_t)n)};
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    memcpy(image.rgba, rgba, 4 * (size_t)n);
    assert_int_equal(pps_image_write(&image, alpha, file), PPS_OK);
    fclose(file);
    free(image.rgba);
    return path;
}

unsigned char *files_load(const char *path, size_t *n) {
    unsigned char *bytes;
    assert_int_equal(pps_path_load(path, &bytes, n), PPS_OK);
    return bytes;
}
