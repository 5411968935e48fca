/* A double as the shortest decimal text that reads back as the same double.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PPSCAT_CLI_NUMBER_H
#define PPSCAT_CLI_NUMBER_H

#include <stddef.h>

enum { NUMBER_SIZE = 32 }; /* the longest has 24 letters */

/* Write x: "0.1", "1e-05", "-inf"; nothing for NAN, which is an empty field. The
 * exponent is written where it is below -4 or above 15. Returns the length; no
 * terminating zero. Of all texts with the fewest digits it is the nearest to x. */
size_t number_format(double x, char text[NUMBER_SIZE]);

#endif
