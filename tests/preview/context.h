/* OpenGL without a display, for a group of tests: setup and teardown of cmocka.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TESTS_PREVIEW_CONTEXT_H
#define TESTS_PREVIEW_CONTEXT_H

int context_setup(void **state);
int context_teardown(void **state);

#endif
