/* The sun's way over a day, from where it stands: its declination stays.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef PREVIEW_SUN_PATH_H
#define PREVIEW_SUN_PATH_H

#include <stdbool.h>

/* Solar time in hours, 0 to 24, 12 when the sun is highest. sun: azimuth from +x (east)
 * towards +y (north), and elevation; latitude in degrees. */
double sun_hour(const double sun[2], double latitude);

/* Let hours go by. False: the sun would be lower than 1 degree, and stays. */
bool sun_pass(double sun[2], double latitude, double hours);

#endif
