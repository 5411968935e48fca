/* Allocation that fails when a test wants it to.
 *
 * A test program with tests/support/allocation.c and ppscat_fail_allocations (tests/
 * CMakeLists.txt) has malloc, calloc and realloc of the library and of itself come here.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPS_TESTS_ALLOCATION_H
#define PPS_TESTS_ALLOCATION_H

extern long allocations_left; /* before all fail; -1: without end */

#endif
