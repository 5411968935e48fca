/* Names of files: beside one another, and their endings.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TREE_PATH_H
#define PPS_TREE_PATH_H

#include <stdbool.h>
#include <stddef.h>

#include <ppscat/status.h>

/* `name` as seen from the folder of `file`; an absolute name stays. NULL: no memory. */
char *pps_path_beside(const char *file, const char *name);

/* Where the last part of a path starts, and where its ending does (at its dot, or at the
 * end). */
const char *pps_path_base(const char *path);
const char *pps_path_ending(const char *path);

/* Whether the path ends in `ending` (".obj"), case ignored. */
bool pps_path_ends(const char *path, const char *ending);

/* All of a file, with a zero byte behind; *n is its length without that. FILE with errno
 * set, or MEMORY. */
pps_status pps_path_load(const char *path, unsigned char **bytes, size_t *n);

#endif
