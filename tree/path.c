/* Names of files: beside one another, and their endings.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#include "tree/path.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tree/text.h"

const char *pps_path_base(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

const char *pps_path_ending(const char *path) {
    const char *base = pps_path_base(path), *dot = strrchr(base, '.');
    return dot && dot != base ? dot : base + strlen(base);
}

bool pps_path_ends(const char *path, const char *ending) {
    const char *end = pps_path_ending(path);
    size_t i = 0;
    while (end[i] && tolower((unsigned char)end[i]) == ending[i]) {
        i++;
    }
    return end[i] == ending[i];
}

char *pps_path_beside(const char *file, const char *name) {
    size_t folder = name[0] == '/' ? 0 : (size_t)(pps_path_base(file) - file);
    return text_join(file, folder, name);
}

/* Read to the end; a folder opens but does not read. */
static pps_status load(FILE *file, unsigned char **bytes, size_t *n) {
    size_t room = 0, got = 1;
    for (*n = 0; got > 0; *n += got) {
        if (*n + 1 >= room) {
            room = 2 * room + 65536;
            unsigned char *more = realloc(*bytes, room);
            if (!more) {
                return PPS_ERR_MEMORY;
            }
            *bytes = more;
        }
        got = fread(*bytes + *n, 1, room - 1 - *n, file);
        (*bytes)[*n + got] = 0;
    }
    return ferror(file) ? PPS_ERR_FILE : PPS_OK;
}

pps_status pps_path_load(const char *path, unsigned char **bytes, size_t *n) {
    *bytes = NULL;
    errno = 0;
    FILE *file = fopen(path, "rb");
    if (!file) {
        return PPS_ERR_FILE;
    }
    pps_status status = load(file, bytes, n);
    int reason = errno;
    fclose(file);
    errno = reason;
    if (status) {
        free(*bytes);
        *bytes = NULL;
    }
    return status;
}
