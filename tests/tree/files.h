/* Files that tests make: a folder of their own, emptied and removed at the end.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TESTS_TREE_FILES_H
#define PPS_TESTS_TREE_FILES_H

#include <stddef.h>

#include <ppscat/tree/mesh.h>

/* cmocka's group setup and teardown. */
int files_begin(void **state);
int files_end(void **state);

/* The path of a name in the folder; of a name in data/. Both last until eight more are asked
 * for. */
const char *files_path(const char *name);
const char *files_data(const char *name);

/* Write bytes, or text, or little-endian floats; returns the path. */
const char *files_write(const char *name, const void *bytes, size_t n);
const char *files_text(const char *name, const char *text);

/* A PNG of one row of n texels. */
const char *files_png(const char *name, int n, const unsigned char (*rgba)[4],
                      bool alpha);

/* All of a file; the caller frees it. */
unsigned char *files_load(const char *path, size_t *n);

/* Number of files in the folder. */
size_t files_count(void);

#endif
